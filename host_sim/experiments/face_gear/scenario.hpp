#pragma once
// A face gear measured on the YK7280: with the frame of one ball as in the paper, with the frame of
// thirty touches, and with the errors of the machine compensated as well. Every touch goes through
// drives, bus and node. docs/papers/face-gear.md.

#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/experiments/face_gear/inspection.hpp"
#include "host_sim/experiments/face_gear/machine_errors.hpp"
#include "host_sim/experiments/face_gear/truth.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/traced_errors.hpp"
#include "host_sim/sim/instruments/probe_class.hpp"

namespace volcomp::face_gear {

// Free of noise as it stands; the command line is not.
struct FaceGearOptions {
  std::filesystem::path machine;
  std::string gear = "table3";  // gear_choice.hpp
  int flanks = 1;               // pairs of flanks that are mapped, evenly over the gear
  FormTruth form = FormTruth::tables;
  std::uint64_t seed = 1;  // of the errors of machine and gear, and of all scatter
  std::size_t probe = 0;   // of sim::kProbeClasses; with none the scales have no steps either
  bool map_radius = true;  // by direction, from a sphere; else the one radius of the file counts
  int touches = 1;         // of each point; their mean counts
  // Standard deviation of a reading of the tracer that the axes are identified with; 0: nothing of
  // the identification scatters.
  double tracer_um = 0.0;
  std::size_t knots = kDefaultKnots;
  double cycle_hz = sim::kBusCycleOfFive_hz;
  sim::BusAxesFactory make_axes = sim::loopback_axes();
};

// What a touch scatters by, from the class of the probe and the scales of the slides.
// `stylus`: its axis in the tool frame.
[[nodiscard]] FaceScatter scatter_of(const FaceGearOptions& options,
                                     const Vec3& stylus = Vec3::UnitZ());
// How the identification scatters: the tracer, its stations, the scales of the slides.
[[nodiscard]] sim::TracerScatter tracer_of(const FaceGearOptions& options);

// The three ways to measure, in their order.
enum class FaceStage : std::uint8_t { one_ball, frame, compensated };
inline constexpr std::array<const char*, 3> kFaceStages{"one ball", "frame solved", "compensated"};

// How far the maps of an inspection are from what the gear is, µm, zeroed alike.
struct MapError {
  double rms = 0.0;
  double max = 0.0;
};

struct FaceGearResult {
  FaceGearOptions options;
  host::MachineFile machine;
  std::vector<host::HashedInput> inputs;
  FaceGear gear;
  FaceGrid grid;
  FaceGearErrors errors;
  sim::TracedErrors identification;
  std::array<FacePitch, 2> true_pitch;
  std::array<FaceInspection, 3> inspection;  // by FaceStage
  std::array<MapError, 3> map_error;
  double worked_example_deg = 0.0;  // frame angle of the paper's ball on this gear; NaN: no flank
  double kernel_ns = 0.0;           // one distance, on this computer

  [[nodiscard]] const FaceInspection& at(FaceStage stage) const {
    return inspection.at(static_cast<std::size_t>(stage));
  }
};

// Throws UserError.
[[nodiscard]] FaceGearResult run_face_gear(const FaceGearOptions& options,
                                           const host::Progress& progress);

}  // namespace volcomp::face_gear
