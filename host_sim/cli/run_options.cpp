#include "host_sim/cli/run_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/cli/number_check.hpp"
#include "host_sim/host/bus/device_files/eds_file.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_bus.hpp"
#include "host_sim/host/report/page/report.hpp"

namespace volcomp::cli {
namespace {

std::string report_data(const std::filesystem::path& folder) {
  return (folder / "report.json").string();
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

void add_can_option(CLI::App& scenario, NodePlace& node) {
  const char* const what = node.integrated()
                               ? "Compensate by a node on a CAN bus: loopback (in this process), {}"
                               : "Bus: loopback (node in this process), {}";
  CLI::Option* can =
      scenario.add_option("--can", node.can, fmt::format(fmt::runtime(what), host::kLinkForms));
  if (!node.integrated()) can->capture_default_str();
}

CLI::Option* add_drive_option(CLI::App& scenario, NodePlace& node) {
  return scenario
      .add_option("--drive-profile", node.drives,
                  fmt::format("Drives as their data sheets have them: one for all axes, or one for "
                              "each ({}, or an EDS file)",
                              fmt::join(host::bundled_drives(), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME[,NAME...]");
}

std::vector<CLI::Option*> add_bus_options(CLI::App& scenario, NodePlace& node) {
  CLI::Option* cycle = scenario.add_option("--cycle-hz", node.cycle_hz, "Cycle on the bus")
                           ->check(number_between(host::kLeastCycle_hz, host::kMostCycle_hz))
                           ->capture_default_str();
  CLI::Option* log = scenario.add_option("--log", node.log_file,
                                         "Write all frames to this file, as candump -L does (-: "
                                         "standard output)");
  return {cycle, log, add_drive_option(scenario, node)};
}

void require_node(const std::vector<CLI::Option*>& options, const NodePlace& node,
                  const std::string& place) {
  for (const CLI::Option* option : options)
    if (node.integrated() && option->count() > 0)
      throw CLI::RequiresError(option->get_name(), place);
}

void add_seed(CLI::App& scenario, const std::string& name, std::uint64_t& seed,
              const std::string& what) {
  scenario.add_option(name, seed, what)->check(seed_number())->capture_default_str();
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

std::string report_page(const std::filesystem::path& folder) {
  return (folder / "report.html").string();
}

std::vector<std::string> with_report(std::vector<std::string> names, const std::string& folder) {
  if (folder.empty()) return names;
  require_page("--report");
  names.insert(names.end(), {report_data(folder), report_page(folder)});
  return names;
}

void add_report(Results& results, const std::string& folder, const nlohmann::json& document) {
  results.add_folder(folder);
  results.add(report_data(folder), host::report_text(document));
  results.add(report_page(folder), host::report_html(document));
}

}  // namespace volcomp::cli
