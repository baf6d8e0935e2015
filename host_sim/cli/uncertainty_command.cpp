// volcomp uncertainty

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/whole_way/image_of_runs.hpp"
#include "host_sim/host/measure/whole_way/whole_way_report.hpp"

namespace volcomp::cli {
namespace {

constexpr std::size_t kPlacesOfLine = 21;

struct UncertaintyArguments {
  std::string image;
  std::string machine;
  std::vector<std::string> runs;
  std::string task;
  std::string point;
  std::string line;
  std::size_t places = kPlacesOfLine;
  std::string uncertainty_file;
  host::CampaignStatement stated;
  host::WholeWaySettings settings;
  std::string json_file;
  std::string report_folder;
  std::string command;
};

std::vector<std::string> inputs_of(const UncertaintyArguments& a) {
  std::vector<std::string> inputs = a.runs;
  inputs.insert(inputs.end(), {a.image, a.machine, a.task, a.uncertainty_file});
  return inputs;
}

host::Task task_of(const UncertaintyArguments& a, const host::MachineFile& machine) {
  if (!a.task.empty()) return host::read_task_file(a.task, machine);
  if (!a.point.empty()) return host::point_task(a.point, machine);
  if (!a.line.empty()) return host::line_task(a.line, a.places, machine);
  throw host::UserError("no places: give --task, --point or --line");
}

host::CampaignStatement statement_of(const UncertaintyArguments& a) {
  host::CampaignStatement stated;
  if (!a.uncertainty_file.empty()) stated = host::read_campaign_file(a.uncertainty_file);
  return stated.overridden_by(a.stated);
}

host::Origins origins_of(const UncertaintyArguments& a) {
  host::Origins origins;
  host::add_origin(origins, "table image", a.image);
  host::add_origin(origins, "machine file", a.machine);
  for (const std::string& path : a.runs)
    host::add_origin(origins, "runs", path);
  if (!a.uncertainty_file.empty()) host::add_origin(origins, "uncertainty", a.uncertainty_file);
  if (!a.task.empty()) host::add_origin(origins, "task", a.task);
  return origins;
}

int uncertainty(const UncertaintyArguments& a) {
  Results results(with_report({a.json_file}, a.report_folder), inputs_of(a), a.report_folder);
  const host::MachineFile machine = host::read_machine_file(a.machine);
  std::vector<host::RunsFile> runs;
  for (const std::string& path : a.runs)
    runs.push_back(host::read_runs_file(path));
  const host::TableImage image = host::read_table_image(a.image);
  host::require_image_of_runs(image, machine, *host::build_tables(machine, runs, a.settings.build));
  const host::Task task = task_of(a, machine);
  const host::CampaignStatement stated = statement_of(a);
  const host::TaskUncertainty answer = [&] {
    ProgressBar bar;
    return host::uncertainty_of_task(
        machine, runs, stated, task, a.settings,
        [&](double done, const std::string& what) { bar.show(done, what); });
  }();
  const host::WholeWayQuestion question{image.name, image.crc, machine,   runs,
                                        stated,     task,      a.settings};
  if (!a.report_folder.empty())
    add_report(results, a.report_folder,
               host::uncertainty_document(question, answer, {a.command, {}}, origins_of(a)));
  results.add(a.json_file, json_text(host::uncertainty_json(question, answer)));
  results.write();
  fmt::print(results.text(), "{}", host::uncertainty_text(question, answer));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(a.report_folder));
  return 0;
}

void add_task_options(CLI::App& command, UncertaintyArguments& a) {
  CLI::Option* task =
      command.add_option("--task", a.task,
                         "Places (CSV) with a column for each axis: X [mm],Y [mm],Z [mm]; deg or "
                         "rad of rotary ones");
  CLI::Option* point =
      command.add_option("--point", a.point,
                         "One place, all axes in the order of the machine file, X,Y,Z for "
                         "instance: mm, degrees of rotary axes");
  CLI::Option* line =
      command.add_option("--line", a.line, "From place to place, X,Y,Z:X,Y,Z for instance");
  point->excludes(task);
  line->excludes(task)->excludes(point);
  command.add_option("--places", a.places, "Places along --line, from end to end")
      ->check(CLI::Range(std::size_t{2}, host::kMostTaskPlaces))
      ->capture_default_str()
      ->needs(line);
}

void add_build_options(CLI::App& command, UncertaintyArguments& a) {
  a.settings.build.bound = false;
  add_choice<SlopeFit>(command, "--slope", a.settings.build.slope,
                       {{"lsq", SlopeFit::least_squares}, {"end", SlopeFit::end_points}},
                       "Line removed from straightness, as when the image was built");
  command
      .add_option("--knots", a.settings.build.knots,
                  "Most knots of a table, as when the image was built")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots))
      ->capture_default_str();
  add_choice<Travel>(
      command, "--direction", a.settings.travel,
      {{"mean", Travel::unknown}, {"up", Travel::forward}, {"down", Travel::backward}},
      "Direction in which all axes arrive: the table of this direction, or the mean of both");
}

void add_statement_options(CLI::App& command, host::CampaignStatement& stated) {
  const CLI::Validator not_negative = number_between(0.0, 1e6);
  for (const host::CampaignField& field : host::campaign_fields()) {
    std::string name = std::string("--") + field.key;
    std::replace(name.begin(), name.end(), '_', '-');
    command
        .add_option(name, stated.*field.member,
                    fmt::format("{} (default: drawn as 0)", field.meaning))
        ->check(not_negative)
        ->group("Uncertainty");
  }
}

}  // namespace

void add_uncertainty_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command = app.add_subcommand(
      "uncertainty",
      "How well the tables of measured runs are known where the machine works: Monte Carlo of the "
      "whole way, beside first order");
  auto a = std::make_shared<UncertaintyArguments>();
  a->command = command_line(argc, argv);
  a->settings.threads = host::processors();
  command->add_option("IMAGE", a->image, "Table image (.vct) that was built from the runs")
      ->required();
  command->add_option("--machine", a->machine, "Machine file (TOML)")->required();
  command->add_option("--runs", a->runs, "Run files (CSV), one per axis")->required();
  add_task_options(*command, *a);
  command->add_option("--uncertainty", a->uncertainty_file,
                      "File with a table [campaign] (TOML); options override it");
  add_statement_options(*command, a->stated);
  add_build_options(*command, *a);
  command->add_option("--draws", a->settings.draws, "Campaigns drawn")
      ->check(CLI::Range(host::kFewestDraws, host::kMostDraws))
      ->capture_default_str();
  add_seed(*command, "--seed", a->settings.seed, "Seed of the draws");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->add_option("--report", a->report_folder, "Write report.html and report.json here");
  command->callback([a, &code] { code = uncertainty(*a); });
}

}  // namespace volcomp::cli
