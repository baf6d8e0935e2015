// volcomp run xyfz

#include <algorithm>
#include <memory>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/xyfz/machines.hpp"
#include "host_sim/experiments/xyfz/one_diagonal.hpp"
#include "host_sim/experiments/xyfz/paper_figures.hpp"
#include "host_sim/experiments/xyfz/parts.hpp"
#include "host_sim/experiments/xyfz/report.hpp"

namespace volcomp::cli {
namespace {

struct XyfzArguments : RunArguments {
  xyfz::XyfzOptions options;
  std::size_t knots = kDefaultKnots;
  bool noise_free = false;
  bool one_diagonal = false;
  bool paper_figures = false;
  std::optional<xyfz::Functional> squareness;  // of all campaigns
  std::string shard;                           // empty: all draws
};

xyfz::XyfzOptions options_of(RunPlace& place, const XyfzArguments& arguments) {
  xyfz::XyfzOptions options = arguments.options;
  options.knots = std::min(arguments.knots, knots_at(arguments.node));
  options.machine = machine_of(arguments, "xyfz");
  options.make_cell = place.cells(options.machine);
  options.threads = place.threads();
  if (arguments.noise_free) options.draws = 0;
  // The machine is tuned along lines, and the paper's figures are compared with it.
  if (arguments.paper_figures) options.noisy = xyfz::Functional::lines;
  if (arguments.squareness) options.noise_free = options.noisy = *arguments.squareness;
  if (!arguments.shard.empty()) options.shard = part_to_write(arguments, arguments.shard);
  if (!arguments.report_folder.empty())
    options.campaign = std::filesystem::path(arguments.report_folder) / "campaign";
  return options;
}

RunOutcome one_diagonal_outcome(const xyfz::XyfzOptions& options, const host::Progress& progress) {
  const xyfz::OneDiagonal result = xyfz::run_one_diagonal(options, progress);
  return {xyfz::one_diagonal_summary(result), nlohmann::json::object(),
          xyfz::one_diagonal_figures(result), result.ok()};
}

RunOutcome paper_figures_outcome(RunPlace& place, const xyfz::XyfzOptions& options,
                                 const host::Progress& progress) {
  const xyfz::PaperFigures result = xyfz::run_paper_figures(options, progress);
  return {xyfz::paper_figures_summary(result),
          xyfz::paper_figures_document(result, place.context()), xyfz::paper_figures_json(result),
          xyfz::paper_figures_verdict(result).ok};
}

RunOutcome machines_outcome(RunPlace& place, const XyfzArguments& arguments,
                            const xyfz::XyfzOptions& options, const host::Progress& progress) {
  const xyfz::MachinesResult result = xyfz::run_machines(options, progress);
  if (!arguments.shard.empty()) return part_outcome(xyfz::part_of_machines(result), options.shard);
  return {xyfz::machines_summary(result), xyfz::machines_document(result, place.context()),
          xyfz::machines_figures(result), xyfz::machines_verdict(result).ok};
}

RunOutcome xyfz_outcome(RunPlace& place, const XyfzArguments& arguments,
                        const host::Progress& progress) {
  const xyfz::XyfzOptions options = options_of(place, arguments);
  if (arguments.one_diagonal) return one_diagonal_outcome(options, progress);
  if (arguments.paper_figures) return paper_figures_outcome(place, options, progress);
  if (options.machines > 1) return machines_outcome(place, arguments, options, progress);
  const xyfz::XyfzResult result = xyfz::run_xyfz(options, progress);
  if (!arguments.shard.empty()) return part_outcome(xyfz::part_of_xyfz(result), options.shard);
  return {xyfz::xyfz_summary(result), xyfz::xyfz_document(result, place.context()),
          xyfz::xyfz_figures(result), xyfz::xyfz_verdict(result).ok};
}

// How many campaigns, of what.
void add_plan_options(CLI::App& xyfz, XyfzArguments& a) {
  CLI::Option* draws = xyfz.add_option("--draws", a.options.draws,
                                       "Noisy campaigns to run (0: "
                                       "noise-free only)")
                           ->check(CLI::Range(0, 10000))
                           ->capture_default_str();
  xyfz.add_flag("--noise-free", a.noise_free, "The same as --draws 0")->excludes(draws);
  add_shard_option(xyfz, a.shard);
  add_seed(xyfz, "--seed", a.options.seed, "Seed of instruments, readings and random points");
  add_seed(xyfz, "--machine-seed", a.options.machine_seed, "Seed of the machine's error functions");
  xyfz.add_option("--machines", a.options.machines,
                  "So many machines, of this seed and those after it, with --draws campaigns on "
                  "each: what the models remove from PNP")
      ->check(CLI::Range(std::size_t{1}, xyfz::kMostMachines))
      ->capture_default_str();
  xyfz.add_option("--volume-points", a.options.volume_points,
                  "Random places behind the figure of the volume")
      ->check(CLI::Range(10, 100000))
      ->capture_default_str();
  const std::map<std::string, xyfz::Functional> functionals{{"lines", xyfz::Functional::lines},
                                                            {"circles", xyfz::Functional::circles}};
  xyfz.add_option("--squareness", a.squareness,
                  "How the ball bar finds squareness: along three lines, with an error stated for "
                  "the angle, or by circles of 100 mm with all its own errors (default: circles "
                  "in noisy campaigns; lines without noise and with --paper-figures, as the "
                  "machine is tuned)")
      ->transform(CLI::Transformer(functionals, CLI::ignore_case).description("{circles,lines}"));
  std::map<std::string, sim::NoiseSource> sources;
  for (std::size_t s = 0; s < sim::kNoiseSources.size(); ++s)
    sources[sim::kNoiseSources.at(s)] = static_cast<sim::NoiseSource>(s);
  xyfz.add_option("--only", a.options.only,
                  "What errs in noisy campaigns, while everything else is perfect")
      ->transform(CLI::CheckedTransformer(sources).description(
          fmt::format("{{{}}}", fmt::join(sim::kNoiseSources, ","))))
      ->excludes("--noise-free");
  xyfz.add_option("--knots", a.knots,
                  "Most knots of a table (default: what the node has room for, up to 128)")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots));
}

// Shorter runs, which leave out what other options ask for.
void add_short_runs(CLI::App& xyfz, XyfzArguments& a) {
  CLI::Option* one = xyfz.add_flag(
      "--one-diagonal", a.one_diagonal,
      "Only the body diagonal PNP at 11 points, without and with compensation, noise-free");
  CLI::Option* figures = xyfz.add_flag(
      "--paper-figures", a.paper_figures,
      "Only what the paper shows besides: positioning at several levers carried to one point "
      "(Figs. 8, 11), and PNP as the models predict it (Figs. 19, 20)");
  for (const char* whole : {"--shard", "--machines"})
    xyfz.get_option(whole)->excludes(one)->excludes(figures);
  for (const char* other : {"--report", "--serve", "--only"})
    xyfz.get_option(other)->excludes(one);
  one->excludes(figures);
}

// Returns the options that make sense only with a node somewhere.
std::vector<CLI::Option*> add_node_options(CLI::App& xyfz, NodePlace& node) {
  add_can_option(xyfz, node);
  add_firmware_options(xyfz, node.firmware, "Compensate by the node as firmware",
                       " or, with --can vcan0 to join, a53 (Cortex-A53 with an SJA1000)");
  return add_bus_options(xyfz, node);
}

}  // namespace

void add_xyfz_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* xyfz =
      run.add_subcommand("xyfz", "Three-axis machine: measure, build tables, compensate, verify");
  auto a = std::make_shared<XyfzArguments>();
  a->command = command;
  add_plan_options(*xyfz, *a);
  add_output_options(*xyfz, *a);
  add_short_runs(*xyfz, *a);
  const std::vector<CLI::Option*> on_a_bus = add_node_options(*xyfz, a->node);
  xyfz->callback([a, on_a_bus, &code] {
    require_node(on_a_bus, a->node, "--can or --firmware");
    const FirmwareChoice& firmware = a->node.firmware;
    if (firmware.chosen() && !a->node.can.empty() &&
        !sim::emulated_board(firmware.board).has_can_controller)
      throw CLI::ExcludesError("--firmware " + firmware.board, "--can");
    code = run_experiment(*a, {}, xyfz_outcome);
  });
}

}  // namespace volcomp::cli
