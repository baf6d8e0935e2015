#pragma once
// A simulated machine under control: interpolator, servo interrupt with the real compensator in it,
// drives, and the true machine that all of them move.

#include <functional>
#include <memory>

#include "comp/tables/machine_tables.hpp"
#include "firmware/integrated/servo_loop.hpp"
#include "host_sim/controller/simulated_axes.hpp"
#include "host_sim/machine/machine_file.hpp"

namespace volcomp::sim {

class MotionCell {
 public:
  // `image`: table image of the compensation, empty for an uncompensated machine. The image goes
  // the whole way: decoded, validated, folded, activated, ramped in. Throws UserError.
  MotionCell(const TrueMachine& machine, const CorrectionFile& settings,
             const std::vector<std::uint8_t>& image);

  using OnTick = std::function<void(const MotionCell&)>;

  // Stands still at a place until everything has settled, without travelling there.
  void place(const Vec3& at_mm);
  // Straight line with trapezoidal speed, then settles. `on_tick` sees every servo period of the
  // motion.
  void move_to(const Vec3& to_mm, double feed_mm_per_s, const OnTick& on_tick = {});
  // Full circle in the XY plane, counter-clockwise (turns > 0) or clockwise, starting and ending at
  // angle 0.
  void circle(const Vec3& centre_mm, double radius_mm, double feed_mm_per_s, int turns,
              const OnTick& on_tick);

  // Where the functional point really is relative to the work: what the NC shows for the commanded
  // target, plus its error.
  [[nodiscard]] Vec3 deviation_mm() const;  // actual − target
  [[nodiscard]] Vec3 target_mm() const { return target_; }
  [[nodiscard]] const SimulatedAxes& axes() const { return axes_; }
  [[nodiscard]] const LoadedCompensator& compensator() const { return *compensator_; }
  [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
  [[nodiscard]] double period_s() const { return period_s_; }

 private:
  void servo_period(const Vec3& target_mm, const OnTick& on_tick);
  void settle(const OnTick& on_tick);

  const TrueMachine& machine_;
  double period_s_;
  SimulatedAxes axes_;
  std::unique_ptr<LoadedCompensator> compensator_;
  ServoLoop<LoadedCompensator, SimulatedAxes> loop_;
  Vec3 target_ = Vec3::Zero();
  std::uint64_t ticks_ = 0;
};

// Settings of the compensator for a machine file: mm and seconds turned into units and ticks.
[[nodiscard]] LoadedCompensator::Settings compensator_settings(const CorrectionFile& correction);

}  // namespace volcomp::sim
