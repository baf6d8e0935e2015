#pragma once
// Form grinding of an internal helical gear: the tracking errors of Z and C are monitored, the
// offsets of C learned in six updates of two rounds each, and the first and last gear inspected.
// docs/papers/internal-helical.md.

#include <filesystem>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/experiments/internal_helical/geometry_check.hpp"
#include "host_sim/experiments/internal_helical/grinder_control.hpp"
#include "host_sim/experiments/internal_helical/grinding.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/draws_of_run.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::internal_helical {

struct HelicalPitch {
  std::vector<double> position;  // along the reference circle, towards +angle, µm
  PitchDeviations figures;       // µm
};

struct HelicalProfile {
  std::size_t slot = 0;
  std::size_t side = 0;           // of kHelicalSides
  std::vector<double> deviation;  // transverse, at FlankGrinding::roll_length(), µm
  TraceDeviations figures;        // µm; slope positive: material grows towards the tip
};

// The ground gear on a measuring machine: pitch of all slots and profile of four, at mid face.
struct HelicalInspection {
  std::array<HelicalPitch, 2> pitch;
  std::vector<HelicalProfile> profile;
  double F_alpha = 0.0;  // the worst of the profiles; the paper gives one without a side
};

inline constexpr int kLearningUpdates = 6;  // leaves 15 % of the error
inline constexpr int kRoundsPerUpdate = 2;

struct InternalHelicalOptions {
  int seeds = 16;       // 1, 2, …
  host::Shard shard{};  // of the seeds, those that are computed
  int updates = kLearningUpdates;
  LearningWay way = LearningWay::right;
  GrindingTruth truth;
  std::filesystem::path machine;       // file
  sim::BusAxesFactory make_axes;       // with the compensation on a bus; empty: integrated
  sim::MachineWatch* watch = nullptr;  // of the integrated form
  std::size_t threads = 1;             // for the grinders; 1 where they share a bus

  [[nodiscard]] bool scatters() const { return truth.probe_mm > 0.0; }
  [[nodiscard]] host::DrawPlan draws() const {
    return {static_cast<std::size_t>(seeds), shard, threads};
  }
};

// A ground gear and the monitor's view of its grinding.
struct GroundGear {
  HelicalInspection inspection;
  double sync_rms_um = 0.0;  // of e_s in the face, on the flank
  double z_peak_mm = 0.0;    // largest |e_Z| in the face
};

struct SeedResult {
  GroundGear before;
  GroundGear after;
  std::vector<double> learning_um;  // sync_rms_um of all rounds
};

// Curves of the first seed, for the report; empty in a part without it.
struct HelicalDetail {
  MonitorView before;
  MonitorView after;
  LearnedTables tables;
  std::array<StrokeTrace, 2> pass_before;  // one each way
  std::array<StrokeTrace, 2> pass_after;
};

struct InternalHelicalResult {
  InternalHelicalOptions options;
  std::vector<host::HashedInput> inputs;
  host::GrindingFile job;
  InternalGear gear;
  std::vector<double> roll_length;
  GeometryCheck geometry;
  HelixEffect lags;              // what the lags of Z and C do one by one, and together
  std::vector<SeedResult> seed;  // all of them, or those of a shard
  HelicalDetail detail;
};

// Throws UserError.
[[nodiscard]] InternalHelicalResult run_internal_helical(const InternalHelicalOptions& options,
                                                         const host::Progress& progress);

}  // namespace volcomp::internal_helical
