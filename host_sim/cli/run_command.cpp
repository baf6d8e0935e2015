// volcomp run SCENARIO

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/experiments/xyfz/one_diagonal.hpp"
#include "host_sim/experiments/xyfz/report.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct XyfzArguments : RunArguments {
  xyfz::XyfzOptions options;
  std::size_t knots = kDefaultKnots;
  bool one_diagonal = false;
};

RunOutcome xyfz_outcome(RunPlace& place, const XyfzArguments& arguments,
                        const host::Progress& progress) {
  xyfz::XyfzOptions options = arguments.options;
  options.knots = std::min(arguments.knots, knots_at(arguments.node));
  options.machine = machine_of(arguments, "xyfz");
  options.make_cell = place.cells(options.machine);
  if (arguments.one_diagonal) {
    const xyfz::OneDiagonal result = xyfz::run_one_diagonal(options, progress);
    return {xyfz::one_diagonal_summary(result), nlohmann::json::object(),
            xyfz::one_diagonal_figures(result), result.ok()};
  }
  if (!arguments.report_folder.empty())
    options.campaign = std::filesystem::path(arguments.report_folder) / "campaign";
  const xyfz::XyfzResult result = xyfz::run_xyfz(options, progress);
  return {xyfz::xyfz_summary(result), xyfz::xyfz_document(result, place.context()),
          xyfz::xyfz_figures(result), xyfz::xyfz_verdict(result).ok};
}

// Returns the options that make sense only with a node somewhere.
std::vector<CLI::Option*> add_node_options(CLI::App& xyfz, NodePlace& node) {
  add_can_option(xyfz, node);
  add_firmware_options(xyfz, node.firmware, "Compensate by the node as firmware",
                       " or, with --can vcan0 to join, a53 (Cortex-A53 with an SJA1000)");
  return add_bus_options(xyfz, node);
}

}  // namespace

void add_run_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* run = app.add_subcommand("run", "Run a scenario on a simulated machine");
  run->require_subcommand(1);
  CLI::App* xyfz =
      run->add_subcommand("xyfz", "Three-axis machine: measure, build tables, compensate, verify");
  auto a = std::make_shared<XyfzArguments>();
  a->command = command_line(argc, argv);
  xyfz->add_option("--draws", a->options.draws, "Noisy campaigns to run (0: noise-free only)")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  add_seed(*xyfz, "--seed", a->options.seed, "Seed of instruments, readings and random points");
  add_seed(*xyfz, "--machine-seed", a->options.machine_seed,
           "Seed of the machine's error functions");
  xyfz->add_option("--volume-points", a->options.volume_points,
                   "Random places behind the figure of the volume")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  xyfz->add_option("--knots", a->knots,
                   "Most knots of a table (default: what the node has room for, up to 128)")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots));
  CLI::Option* one = xyfz->add_flag(
      "--one-diagonal", a->one_diagonal,
      "Only the body diagonal PNP at 11 points, without and with compensation, noise-free");
  add_output_options(*xyfz, *a)->excludes(one);
  xyfz->get_option("--serve")->excludes(one);
  const std::vector<CLI::Option*> on_a_bus = add_node_options(*xyfz, a->node);
  xyfz->callback([a, on_a_bus, &code] {
    require_node(on_a_bus, a->node, "--can or --firmware");
    const FirmwareChoice& firmware = a->node.firmware;
    if (firmware.chosen() && !a->node.can.empty() &&
        !sim::emulated_board(firmware.board).has_can_controller)
      throw CLI::ExcludesError("--firmware " + firmware.board, "--can");
    code = run_experiment(*a, {}, xyfz_outcome);
  });
  add_l300g_command(*run, a->command, code);
  add_face_gear_command(*run, a->command, code);
  add_internal_helical_command(*run, a->command, code);
  add_run_machine_command(*run, a->command, code);
}

}  // namespace volcomp::cli
