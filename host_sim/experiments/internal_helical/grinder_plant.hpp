#pragma once
// The axes of the grinder as they really are: position loops with lag, the ripple of Z, errors of C
// that its encoder sees, encoders. Positions at the drives are in their units, 1 nm and 2^-31 turn.
//
// One period of an axis: read(), then follow(); at a SYNC the encoders are sampled together, before
// the targets of the new period have moved anything.

#include <vector>

#include "host_sim/experiments/internal_helical/stroke_plan.hpp"
#include "host_sim/sim/drives/cia402_axis.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::internal_helical {

inline constexpr double kWirePerRad = sim::kDriveUnitsPerTurn / (2.0 * kPi);

// Where the axes really are, which only the flank shows: actual − original command.
struct LagErrors {
  double z = 0.0;  // position of the wheel, mm
  double e_x = 0.0;
  double e_z = 0.0;
  double e_c = 0.0;
};

class GrinderPlant {
 public:
  // At rest at `standing`. `seed`: of everything random.
  GrinderPlant(const InternalGear& gear, const GrindingTruth& truth, const StrokeStep& standing,
               std::uint64_t seed);

  // The wheel is before this slot: the errors of the slot and of this one pass are there.
  void begin_pass(std::uint16_t slot);

  [[nodiscard]] std::int64_t read_x() const;
  [[nodiscard]] std::int64_t read_z() const;
  [[nodiscard]] std::int64_t read_c() const;
  // X stands while it grinds.
  void follow_x(std::int64_t demand) { x_ = demand; }
  void follow_z(std::int64_t demand);
  void follow_c(std::int64_t demand);

  [[nodiscard]] LagErrors errors(const StrokeStep& command) const;

 private:
  [[nodiscard]] double true_z() const;   // mm
  [[nodiscard]] double c_error() const;  // on top of the loop, rad

  GrindingTruth truth_;
  sim::Random random_;
  std::vector<double> slot_error_;  // of C, repeatable, rad
  std::int64_t x_;
  double z_;  // of the loop, without ripple, mm
  double c_;  // of the loop, without errors, rad
  std::size_t slot_ = 0;
  double pass_error_ = 0.0;
  double x_error_ = 0.0;
};

}  // namespace volcomp::internal_helical
