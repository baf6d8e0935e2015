// volcomp run face-gear

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/probe_option.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/face_gear/figures.hpp"
#include "host_sim/experiments/face_gear/patch_report.hpp"
#include "host_sim/experiments/face_gear/repeatability.hpp"
#include "host_sim/experiments/face_gear/report.hpp"
#include "host_sim/experiments/face_gear/spread.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/map_csv.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"

namespace volcomp::cli {
namespace {

struct FaceGearArguments : RunArguments {
  face_gear::FaceGearOptions options;
  std::string map_folder;    // empty: none
  std::string gcode_folder;  // empty: none
  bool noise_free = false;
  double tracer_um = kUmPerMm * sim::kTracer_mm;
  std::optional<std::size_t> probe;  // of sim::kProbeClasses; empty: as the machine file says
  bool repeatability = false;        // the experiments of section 3.3 in place of a gear
  bool patch = false;                // the patch and the searches of the paper; no machine
  host::DrawPlan spread;             // measurements, each of another machine and gear
  std::string shard;                 // empty: all of them
};

// Several measurements: each has a bus of its own, in this process.
bool measures_often(const FaceGearArguments& a) { return a.spread.count > 1 || !a.shard.empty(); }

void check(const FaceGearArguments& a) {
  if (!measures_often(a) && !a.repeatability) return;
  const std::string option = a.repeatability ? "--repeatability" : "--seeds";
  if (a.node.can != "loopback")
    throw host::UserError(option + ": several measurements need --can loopback, a bus each");
  if (!a.map_folder.empty() || !a.gcode_folder.empty())
    throw host::UserError(option + ": --maps and --gcode are those of one measurement of a gear");
  if (a.repeatability && !a.shard.empty())
    throw host::UserError("--repeatability: --shard is for measurements of a gear");
}

constexpr int kUsualTouches = 2;

face_gear::FaceGearOptions options_of(const FaceGearArguments& arguments) {
  face_gear::FaceGearOptions options = arguments.options;
  options.machine = machine_of(arguments, "yk7280");
  options.cycle_hz = arguments.node.cycle_hz;
  options.probe = arguments.probe.value_or(probe_class_of(options.machine));
  options.tracer_um = arguments.noise_free ? 0.0 : arguments.tracer_um;
  if (arguments.noise_free) {
    options.probe = 0;
    options.touches = 1;
  }
  return options;
}

// As volcomp compare reads them.
std::vector<host::NamedText> map_files(const face_gear::FaceGearResult& run) {
  std::vector<host::NamedText> files;
  const auto compensated = static_cast<std::size_t>(face_gear::FaceStage::compensated);
  for (const face_gear::FlankMap& flank : run.inspection.at(compensated).maps)
    files.push_back({fmt::format("slot{}_{}_um.csv", flank.flank.slot + 1,
                                 face_gear::kFaceSideNames[flank.flank.side > 0 ? 0 : 1]),
                     host::map_csv(flank.map)});
  return files;
}

std::vector<host::NamedText> program_files(const face_gear::FaceGearResult& run) {
  return {{"inspection_before.ngc", run.at(face_gear::FaceStage::frame).program},
          {"inspection_after.ngc", run.at(face_gear::FaceStage::compensated).program}};
}

RunOutcome repeatability_outcome(RunPlace& place, const FaceGearArguments& arguments,
                                 const host::Progress& progress) {
  const face_gear::RepeatabilityResult result = face_gear::run_repeatability(
      options_of(arguments), arguments.spread.count, host::processors(), progress);
  return {face_gear::repeatability_summary(result),
          face_gear::repeatability_document(result, place.context()),
          face_gear::repeatability_figures(result), true};
}

RunOutcome spread_outcome(RunPlace& place, const FaceGearArguments& arguments,
                          const host::Progress& progress) {
  const host::DrawPlan plan = plan_of_draws(arguments, arguments.spread, arguments.shard);
  const face_gear::SpreadResult result =
      face_gear::run_spread(options_of(arguments), plan, progress);
  if (!arguments.shard.empty())
    return part_outcome(face_gear::part_of_spread(result, plan), plan.shard);
  return {face_gear::spread_summary(result), face_gear::spread_document(result, place.context()),
          face_gear::spread_figures(result), face_gear::spread_verdict(result).ok};
}

RunOutcome face_gear_outcome(RunPlace& place, const FaceGearArguments& arguments,
                             const host::Progress& progress) {
  if (arguments.repeatability) return repeatability_outcome(place, arguments, progress);
  if (measures_often(arguments)) return spread_outcome(place, arguments, progress);
  face_gear::FaceGearOptions options = options_of(arguments);
  options.make_axes = place.axes();
  const face_gear::FaceGearResult run = face_gear::run_face_gear(options, progress);
  return {face_gear::face_gear_summary(run),
          face_gear::face_gear_document(run, place.context()),
          face_gear::face_gear_figures(run),
          face_gear::face_gear_verdict(run).ok,
          arguments.map_folder.empty() ? arguments.gcode_folder : arguments.map_folder,
          arguments.map_folder.empty() ? program_files(run) : map_files(run)};
}

// Neither machine nor bus: every option of these is refused.
void check_patch(const CLI::App& face_gear) {
  constexpr std::array<const char*, 4> kTaken{"--patch", "--gear", "--json", "--report"};
  for (const CLI::Option* option : face_gear.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::find(kTaken.begin(), kTaken.end(), name) != kTaken.end())
      continue;
    throw host::UserError("--patch: " + name +
                          " is for measurements; it goes with --gear, --json and --report only");
  }
}

int compare_patch(const FaceGearArguments& a) {
  Results results(with_report({a.json_file}, a.report_folder), {a.options.gear}, a.report_folder);
  const face_gear::PatchComparison comparison = face_gear::compare_patch(a.options.gear);
  if (!a.report_folder.empty())
    add_report(results, a.report_folder, face_gear::patch_document(comparison, {a.command, {}}));
  results.add(a.json_file, json_text(face_gear::patch_figures(comparison)));
  results.write();
  fmt::print(results.text(), "{}", face_gear::patch_summary(comparison));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(a.report_folder));
  return number(face_gear::patch_verdict(comparison).ok ? ExitCode::done : ExitCode::negative);
}

// How touches and targets scatter, and what is done against it.
void add_scatter_options(CLI::App& face_gear, FaceGearArguments& a) {
  std::vector<CLI::Option*> noise;
  noise.push_back(add_probe_class(face_gear, a.probe));
  noise.push_back(add_choice<bool>(
      face_gear, "--radius", a.options.map_radius, {{"mapped", true}, {"file", false}},
      "Effective radius of the ball: by direction, mapped on a sphere, or the one of the machine "
      "file"));
  noise.push_back(
      face_gear
          .add_option("--touches", a.options.touches, "Touches of each point; their mean counts")
          ->check(CLI::Range(1, 20))
          ->capture_default_str());
  noise.push_back(face_gear
                      .add_option("--tracer-um", a.tracer_um,
                                  "Standard deviation of a reading of the tracing interferometer "
                                  "that the axes are identified with (0: nothing of it scatters)")
                      ->check(number_between(0.0, 100.0))
                      ->capture_default_str());
  CLI::Option* pure = face_gear.add_flag("--noise-free", a.noise_free,
                                         "Nothing scatters: what the mathematics alone can do");
  for (CLI::Option* option : noise)
    pure->excludes(option);
}

void add_spread_options(CLI::App& face_gear, FaceGearArguments& a) {
  CLI::Option* seeds =
      face_gear
          .add_option("--seeds", a.spread.count,
                      "Measurements, each of another machine and gear: how far they differ")
          ->check(CLI::Range(1, 10000))
          ->capture_default_str();
  add_shard_option(face_gear, a.shard)->needs(seeds);
  face_gear.add_flag("--repeatability", a.repeatability,
                     "Touch a plate and a ring five times over in place of the gear");
  face_gear.add_flag("--patch", a.patch,
                     "No machine: the paper's NURBS patch and its searches for the nearest point "
                     "and for the angle, against the closed flank; good where the figures of "
                     "docs/papers/face-gear.md hold");
}

}  // namespace

void add_face_gear_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* face_gear = run.add_subcommand(
      "face-gear",
      "Face gear on its machine: find its frame, map its flanks, measure the pitch of all teeth");
  auto a = std::make_shared<FaceGearArguments>();
  a->command = command;
  a->node.can = "loopback";
  a->node.cycle_hz = sim::kBusCycleOfFive_hz;
  face_gear::FaceGearOptions& options = a->options;
  options.touches = kUsualTouches;
  face_gear
      ->add_option("--gear", options.gear,
                   "The gear: table1 or table3 of the paper, or a TOML file")
      ->capture_default_str();
  face_gear
      ->add_option("--flanks", options.flanks,
                   "Pairs of flanks to map, evenly over the gear; the pitch is of all teeth")
      ->check(CLI::Range(1, kMaxFaceGearTeeth))
      ->capture_default_str();
  add_choice<face_gear::FormTruth>(
      *face_gear, "--truth", options.form,
      {{"tables", face_gear::FormTruth::tables}, {"synthetic", face_gear::FormTruth::synthetic}},
      "Form of the simulated flanks, that of the paper's Tables 7 and 8 or a "
      "smooth one");
  add_seed(*face_gear, "--seed", options.seed,
           "Seed of the errors of machine and gear, and of all that scatters");
  add_scatter_options(*face_gear, *a);
  add_spread_options(*face_gear, *a);
  add_can_option(*face_gear, a->node);
  CLI::Option* maps = face_gear->add_option(
      "--maps", a->map_folder, "Folder for the error maps as CSV, for volcomp compare");
  face_gear
      ->add_option("--gcode", a->gcode_folder,
                   "Folder for the inspection as NC programs, before and after compensation")
      ->excludes(maps);
  add_output_options(*face_gear, *a);
  add_bus_options(*face_gear, a->node);
  face_gear->callback([a, face_gear, &code] {
    if (a->patch) {
      check_patch(*face_gear);
      code = compare_patch(*a);
      return;
    }
    check(*a);
    code = run_experiment(*a, {a->options.gear}, face_gear_outcome);
  });
}

}  // namespace volcomp::cli
