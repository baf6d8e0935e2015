#include "host_sim/cli/run_options.hpp"

#include <utility>

#include <fmt/format.h>

#include "host_sim/cli/number_check.hpp"
#include "host_sim/host/machine/machine_bus.hpp"
#include "host_sim/host/report/page/report.hpp"
#include "host_sim/sim/controller/tick_tables.hpp"

namespace volcomp::cli {
namespace {

struct ReportFiles {
  std::string data;
  std::string page;
};

ReportFiles report_files(const std::filesystem::path& folder) {
  return {(folder / "report.json").string(), (folder / "report.html").string()};
}

}  // namespace

std::string command_line(int argc, char** argv) {
  std::string text = "volcomp";
  for (int i = 1; i < argc; ++i)
    text += std::string(" ") + argv[i];
  return text;
}

CLI::Option* add_output_options(CLI::App& scenario, RunArguments& arguments) {
  scenario.add_option("--machine", arguments.machine,
                      "Machine file (default: the machine that comes with the program)");
  return add_figure_options(scenario, arguments);
}

CLI::Option* add_figure_options(CLI::App& scenario, RunArguments& arguments) {
  scenario.add_option("--json", arguments.json_file,
                      "Write the figures to this file (-: standard output)");
  CLI::Option* serve =
      scenario
          .add_option("--serve", arguments.live.port,
                      "Show the run while it goes on in browsers of this computer, at this port "
                      "(0: any that is free)")
          ->expected(0, 1)
          ->default_str(std::to_string(kLivePort));
  scenario.add_flag("--stay", arguments.live.stay, "The page stays after the run, until Ctrl+C")
      ->needs(serve);
  return scenario.add_option("--report", arguments.report_folder,
                             "Write report.html, report.json and what belongs to them here");
}

std::vector<CLI::Option*> add_bus_options(CLI::App& scenario, NodePlace& node) {
  CLI::Option* cycle = scenario.add_option("--cycle-hz", node.cycle_hz, "Cycle on the bus")
                           ->check(number_between(host::kLeastCycle_hz, host::kMostCycle_hz))
                           ->capture_default_str();
  CLI::Option* log = scenario.add_option("--log", node.log_file,
                                         "Write all frames to this file, as candump -L does (-: "
                                         "standard output)");
  return {cycle, log};
}

std::filesystem::path machine_of(const RunArguments& arguments, const std::string& bundled) {
  return arguments.machine.empty() ? host::bundled_machine(bundled)
                                   : std::filesystem::path(arguments.machine);
}

void require_page(const std::string& option) {
  if (host::has_report_page()) return;
  throw host::UserError(option +
                        ": this program was built without the page of its reports; run "
                        "toolchain/setup.sh, which installs node and its packages, and build "
                        "volcomp again");
}

std::unique_ptr<RunView> run_view(const RunArguments& arguments, const Results& results) {
  if (arguments.live.port) require_page("--serve");
  return std::make_unique<RunView>(arguments.live, arguments.command, describe(arguments.node),
                                   results.text());
}

host::RunContext run_context(const RunArguments& arguments, const RunView& view) {
  return {arguments.command, describe(arguments.node), [&view] {
            return view.ticks().periods() > 0 ? sim::tick_tables(view.ticks())
                                              : nlohmann::json::array();
          }};
}

Results run_results(const RunArguments& arguments, const std::vector<std::string>& more_inputs) {
  std::vector<std::string> inputs = more_inputs;
  inputs.insert(inputs.end(), {arguments.machine, arguments.node.firmware.image.string()});
  return Results(
      with_report({arguments.json_file, arguments.node.log_file}, arguments.report_folder),
      std::move(inputs), arguments.report_folder);
}

void write_results(const RunArguments& arguments, const nlohmann::json& document,
                   nlohmann::json figures, Results& results) {
  const std::string& folder = arguments.report_folder;
  if (!folder.empty()) add_report(results, folder, document);
  figures["transport"] = describe(arguments.node);
  results.add(arguments.json_file, json_text(figures));
  results.write();
  if (!folder.empty()) fmt::print(results.text(), "report: {}\n", report_files(folder).page);
}

std::vector<std::string> with_report(std::vector<std::string> names, const std::string& folder) {
  if (folder.empty()) return names;
  require_page("--report");
  const ReportFiles report = report_files(folder);
  names.insert(names.end(), {report.data, report.page});
  return names;
}

void add_report(Results& results, const std::string& folder, const nlohmann::json& document) {
  const ReportFiles report = report_files(folder);
  results.add_folder(folder);
  results.add(report.data, host::report_text(document));
  results.add(report.page, host::report_html(document));
}

}  // namespace volcomp::cli
