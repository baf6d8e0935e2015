// volcomp run machine

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/experiments/any_machine/machine_spread.hpp"
#include "host_sim/experiments/any_machine/report.hpp"

namespace volcomp::cli {
namespace {

struct RunMachineArguments : RunArguments {
  any_machine::MachineOptions options;
  bool noise_free = false;
  host::DrawPlan spread;  // machines, each with errors of its own
  std::string shard;      // empty: all of them
};

RunOutcome spread_outcome(const RunPlace& place, const RunMachineArguments& arguments,
                          const any_machine::MachineOptions& options,
                          const host::Progress& progress) {
  const host::DrawPlan plan = plan_of_draws(arguments, arguments.spread, arguments.shard);
  const any_machine::MachineSpread spread =
      any_machine::run_machine_spread(options, plan, progress);
  if (!arguments.shard.empty())
    return part_outcome(any_machine::part_of_machine_spread(spread, plan), plan.shard);
  return {any_machine::machine_spread_summary(spread),
          any_machine::machine_spread_document(spread, place.context()),
          any_machine::machine_spread_figures(spread),
          any_machine::machine_spread_verdict(spread).ok};
}

RunOutcome machine_outcome(RunPlace& place, const RunMachineArguments& arguments,
                           const host::Progress& progress) {
  any_machine::MachineOptions options = arguments.options;
  options.machine = machine_of(arguments, "trunnion");
  options.noise = !arguments.noise_free;
  if (arguments.spread.count > 1 || !arguments.shard.empty())
    return spread_outcome(place, arguments, options, progress);
  options.make_cell = place.cells(options.machine);
  options.knots = knots_at(arguments.node);
  const any_machine::MachineResult result = any_machine::run_machine(options, progress);
  return {any_machine::machine_summary(result),
          any_machine::machine_document(result, place.context()),
          any_machine::machine_figures(result), any_machine::machine_verdict(result).ok};
}

}  // namespace

void add_run_machine_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* machine = run.add_subcommand(
      "machine", "Any machine file: errors at random, measure, compensate, verify");
  auto a = std::make_shared<RunMachineArguments>();
  a->command = command;
  a->node.cycle_hz = sim::kBusCycleOfFive_hz;
  any_machine::MachineOptions& options = a->options;
  add_seed(*machine, "--seed", options.seed, "Seed of the machine, of the places and of the noise");
  machine->add_flag("--noise-free", a->noise_free,
                    "Measure with perfect instruments: what the mathematics alone can do");
  CLI::Option* seeds = machine
                           ->add_option("--seeds", a->spread.count,
                                        "Machines, each with errors and noise of its own")
                           ->check(CLI::Range(1, 10000))
                           ->capture_default_str();
  add_shard_option(*machine, a->shard)->needs(seeds);
  machine->add_option("--places", options.places, "Random places all over the travel")
      ->check(CLI::Range(std::size_t{10}, std::size_t{10000}))
      ->capture_default_str();
  machine
      ->add_option("--tool-length", options.tool_length_mm,
                   "Longer tool for the effect of orientation errors, mm")
      ->check(number_between(0.0, 2000.0))
      ->capture_default_str();
  add_can_option(*machine, a->node);
  add_output_options(*machine, *a);
  const std::vector<CLI::Option*> on_a_bus = add_bus_options(*machine, a->node);
  seeds->excludes("--can");
  machine->callback([a, on_a_bus, &code] {
    require_node(on_a_bus, a->node, "--can");
    code = run_experiment(*a, {}, machine_outcome);
  });
}

}  // namespace volcomp::cli
