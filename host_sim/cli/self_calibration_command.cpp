// volcomp run self-calibration

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/self_calibration/figures.hpp"
#include "host_sim/experiments/self_calibration/report.hpp"
#include "host_sim/experiments/self_calibration/spread.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct SelfCalibrationArguments : RunArguments {
  self_calibration::Options options;
  bool noise_free = false;
  host::DrawPlan spread;  // machines, each with errors of its own
  std::string shard;      // empty: all of them
  std::string plan;       // empty: the one that comes with the program for machine and instrument
  std::string instrument = "touch";
  std::string out;  // folder for what was measured and made of it; empty: none
};

// The plan for a machine that comes with the program, or of the user.
std::filesystem::path plan_of(const SelfCalibrationArguments& a) {
  if (!a.plan.empty()) return a.plan;
  const std::string machine = a.machine.empty() ? "xyfz" : a.machine;
  std::filesystem::path plan =
      host::identify::bundled_plan(fmt::format("{}_{}", machine, a.instrument));
  if (!std::filesystem::exists(plan))
    throw host::UserError(fmt::format("no plan for {} with {} comes with the program (--plan FILE)",
                                      machine, a.instrument));
  return plan;
}

// The plan with its machine and whatever readings are there.
std::vector<std::string> inputs_of(const SelfCalibrationArguments& a) {
  const host::identify::MeasurementPlan plan = host::identify::read_plan(plan_of(a), {{}, true});
  std::vector<std::string> inputs{plan.path, plan.machine.path};
  for (const auto& file : plan.files)
    inputs.push_back(file.string());
  return inputs;
}

RunOutcome spread_outcome(const RunPlace& place, const SelfCalibrationArguments& a,
                          const self_calibration::Options& options,
                          const host::Progress& progress) {
  const host::DrawPlan plan = plan_of_draws(a, a.spread, a.shard);
  const self_calibration::Spread spread = self_calibration::run_spread(options, plan, progress);
  if (!a.shard.empty())
    return part_outcome(self_calibration::part_of_spread(spread, plan), plan.shard);
  return {self_calibration::spread_summary(spread),
          self_calibration::spread_document(spread, place.context()),
          self_calibration::spread_figures(spread), self_calibration::spread_verdict(spread).ok};
}

// The readings, as `volcomp identify` takes them, and the tables.
std::vector<host::NamedText> files_of(const self_calibration::Result& result) {
  std::vector<host::NamedText> files;
  for (const auto& [name, text] : result.files)
    files.push_back({name, text});
  files.push_back(
      {"tables.vct", {reinterpret_cast<const char*>(result.image.data()), result.image.size()}});
  return files;
}

RunOutcome self_calibration_outcome(RunPlace& place, const SelfCalibrationArguments& a,
                                    const host::Progress& progress) {
  self_calibration::Options options = a.options;
  options.plan = plan_of(a);
  options.noise = !a.noise_free;
  if (a.spread.count > 1 || !a.shard.empty()) return spread_outcome(place, a, options, progress);
  const std::filesystem::path machine =
      host::identify::read_plan(options.plan, {{}, true}).machine.path;
  options.make_axes = place.axes();
  options.cycle_hz = a.node.cycle_hz;
  options.make_cell = place.cells(machine);
  const self_calibration::Result result = self_calibration::run_self_calibration(options, progress);
  RunOutcome outcome{self_calibration::summary(result),
                     self_calibration::document(result, place.context()),
                     self_calibration::figures(result), self_calibration::verdict(result).ok};
  if (a.out.empty()) return outcome;
  outcome.folder = a.out;
  outcome.files = files_of(result);
  for (const host::NamedText& file : outcome.files)
    outcome.file_lines += (std::filesystem::path(a.out) / file.name).string() + '\n';
  return outcome;
}

}  // namespace

void add_self_calibration_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* calibration = run.add_subcommand(
      "self-calibration",
      "A machine identifies its own errors: its probe touches spheres, or tracers follow it; "
      "tables of them, and what these leave at other places");
  auto a = std::make_shared<SelfCalibrationArguments>();
  a->command = command;
  a->node.cycle_hz = sim::kBusCycleOfFive_hz;
  self_calibration::Options& options = a->options;
  add_seed(*calibration, "--seed", options.seed,
           "Seed of the machine, of the places of the verification and of the noise");
  calibration->add_flag("--noise-free", a->noise_free,
                        "Measure with perfect instruments: what the mathematics alone can do");
  CLI::Option* draws = calibration
                           ->add_option("--draws", a->spread.count,
                                        "Machines, each with errors and noise of its own")
                           ->check(CLI::Range(1, 10000))
                           ->capture_default_str();
  CLI::Option* plan =
      calibration->add_option("--plan", a->plan,
                              "Measurement plan, which names its machine (default: the one that "
                              "comes with the program for --machine xyfz or trunnion)");
  calibration
      ->add_option("--instrument", a->instrument,
                   "Of the plan that comes with the program: the probe of the machine, or four "
                   "stations of a tracer")
      ->check(CLI::IsMember({"touch", "tracer"}))
      ->capture_default_str()
      ->excludes("--plan");
  calibration->add_option("--places", options.places, "Random places of the verification")
      ->check(CLI::Range(std::size_t{10}, std::size_t{10000}))
      ->capture_default_str();
  CLI::Option* out = calibration->add_option(
      "--out", a->out, "Folder for the readings, as volcomp identify takes them, and the tables");
  add_can_option(*calibration, a->node);
  add_firmware_options(*calibration, a->node.firmware,
                       "Touch and compensate with the node as firmware", "");
  add_output_options(*calibration, *a);
  plan->excludes("--machine");
  const std::vector<CLI::Option*> on_a_bus = add_bus_options(*calibration, a->node);
  for (const char* single : {"--can", "--firmware"})
    draws->excludes(single);
  draws->excludes(out);
  add_shard_option(*calibration, a->shard)->needs(draws);
  calibration->callback([a, on_a_bus, &code] {
    require_node(on_a_bus, a->node, "--can or --firmware");
    code = run_experiment(*a, inputs_of(*a), self_calibration_outcome);
  });
}

}  // namespace volcomp::cli
