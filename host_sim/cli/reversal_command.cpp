// volcomp run reversal

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/experiments/reversal/report.hpp"

namespace volcomp::cli {
namespace {

struct ReversalArguments {
  reversal::ReversalOptions options;
  std::string json_file;
  std::string report_folder;
  std::string command;
};

int run_reversal(const ReversalArguments& a) {
  Results results(with_report({a.json_file}, a.report_folder), {}, a.report_folder);
  const reversal::ReversalResult result = reversal::run_reversal(a.options);
  if (!a.report_folder.empty())
    add_report(results, a.report_folder, reversal::reversal_document(result, {a.command, {}}));
  results.add(a.json_file, json_text(reversal::reversal_figures(result)));
  results.write();
  fmt::print(results.text(), "{}", reversal::reversal_summary(result));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(a.report_folder));
  return number(result.ok() ? ExitCode::done : ExitCode::negative);
}

}  // namespace

void add_reversal_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* reversal = run.add_subcommand(
      "reversal",
      "A drive with little acceleration to spare, an axis that turns round, and an offset that "
      "jumps there: following error by how the offset is limited");
  auto a = std::make_shared<ReversalArguments>();
  a->command = command;
  reversal::ReversalOptions& o = a->options;
  const auto add = [reversal](const char* name, double& value, double low, double high,
                              const char* what) {
    reversal->add_option(name, value, what)
        ->check(number_between(low, high))
        ->capture_default_str();
  };
  add("--period-us", o.period_us, 10.0, 10'000.0, "Period of the targets of the drive, µs");
  add("--step-um", o.step_um, 0.1, 1000.0, "Change of the offset at the reversal, µm");
  add("--turning-m-per-s2", o.turning, 0.01, 100.0, "Acceleration of the axis as it turns, m/s²");
  add("--spare-percent", o.spare, 0.1, 1000.0,
      "What the drive has beyond that acceleration, in per cent of it");
  add("--loop-hz", o.loop_hz, 1.0, 1000.0, "Natural frequency of its position loop, Hz");
  add("--most-added-um", o.most_added_um, 0.0, 1e6,
      "Most that an offset limited in rate and acceleration may add to the following error, µm; "
      "beyond it the exit code is 1");
  reversal->add_option("--json", a->json_file,
                       "Write the figures to this file (-: standard output)");
  reversal->add_option("--report", a->report_folder, "Write report.html and report.json here");
  reversal->callback([a, &code] { code = run_reversal(*a); });
}

}  // namespace volcomp::cli
