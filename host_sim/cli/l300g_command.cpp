// volcomp run l300g

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/probe_option.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/l300g/figures.hpp"
#include "host_sim/experiments/l300g/report.hpp"
#include "host_sim/experiments/l300g/spread.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"

namespace volcomp::cli {
namespace {

struct L300gArguments : RunArguments {
  l300g::L300gOptions options;
  std::string gcode_folder;  // empty: none
  host::DrawPlan spread;     // measurements, each with random numbers of its own
  std::string shard;         // empty: all of them
  bool noise_free = false;
  std::optional<std::size_t> probe;    // of sim::kProbeClasses; empty: as the machine file says
  std::optional<std::size_t> touches;  // of a point
  double tracer_um = kUmPerMm * sim::kTracer_mm;
  bool filter = false;
  bool no_filter = false;
};

// Several measurements: each has a bus of its own, in this process.
bool measures_often(const L300gArguments& a) { return a.spread.count > 1 || !a.shard.empty(); }

void check(const L300gArguments& a) {
  if (!measures_often(a)) return;
  if (a.node.can != "loopback")
    throw host::UserError("--seeds: several measurements need --can loopback, a bus each");
  if (!a.options.scatters())
    throw host::UserError(
        "--seeds: without a --probe or --tracer-um that scatters all measurements are alike");
  if (!a.gcode_folder.empty())
    throw host::UserError("--gcode: the program of an inspection is that of one measurement");
}

RunOutcome spread_outcome(RunPlace& place, const L300gArguments& arguments,
                          const host::Progress& progress) {
  l300g::L300gOptions options = arguments.options;
  options.machine = machine_of(arguments, "l300g");
  options.cycle_hz = arguments.node.cycle_hz;
  const host::DrawPlan plan = plan_of_draws(arguments, arguments.spread, arguments.shard);
  const l300g::SpreadResult result = l300g::run_spread(options, plan, progress);
  if (!arguments.shard.empty())
    return part_outcome(l300g::part_of_spread(result, plan), plan.shard);
  return {l300g::spread_summary(result), l300g::spread_document(result, place.context()),
          l300g::spread_figures(result), l300g::spread_verdict(result).ok};
}

RunOutcome l300g_outcome(RunPlace& place, const L300gArguments& arguments,
                         const host::Progress& progress) {
  if (measures_often(arguments)) return spread_outcome(place, arguments, progress);
  l300g::L300gOptions options = arguments.options;
  options.machine = machine_of(arguments, "l300g");
  options.make_axes = place.axes();
  options.cycle_hz = arguments.node.cycle_hz;
  const l300g::L300gResult result = l300g::run_l300g(options, progress);
  return {l300g::l300g_summary(result),
          l300g::l300g_document(result, place.context()),
          l300g::l300g_figures(result),
          l300g::l300g_verdict(result).ok,
          arguments.gcode_folder,
          {{"inspection_before.ngc", result.before.program},
           {"inspection_after.ngc", result.after.program}}};
}

// How touches scatter, and what is done against it.
void add_probe_options(CLI::App& l300g, L300gArguments& a) {
  CLI::Option* probe = add_probe_class(l300g, a.probe);
  CLI::Option* radius = add_choice<bool>(
      l300g, "--radius", a.options.map_radius, {{"mapped", true}, {"mandrel", false}},
      "What the node takes for the effective radius of the ball: by direction, mapped on a "
      "sphere, or the one that the mandrel gives, as in the paper");
  CLI::Option* touches =
      l300g
          .add_option(
              "--touches", a.touches,
              "Touches of each point; their mean counts (default: what keeps the grades of the "
              "gear, 3 with lp2, else 1)")
          ->check(CLI::Range(1, 20));
  CLI::Option* filter = l300g.add_flag(
      "--filter", a.filter,
      "Gaussian filter of ISO 1328-1:2013 before profile and lead are evaluated (default where "
      "touches scatter)");
  l300g.add_flag("--no-filter", a.no_filter, "Traces are evaluated as they are")->excludes(filter);
  l300g
      .add_option("--teeth", a.options.rules.traces.teeth,
                  "Teeth whose profile and lead are measured, evenly round the gear: the worst "
                  "counts, the mean and the mean trace stand beside it")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  l300g
      .add_option("--points", a.options.rules.traces.points,
                  "Points of a profile or lead within its evaluation range (71 or more: the "
                  "filter spans a thirtieth of it)")
      ->check(CLI::Range(71, 1001))
      ->capture_default_str();
  CLI::Option* tracer =
      l300g
          .add_option("--tracer-um", a.tracer_um,
                      "Standard deviation of a reading of the tracing interferometer that the axes "
                      "are identified with (0: neither readings nor its stations have errors)")
          ->check(number_between(0.0, 100.0))
          ->capture_default_str();
  CLI::Option* seeds =
      l300g
          .add_option("--seeds", a.spread.count,
                      "Measurements with other random numbers: how far they differ")
          ->check(CLI::Range(1, 10000))
          ->capture_default_str();
  add_shard_option(l300g, a.shard)->needs(seeds);
  l300g
      .add_flag("--noise-free", a.noise_free, "Nothing scatters: what the mathematics alone can do")
      ->excludes(probe)
      ->excludes(radius)
      ->excludes(touches)
      ->excludes(tracer)
      ->excludes(seeds);
}

// What was not said follows the probe.
void settle(L300gArguments& a) {
  l300g::L300gOptions& o = a.options;
  o.probe = a.noise_free ? 0 : a.probe.value_or(probe_class_of(machine_of(a, "l300g")));
  o.tracer_um = a.noise_free ? 0.0 : a.tracer_um;
  o.rules.touches = a.touches.value_or(l300g::kLeastTouches.at(o.probe));
  o.rules.filter = a.filter || (o.probe != 0 && !a.no_filter);
}

}  // namespace

void add_l300g_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* l300g = run.add_subcommand(
      "l300g", "Gear grinder: calibrate its probe, measure a gear, compensate, measure again");
  auto a = std::make_shared<L300gArguments>();
  a->command = command;
  a->node.can = "loopback";
  a->node.cycle_hz = sim::kBusCycleOfFive_hz;
  l300g::L300gOptions& options = a->options;
  add_choice<PathStyle>(*l300g, "--path", options.path,
                        {{"fixed-a", PathStyle::fixed_a}, {"generate", PathStyle::generate}},
                        "How a flank is followed");
  add_choice<l300g::Origin>(
      *l300g, "--origin", options.origin,
      {{"mandrel", l300g::Origin::mandrel}, {"nominal", l300g::Origin::nominal}},
      "Where the axis of A is taken to be")
      ->default_str("nominal");
  add_choice<l300g::TableKind>(
      *l300g, "--tables", options.tables,
      {{"identified", l300g::TableKind::identified}, {"means", l300g::TableKind::means}},
      "What is compensated, all of each error function or its mean");
  l300g
      ->add_option(
          "--errors", options.errors,
          fmt::format("What is wrong with the machine: {}, or a file", l300g::kNamedErrors))
      ->capture_default_str();
  l300g->add_option("--gear", options.gear,
                    "Spur gear to measure, a TOML file as for volcomp inspect (default: the "
                    "master gear of the paper)");
  add_seed(*l300g, "--seed", options.seed, "Seed of the phases of the waves, and of the probe");
  add_probe_options(*l300g, *a);
  add_can_option(*l300g, a->node);
  l300g->add_option("--gcode", a->gcode_folder,
                    "Folder for the inspection as NC programs, before and after compensation");
  add_output_options(*l300g, *a);
  add_bus_options(*l300g, a->node);
  l300g->callback([a, &code] {
    settle(*a);
    check(*a);
    code = run_experiment(*a, {a->options.errors, a->options.gear.string()}, l300g_outcome);
  });
}

}  // namespace volcomp::cli
