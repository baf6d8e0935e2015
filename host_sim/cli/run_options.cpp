#include "host_sim/cli/run_options.hpp"

#include <fmt/format.h>

#include "host_sim/data/whole_file.hpp"
#include "host_sim/report/report.hpp"

namespace volcomp::sim {

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
  scenario.add_option("--json", arguments.json_file, "Write the figures to this file");
  return scenario.add_option("--report", arguments.report_folder,
                             "Write report.html, report.json and what belongs to them here");
}

std::vector<CLI::Option*> add_bus_options(CLI::App& scenario, NodePlace& node) {
  CLI::Option* cycle = scenario.add_option("--cycle-hz", node.cycle_hz, "Cycle on the bus")
                           ->check(CLI::Range(50.0, 1000.0))
                           ->capture_default_str();
  CLI::Option* log = scenario.add_option("--log", node.log_file,
                                         "Write all frames to this file, as candump -L does");
  return {cycle, log};
}

std::filesystem::path machine_of(const RunArguments& arguments, const std::string& bundled) {
  return arguments.machine.empty() ? bundled_machine(bundled)
                                   : std::filesystem::path(arguments.machine);
}

void write_figures(const RunArguments& arguments, nlohmann::json figures) {
  if (arguments.json_file.empty()) return;
  figures["transport"] = describe(arguments.node);
  write_whole_file(arguments.json_file, figures.dump(2) + "\n");
}

void write_pages(const RunArguments& arguments, const nlohmann::json& document) {
  if (arguments.report_folder.empty()) return;
  const std::filesystem::path folder = arguments.report_folder;
  write_report(document, folder);
  fmt::print("report: {}\n", (folder / "report.html").string());
}

}  // namespace volcomp::sim
