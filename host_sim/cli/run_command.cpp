// volcomp run SCENARIO

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_options.hpp"
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

// Runs run_xyfz or one of its kind with the node at the chosen place.
template <class Result>
Result run_scenario(const XyfzArguments& arguments, RunView& view,
                    Result (*scenario)(const xyfz::XyfzOptions&, const host::Progress&)) {
  xyfz::XyfzOptions options = arguments.options;
  std::unique_ptr<ScenarioBus> bus;
  if (arguments.node.integrated()) {
    options.make_cell = sim::watched_integrated_cells("XYZ", view);
  } else {
    bus = std::make_unique<ScenarioBus>(arguments.node, &view);
    options.make_cell = bus->cells(host::read_machine_file(options.machine));
  }
  return run_watched(view, bus.get(),
                     [&](const host::Progress& progress) { return scenario(options, progress); });
}

int run_diagonal_only(const XyfzArguments& arguments) {
  Results results = run_results(arguments);
  const std::unique_ptr<RunView> view = run_view(arguments, results);
  const xyfz::OneDiagonal result = run_scenario(arguments, *view, xyfz::run_one_diagonal);
  fmt::print(results.text(), "{}transport: {}\n", xyfz::one_diagonal_summary(result),
             describe(arguments.node));
  write_results(arguments, {}, xyfz::one_diagonal_figures(result), results);
  return result.ok() ? 0 : 1;
}

int run_xyfz_command(XyfzArguments& arguments) {
  xyfz::XyfzOptions& options = arguments.options;
  options.knots = std::min(arguments.knots, knots_at(arguments.node));
  options.machine = machine_of(arguments, "xyfz");
  if (!arguments.report_folder.empty()) {
    options.campaign = std::filesystem::path(arguments.report_folder) / "campaign";
  }
  if (arguments.one_diagonal) return run_diagonal_only(arguments);
  Results results = run_results(arguments);
  const std::unique_ptr<RunView> view = run_view(arguments, results);
  xyfz::XyfzResult result = run_scenario(arguments, *view, xyfz::run_xyfz);
  result.options.make_cell = {};  // the bus has ended
  fmt::print(results.text(), "{}transport: {}\n", xyfz::xyfz_summary(result),
             describe(arguments.node));
  const nlohmann::json document = xyfz::xyfz_document(result, run_context(arguments, *view));
  write_results(arguments, document, xyfz::xyfz_figures(result), results);
  view->ended(document);
  return xyfz::xyfz_verdict(result).ok ? 0 : 1;
}

// Returns the options that make sense only with a node somewhere.
std::vector<CLI::Option*> add_node_options(CLI::App& xyfz, NodePlace& node) {
  xyfz.add_option("--can", node.can,
                  fmt::format("Compensate by a node on a CAN bus: loopback (in this process), {}",
                              host::kLinkForms));
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
  xyfz->add_option("--seed", a->options.seed, "Seed of instruments, readings and random points")
      ->check(seed_number())
      ->capture_default_str();
  xyfz->add_option("--machine-seed", a->options.machine_seed,
                   "Seed of the machine's error functions")
      ->check(seed_number())
      ->capture_default_str();
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
    for (const CLI::Option* option : on_a_bus) {
      if (a->node.integrated() && option->count() > 0)
        throw CLI::RequiresError(option->get_name(), "--can or --firmware");
    }
    const FirmwareChoice& firmware = a->node.firmware;
    if (firmware.chosen() && !a->node.can.empty() &&
        !sim::emulated_board(firmware.board).has_can_controller)
      throw CLI::ExcludesError("--firmware " + firmware.board, "--can");
    code = run_xyfz_command(*a);
  });
  add_l300g_command(*run, a->command, code);
  add_face_gear_command(*run, a->command, code);
  add_internal_helical_command(*run, a->command, code);
  add_run_machine_command(*run, a->command, code);
}

}  // namespace volcomp::cli
