#include "host_sim/experiments/face_gear/scenario.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "host_sim/experiments/face_gear/inspection_program.hpp"
#include "host_sim/experiments/face_gear/traced_table.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_choice.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::face_gear {
namespace {

// Computes the angle of the paper's worked example: ball at (20.34, 170.14, 47). The paper prints
// no radius; 0.5 mm gives its −81.857° (docs/papers/face-gear.md, "How to reproduce").
double worked_example_deg(const FaceGear& gear) {
  FaceContact contact;
  FaceAngle found;
  constexpr double kStart_rad = -1.43;
  if (!choose_flank(gear, 1, 0, contact.flank).ok()) return 0.0;
  contact.ball_radius = 0.5;
  contact.centre = {20.34, 170.14, 47.0};
  if (!relieved_face_angle(gear, contact, kStart_rad, 1e-9, found).ok())
    return std::numeric_limits<double>::quiet_NaN();
  return found.gamma * 180.0 / kPi;
}

// Times the distance from a flank over the grid, as at a trigger.
double measure_kernel_ns(const FaceGear& gear, const FaceGrid& grid) {
  constexpr int kRounds = 200;
  FaceFlank flank;
  host::require(choose_flank(gear, 1, 0, flank), "flank");
  volatile double sink = 0.0;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kRounds; ++i) {
    for (const auto& row : grid) {
      for (const FaceGridNode& node : row)
        sink = sink + distance_from_face(gear, flank, node.point + 0.5 * node.normal).distance;
    }
  }
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
  return spent.count() / (kRounds * static_cast<double>(kGridCells));
}

std::array<FacePitch, 2> true_pitch(const FaceGearErrors& errors) {
  std::array<FacePitch, 2> pitch;
  for (std::size_t side = 0; side < pitch.size(); ++side) {
    pitch[side].position = errors.pitch[side];
    host::require(evaluate_pitch(pitch[side].position, pitch[side].figures), "pitch");
    host::require(cumulative_pitch(pitch[side].position, kPitchSpan, pitch[side].over_10), "pitch");
  }
  return pitch;
}

MapError map_error(const std::vector<FlankMap>& maps, const FaceGearErrors& errors) {
  MapError error;
  double squares = 0.0;
  int cells = 0;
  for (const FlankMap& flank : maps) {
    const ErrorMap& truth = errors.form[flank.flank.side > 0 ? 0 : 1];
    for (std::size_t r = 0; r < kGridRows; ++r) {
      for (std::size_t c = 0; c < kGridColumns; ++c) {
        if (!flank.map.has(r, c)) continue;
        const double off = flank.map.at(r, c) - truth.at(r, c);
        squares += off * off;
        error.max = std::max(error.max, std::abs(off));
        ++cells;
      }
    }
  }
  if (cells > 0) error.rms = std::sqrt(squares / cells);
  return error;
}

// With the tables in the program instead of in the node.
std::string program(const FaceHall& hall, const FaceGearResult& run, const KnownFrame& frame,
                    FaceStage stage, const host::BuiltTables& built) {
  const MachineChain& chain = hall.file.chain;
  const FaceProgramSetup setup{run.gear,
                               run.grid,
                               {chain, run.gear, frame.mounting},
                               hall.file.probe->radius_mm,
                               run.options.touches,
                               run.options.flanks};
  if (stage != FaceStage::compensated)
    return face_program(setup, "before compensation", no_face_offset);
  return face_program(setup, "the identified errors of X, Y, Z and C compensated",
                      [&](const Pose& pose) { return face_offset_at(built.model, pose); });
}

FaceInspection inspect(const FaceHall& hall, const FaceGearResult& run, FaceStage stage,
                       const host::BuiltTables& built, const host::Progress& progress) {
  FaceStation station(hall, built.tables, nominal_mounting(), static_cast<std::uint32_t>(stage));
  FaceInspector inspector(station, run.gear, run.grid, hall.file.probe->radius_mm,
                          {run.options.touches, hall.scatter.sigma_mm()});
  FaceInspection result;
  const auto share = [&](double part, const std::string& what) {
    progress((static_cast<double>(stage) + part) / kFaceStages.size(),
             fmt::format("{}: {}", kFaceStages.at(static_cast<std::size_t>(stage)), what));
  };
  share(0.0, "frame");
  // The many touches begin where one ball has put the gear: nowhere may the ball miss its flank.
  result.frame = inspector.frame_from_one_ball();
  inspector.use(result.frame);
  if (stage != FaceStage::one_ball) {
    result.frame = inspector.frame_from_many();
    inspector.use(result.frame);
  }
  for (const int slot : mapped_slots(run.options.flanks, run.gear.teeth)) {
    share(0.1 + 0.25 * static_cast<double>(result.maps.size()) / run.options.flanks, "maps");
    for (const int side : kFaceSides)
      result.maps.push_back(inspector.map({side, slot}));
  }
  share(0.6, "pitch");
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    result.pitch[side] = inspector.pitch(kFaceSides[side]);
  result.program = program(hall, run, result.frame, stage, built);
  result.node = inspector.agreement();
  result.outliers = inspector.outliers();
  return result;
}

// Without a map the one radius counts in every direction.
std::optional<LobingMap> calibrated(const FaceGearResult& run, const FaceScatter& scatter) {
  if (run.options.probe == 0) return std::nullopt;
  const double stated = run.machine.probe->radius_mm;
  if (run.options.map_radius)
    return sim::calibrated_on_sphere(scatter.probe, stated, {run.options.seed, 0});
  LobingMap constant;
  constant.coefficient[0] = stated;
  return constant;
}

}  // namespace

FaceScatter scatter_of(const FaceGearOptions& options, const Vec3& stylus) {
  FaceScatter scatter;
  scatter.seed = options.seed;
  if (options.probe == 0) return scatter;
  scatter.probe = {sim::touch_noise(sim::kProbeClasses.at(options.probe), options.seed), stylus};
  scatter.slide_step_mm = kSlideStep_mm;
  return scatter;
}

sim::TracerScatter tracer_of(const FaceGearOptions& options) {
  sim::TracerScatter scatter;
  scatter.perfect = !(options.tracer_um > 0.0);
  if (!scatter.perfect) scatter.reading_mm = options.tracer_um / kUmPerMm;
  scatter.seed = sim::seed_of(options.seed, sim::SeedOf::instruments);
  return scatter;
}

FaceGearResult run_face_gear(const FaceGearOptions& options, const host::Progress& progress) {
  FaceGearResult run;
  run.options = options;
  run.machine = host::read_machine_file(options.machine);
  if (!run.machine.probe) throw host::UserError(run.machine.path + ": the machine has no [probe]");
  const host::GearChoice choice = host::choose_face_gear(options.gear);
  run.gear = choice.gear;
  run.inputs = {host::hashed_file("machine file", options.machine)};
  if (!host::is_published_gear(options.gear))
    run.inputs.push_back(host::hashed_file("gear", options.gear));
  host::require(make_face_grid(choice.gear, choice.plan, run.grid), options.gear);
  if (options.flanks < 1 || options.flanks > run.gear.teeth)
    throw host::UserError(fmt::format("--flanks: 1 to {}, not {}", run.gear.teeth, options.flanks));
  run.errors = make_face_errors(run.gear, options.form, options.seed);
  run.true_pitch = true_pitch(run.errors);
  run.worked_example_deg = worked_example_deg(run.gear);
  run.kernel_ns = measure_kernel_ns(run.gear, run.grid);

  const FaceScatter scatter = scatter_of(options, run.machine.probe->stylus);
  const FaceHall hall{run.machine,
                      make_yk7280_truth(run.machine, options.seed),
                      run.gear,
                      true_mounting(),
                      deviation_of(run.errors, run.gear, run.grid),
                      options.make_axes,
                      options.cycle_hz,
                      options.seed,
                      scatter,
                      calibrated(run, scatter)};
  progress(0.0, "identification of the machine");
  run.identification =
      sim::trace_errors(hall.truth, run.machine, traced_plan(scatter.slide_step_mm),
                        tracer_of(options), options.knots);
  const auto without = host::constant_tables(run.machine, zero_errors(), options.knots);
  for (const FaceStage stage : {FaceStage::one_ball, FaceStage::frame, FaceStage::compensated}) {
    const auto s = static_cast<std::size_t>(stage);
    const host::BuiltTables& built =
        stage == FaceStage::compensated ? *run.identification.built : *without;
    run.inspection[s] = inspect(hall, run, stage, built, progress);
    run.map_error[s] = map_error(run.inspection[s].maps, run.errors);
  }
  progress(1.0, "done");
  return run;
}

}  // namespace volcomp::face_gear
