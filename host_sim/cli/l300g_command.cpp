// volcomp run l300g

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/experiments/l300g/figures.hpp"
#include "host_sim/experiments/l300g/report.hpp"

namespace volcomp::cli {
namespace {

struct L300gArguments : RunArguments {
  l300g::L300gOptions options;
  std::string gcode_folder;  // empty: none
};

RunOutcome l300g_outcome(RunPlace& place, const L300gArguments& arguments,
                         const host::Progress& progress) {
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

}  // namespace

void add_l300g_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* l300g = run.add_subcommand(
      "l300g",
      "Gear grinder: calibrate its probe, measure a master gear, compensate, measure again");
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
  add_choice<host::TableKind>(
      *l300g, "--tables", options.tables,
      {{"identified", host::TableKind::identified}, {"means", host::TableKind::means}},
      "What is compensated, all of each error function or its mean");
  l300g
      ->add_option(
          "--errors", options.errors,
          fmt::format("What is wrong with the machine: {}, or a file", l300g::kNamedErrors))
      ->capture_default_str();
  add_seed(*l300g, "--seed", options.seed, "Seed of the phases of the waves");
  add_can_option(*l300g, a->node);
  l300g->add_option("--gcode", a->gcode_folder,
                    "Folder for the inspection as NC programs, before and after compensation");
  add_output_options(*l300g, *a);
  add_bus_options(*l300g, a->node);
  l300g->callback([a, &code] { code = run_experiment(*a, {a->options.errors}, l300g_outcome); });
}

}  // namespace volcomp::cli
