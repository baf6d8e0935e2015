#pragma once
// The L300G measuring a gear, before and after the errors of its axes are compensated: the
// paper's procedure, every touch through drives, bus and node (docs/papers/l300g.md).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/experiments/l300g/inspection.hpp"
#include "host_sim/experiments/l300g/lobing_check.hpp"
#include "host_sim/experiments/l300g/mandrel.hpp"
#include "host_sim/experiments/l300g/measuring_centre.hpp"
#include "host_sim/experiments/l300g/printed_procedure.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/traced_errors.hpp"
#include "host_sim/sim/instruments/probe_class.hpp"

namespace volcomp::l300g {

// Whether a point depends on the feed: the same place of a flank, touched at 10, 30, 100, 300 and
// 1000 mm/min.
struct FeedCheck {
  std::vector<double> feed_mm_min;
  std::vector<double> raw_nm;        // normal to the flank, as latched; from the mean of all
  std::vector<double> corrected_nm;  // as the node reports

  [[nodiscard]] double raw_spread_nm() const;
  [[nodiscard]] double corrected_spread_nm() const;
};

enum class Origin : std::uint8_t {
  nominal,  // the axis of A is where the machine file has it
  mandrel,  // where the calibration has found it, with the same tables as the gear
};

// The least touches of a point that, filtered, give the gear its own grades in 95 of 100
// measurements with a probe of this of sim::kProbeClasses (docs/papers/l300g.md, "With a probe that
// scatters").
inline constexpr std::array<std::size_t, sim::kProbeClasses.size()> kLeastTouches{1, 1, 3};

// What the compensation takes away.
enum class TableKind : std::uint8_t {
  none,        // nothing: the machine as drawn
  identified,  // the identified functions
  means,       // the mean of each true function, the most that the procedure of the paper can find
};
inline constexpr std::array<const char*, 3> kTableKinds{"none", "identified", "means"};

struct L300gOptions {
  std::filesystem::path machine;
  std::filesystem::path gear;  // a spur gear (involute_gear_file.hpp); empty: the master gear
  std::string errors = "p8";   // machine_errors.hpp
  PathStyle path = PathStyle::fixed_a;
  Origin origin = Origin::nominal;
  TableKind tables = TableKind::identified;  // of the compensation
  std::uint64_t seed = 1;                    // of the phases of waves
  std::size_t knots = kDefaultKnots;         // per table: what the node has room for
  double cycle_hz = sim::kBusCycleOfFive_hz;
  sim::BusAxesFactory make_axes = sim::loopback_axes();
  std::size_t probe = 0;   // of sim::kProbeClasses
  bool map_radius = true;  // by direction, from a sphere; else the one radius of the mandrel counts
  // Standard deviation of a reading of the tracer that the axes are identified with; 0: nothing of
  // the identification scatters.
  double tracer_um = 0.0;
  InspectionRules rules;
  std::uint32_t draw = 0;  // which of several measurements with that seed

  [[nodiscard]] bool scatters() const { return probe != 0 || tracer_um > 0.0; }
};

struct L300gResult {
  L300gOptions options;
  host::MachineFile machine;
  std::vector<host::HashedInput> inputs;
  InvoluteGear gear;
  MandrelCalibration calibration;  // uncompensated: what the machine knows of its probe at first
  MandrelEffect longer_arm;        // per kLongerArm_mm
  std::vector<MandrelEffect> higher_pivot;  // by kHigherPivots_mm
  sim::TracedErrors identification;
  PrintedProcedure printed;
  Vec3 orientation;      // of the probe against the gear, at the pitch point, rad: stays
  GearInspection truth;  // what a perfect machine would find
  GearInspection before;
  GearInspection after;
  std::optional<GearInspection> on_centre;  // by a second instrument; none: nothing scatters
  FeedCheck feeds;
  LobingCheck lobing;
};

inline constexpr double kLongerArm_mm = 1e-3;
inline constexpr std::array<double, 3> kHigherPivots_mm{1.0, 5.0, 10.0};

// How the identification scatters.
[[nodiscard]] sim::TracerScatter tracer_of(const L300gOptions& options);

// Throws UserError.
[[nodiscard]] L300gResult run_l300g(const L300gOptions& options, const host::Progress& progress);

}  // namespace volcomp::l300g
