// volcomp run face-gear

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/experiments/face_gear/figures.hpp"
#include "host_sim/experiments/face_gear/report.hpp"
#include "host_sim/host/measure/map_csv.hpp"

namespace volcomp::cli {
namespace {

struct FaceGearArguments : RunArguments {
  face_gear::FaceGearOptions options;
  std::string map_folder;  // empty: none
};

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

RunOutcome face_gear_outcome(RunPlace& place, const FaceGearArguments& arguments,
                             const host::Progress& progress) {
  face_gear::FaceGearOptions options = arguments.options;
  options.machine = machine_of(arguments, "yk7280");
  options.make_axes = place.axes();
  options.cycle_hz = arguments.node.cycle_hz;
  const face_gear::FaceGearResult run = face_gear::run_face_gear(options, progress);
  return {face_gear::face_gear_summary(run),
          face_gear::face_gear_document(run, place.context()),
          face_gear::face_gear_figures(run),
          face_gear::face_gear_verdict(run).ok,
          arguments.map_folder,
          map_files(run)};
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
  add_seed(*face_gear, "--seed", options.seed, "Seed of the errors of machine and gear");
  add_can_option(*face_gear, a->node);
  face_gear->add_option("--maps", a->map_folder,
                        "Folder for the error maps as CSV, for volcomp compare");
  add_output_options(*face_gear, *a);
  add_bus_options(*face_gear, a->node);
  face_gear->callback(
      [a, &code] { code = run_experiment(*a, {a->options.gear}, face_gear_outcome); });
}

}  // namespace volcomp::cli
