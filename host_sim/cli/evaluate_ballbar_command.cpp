// volcomp evaluate-ballbar

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_csv.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_evaluation.hpp"

namespace volcomp::cli {
namespace {

struct BallBarArguments {
  std::string file;
  host::BallBarSettings settings;
  double sigma_um = 0.0;
  std::string json_file;
  std::string report_folder;
  std::string command;
};

int evaluate(const BallBarArguments& a) {
  Results results(with_report({a.json_file}, a.report_folder), {a.file}, a.report_folder);
  const host::BallBarTest test = host::read_ball_bar_file(a.file);
  host::BallBarSettings settings = a.settings;
  settings.sigma = 1e-3 * a.sigma_um;
  const host::BallBarEvaluation e = host::evaluate_ball_bar(test, settings);
  if (!a.report_folder.empty()) {
    host::Origins origins;
    host::add_origin(origins, "circular test", a.file);
    add_report(results, a.report_folder,
               host::ball_bar_document(test, e, {a.command, {}}, origins));
  }
  results.add(a.json_file, json_text(host::ball_bar_json(test, e, settings)));
  results.write();
  fmt::print(results.text(), "{}", host::ball_bar_text(test, e));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(a.report_folder));
  return 0;
}

}  // namespace

void add_evaluate_ballbar_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command =
      app.add_subcommand("evaluate-ballbar",
                         "Circular test after ISO 230-4: figures with intervals, squareness, "
                         "reversal, servo mismatch");
  auto a = std::make_shared<BallBarArguments>();
  a->command = command_line(argc, argv);
  command->add_option("FILE", a->file, "Readings of a ball bar (CSV; -: standard input)")
      ->required();
  command
      ->add_option("--sigma-um", a->sigma_um,
                   "Standard deviation of a reading, µm, for the intervals of single circles "
                   "(default: the spread of two or more circles each way)")
      ->check(number_between(0.0, 1e3));
  command->add_option("--draws", a->settings.draws, "Draws behind the intervals")
      ->check(CLI::Range(100, 100000))
      ->capture_default_str();
  add_seed(*command, "--seed", a->settings.seed, "Seed of these draws");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->add_option("--report", a->report_folder, "Write report.html and report.json here");
  command->callback([a, &code] { code = evaluate(*a); });
}

}  // namespace volcomp::cli
