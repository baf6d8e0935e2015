// volcomp run internal-helical

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/experiments/internal_helical/controller_files.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/report.hpp"

namespace volcomp::sim {
namespace {

struct InternalHelicalArguments : RunArguments {
  InternalHelicalOptions options;
  std::string table_folder;  // empty: none
};

std::vector<std::string> add_tables(const std::string& folder, const InternalHelicalResult& run,
                                    Results& results) {
  std::vector<std::string> names;
  if (folder.empty()) return names;
  std::vector<NamedText> files;
  for (const ControllerFile& file : controller_files(run.gear, run.detail.tables)) {
    files.push_back({file.name, file.text});
    fmt::print(results.words(), "table: {} ({})\n",
               (std::filesystem::path(folder) / file.name).string(), file.meaning);
    names.push_back(file.name);
  }
  results.add_files(folder, files);
  return names;
}

int run_internal_helical_command(const InternalHelicalArguments& arguments) {
  InternalHelicalOptions options = arguments.options;
  options.machine = machine_of(arguments, "internal_grinder");
  Results results = run_results(arguments);
  const std::unique_ptr<RunView> view = run_view(arguments, results);
  options.watch = view.get();
  std::unique_ptr<ScenarioBus> bus;
  if (!arguments.node.integrated()) {
    bus = std::make_unique<ScenarioBus>(arguments.node, view.get());
    options.make_axes = bus->axes();
  }
  const InternalHelicalResult run = run_watched(
      *view, bus.get(),
      [&options](const Progress& progress) { return run_internal_helical(options, progress); });
  fmt::print(results.words(), "{}transport: {}\n", internal_helical_summary(run),
             describe(arguments.node));
  const std::vector<std::string> tables = add_tables(arguments.table_folder, run, results);
  const nlohmann::json document = internal_helical_document(run, run_context(arguments, *view));
  write_results(arguments, document, internal_helical_figures(run, tables), results);
  view->ended(document);
  return internal_helical_verdict(run).ok ? 0 : 1;
}

}  // namespace

void add_internal_helical_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* helical = run.add_subcommand(
      "internal-helical",
      "Internal helical gear: watch Z and C while it is ground, learn offsets of C, inspect it");
  auto a = std::make_shared<InternalHelicalArguments>();
  a->command = command;
  helical->add_option("--seeds", a->options.seeds, "Grinders to simulate; medians are over them")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  const auto word = [](LearningWay way) {
    return std::string(kLearningWays.at(static_cast<std::size_t>(way)));
  };
  const std::map<std::string, LearningWay> wrong{
      {word(LearningWay::c_alone), LearningWay::c_alone},
      {word(LearningWay::one_table), LearningWay::one_table},
      {word(LearningWay::coarse), LearningWay::coarse}};
  add_choice<LearningWay>(*helical, "--wrong", a->options.way, wrong, "Learn in a wrong way")
      ->default_str("");
  helical->add_option("--tables", a->table_folder,
                      "Folder for the learned tables as files of controllers");
  add_output_options(*helical, *a);
  helical->add_option(
      "--can", a->node.can,
      fmt::format("Compensate by a node on a CAN bus: loopback (in this process), {}", kLinkForms));
  helical
      ->add_option("--log", a->node.log_file,
                   "Write all frames to this file, as candump -L does (-: standard output)")
      ->needs("--can");
  helical->callback([a, &code] { code = run_internal_helical_command(*a); });
}

}  // namespace volcomp::sim
