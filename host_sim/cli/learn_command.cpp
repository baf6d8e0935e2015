// volcomp learn

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/measure/strokes/stroke_learning_report.hpp"
#include "host_sim/host/tables/learned_files.hpp"

namespace volcomp::cli {
namespace {

struct LearnArguments {
  std::string log;
  std::string machine;
  std::string before;
  std::string image;
  std::string table_folder;
  std::string json_file;
  std::string report_folder;
  double weight = host::LearnSettings{}.weight;
  std::string command;
};

host::LearnSettings settings_of(const LearnArguments& a) {
  host::LearnSettings settings;
  settings.weight = a.weight;
  if (a.before.empty()) return settings;
  host::InputFile file(a.before);
  const std::string bytes = file.beginning(node::kMostLearnedBytes + 1);
  settings.before.assign(bytes.begin(), bytes.end());
  settings.before_name = file.name();
  return settings;
}

void add_tables(Results& results, const std::string& folder, const host::StrokesLearned& learned) {
  std::vector<host::NamedText> files;
  for (const host::LearnedFile& file :
       host::learned_files(learned.machine.grinding->gear, learned.tables))
    files.push_back({file.name, file.text});
  results.add_folder(folder);
  results.add_files(folder, files);
}

int learn(const LearnArguments& a) {
  std::vector<std::string> inputs{a.log, a.machine};
  if (!a.before.empty()) inputs.push_back(a.before);
  Results results(with_report({a.image, a.json_file}, a.report_folder), inputs,
                  a.report_folder.empty() ? a.table_folder : a.report_folder);
  const host::MachineFile machine = host::read_machine_file(a.machine);
  const host::StrokesLearned learned =
      host::learn_strokes(host::read_stroke_log(a.log, machine), machine, settings_of(a));
  if (!a.image.empty()) {
    const std::vector<std::uint8_t> image =
        host::learned_image(learned.tables, machine.id, learned.feed_mm_per_s);
    results.add(a.image, {reinterpret_cast<const char*>(image.data()), image.size()});
  }
  if (!a.table_folder.empty()) add_tables(results, a.table_folder, learned);
  if (!a.report_folder.empty()) {
    host::Origins origins;
    host::add_origin(origins, "machine file", a.machine);
    host::add_origin(origins, "log of strokes", a.log);
    add_report(results, a.report_folder, host::learned_document(learned, {a.command, {}}, origins));
  }
  results.add(a.json_file, json_text(host::learned_json(learned)));
  results.write();
  fmt::print(results.text(), "{}", host::learned_text(learned));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(a.report_folder));
  return learned.good() ? 0 : 1;
}

}  // namespace

void add_learn_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command = app.add_subcommand(
      "learn",
      "Offsets of C of a helical grinder, learned from a log of X, Z and C while it ground");
  auto a = std::make_shared<LearnArguments>();
  a->command = command_line(argc, argv);
  command
      ->add_option("LOG", a->log, "Cycle by cycle: a table (CSV) or candump -L; -: standard input")
      ->required();
  command->add_option("--machine", a->machine, "Machine file (TOML) with [gear] and [stroke]")
      ->required();
  command->add_option(
      "--before", a->before,
      "Learned tables (as -o writes) that were in force while the log was recorded");
  command
      ->add_option("--weight", a->weight,
                   "How much of what comes back is learned: 1 is all of it, at once")
      ->check(number_between(0.01, 1.0))
      ->capture_default_str();
  command->add_option("-o,--output", a->image,
                      "Learned tables to write, for object 2526h:01 of a node");
  command->add_option("--tables", a->table_folder, "Folder for the same as files of controllers");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->add_option("--report", a->report_folder, "Write report.html and report.json here");
  command->callback([a, &code] { code = learn(*a); });
}

}  // namespace volcomp::cli
