// volcomp run SCENARIO

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/scenario_bus.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/data/whole_file.hpp"
#include "host_sim/report/report.hpp"
#include "host_sim/scenarios/xyfz/one_diagonal.hpp"
#include "host_sim/scenarios/xyfz/report.hpp"

namespace volcomp::sim {
namespace {

struct RunArguments {
  XyfzOptions options;
  std::string machine;
  std::string json_file;
  std::string report_folder;
  std::string command;
  NodePlace node;
  std::size_t knots = kDefaultKnots;
  bool one_diagonal = false;
};

// File and path as the user would type them, without the folder of the program.
std::string command_line(int argc, char** argv) {
  std::string text = "volcomp";
  for (int i = 1; i < argc; ++i)
    text += std::string(" ") + argv[i];
  return text;
}

// Runs run_xyfz or one of its kind with the node where it was asked for.
template <class Result>
Result run_scenario(const RunArguments& arguments,
                    Result (*scenario)(const XyfzOptions&, const Progress&)) {
  XyfzOptions options = arguments.options;
  std::unique_ptr<ScenarioBus> bus;
  if (!arguments.node.integrated()) {
    bus = std::make_unique<ScenarioBus>(arguments.node);
    options.make_cell = bus->cells(read_machine_file(options.machine));
  }
  ProgressBar bar;
  const auto run = [&] {
    return scenario(options, [&](double done, const std::string& what) { bar.show(done, what); });
  };
  Result result = bus ? bus->watch(run) : run();
  if (bus) bus->finish();
  return result;
}

void write_figures(const RunArguments& arguments, nlohmann::json figures) {
  if (arguments.json_file.empty()) return;
  figures["transport"] = describe(arguments.node);
  write_whole_file(arguments.json_file, figures.dump(2) + "\n");
}

int run_diagonal_only(const RunArguments& arguments) {
  const OneDiagonal result = run_scenario(arguments, run_one_diagonal);
  fmt::print("{}transport: {}\n", one_diagonal_summary(result), describe(arguments.node));
  write_figures(arguments, one_diagonal_figures(result));
  return result.ok() ? 0 : 1;
}

int run_xyfz_command(RunArguments& arguments) {
  XyfzOptions& options = arguments.options;
  options.knots = std::min(arguments.knots, knots_at(arguments.node));
  options.machine = arguments.machine.empty() ? bundled_machine("xyfz")
                                              : std::filesystem::path(arguments.machine);
  if (!arguments.report_folder.empty()) {
    options.campaign = std::filesystem::path(arguments.report_folder) / "campaign";
  }
  if (arguments.one_diagonal) return run_diagonal_only(arguments);
  XyfzResult result = run_scenario(arguments, run_xyfz);
  result.options.make_cell = {};  // the bus has ended
  fmt::print("{}transport: {}\n", xyfz_summary(result), describe(arguments.node));
  write_figures(arguments, xyfz_figures(result));
  if (!arguments.report_folder.empty()) {
    write_report(xyfz_document(result, arguments.command), arguments.report_folder);
    fmt::print("report: {}\n",
               (std::filesystem::path(arguments.report_folder) / "report.html").string());
  }
  return xyfz_verdict(result).ok ? 0 : 1;
}

// Returns the options that make sense only with a node somewhere.
std::vector<CLI::Option*> add_node_options(CLI::App& xyfz, NodePlace& node) {
  xyfz.add_option(
      "--can", node.can,
      fmt::format("Compensate by a node on a CAN bus: loopback (in this process), {}", kLinkForms));
  add_firmware_options(xyfz, node.firmware, "Compensate by the node as firmware",
                       " or, with --can vcan0 to join, a53 (Cortex-A53 with an SJA1000)");
  CLI::Option* cycle = xyfz.add_option("--cycle-hz", node.cycle_hz, "Cycle on the bus")
                           ->check(CLI::Range(50.0, 1000.0))
                           ->capture_default_str();
  CLI::Option* log =
      xyfz.add_option("--log", node.log_file, "Write all frames to this file, as candump -L does");
  return {cycle, log};
}

}  // namespace

void add_run_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* run = app.add_subcommand("run", "Run a scenario on a simulated machine");
  run->require_subcommand(1);
  CLI::App* xyfz =
      run->add_subcommand("xyfz", "Three-axis machine: measure, build tables, compensate, verify");
  auto a = std::make_shared<RunArguments>();
  a->command = command_line(argc, argv);
  xyfz->add_option("--draws", a->options.draws, "Noisy campaigns to run (0: noise-free only)")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  xyfz->add_option("--seed", a->options.seed, "Seed of instruments, readings and random points")
      ->capture_default_str();
  xyfz->add_option("--machine-seed", a->options.machine_seed,
                   "Seed of the machine's error functions")
      ->capture_default_str();
  xyfz->add_option("--volume-points", a->options.volume_points,
                   "Random places behind the figure of the volume")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  xyfz->add_option("--machine", a->machine,
                   "Machine file (default: the XYFZ machine that comes with the program)");
  xyfz->add_option("--knots", a->knots,
                   "Most knots of a table (default: what the node has room for, up to 128)")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots));
  CLI::Option* one = xyfz->add_flag(
      "--one-diagonal", a->one_diagonal,
      "Only the body diagonal PNP at 11 points, without and with compensation, noise-free");
  xyfz->add_option("--json", a->json_file, "Write the figures to this file");
  xyfz->add_option("--report", a->report_folder,
                   "Write report.html, report.json and the run files to this folder")
      ->excludes(one);
  const std::vector<CLI::Option*> on_a_bus = add_node_options(*xyfz, a->node);
  xyfz->callback([a, on_a_bus, &code] {
    for (const CLI::Option* option : on_a_bus) {
      if (a->node.integrated() && option->count() > 0)
        throw CLI::RequiresError(option->get_name(), "--can or --firmware");
    }
    const FirmwareChoice& firmware = a->node.firmware;
    if (firmware.chosen() && !a->node.can.empty() &&
        !emulated_board(firmware.board).has_can_controller)
      throw CLI::ExcludesError("--firmware " + firmware.board, "--can");
    code = run_xyfz_command(*a);
  });
}

}  // namespace volcomp::sim
