#pragma once
// A simulated machine under control: an interpolator, the axes it moves, and the true machine that
// all of them are.

#include <functional>
#include <memory>
#include <vector>

#include "host_sim/controller/axis_group.hpp"
#include "host_sim/machine/machine_file.hpp"
#include "host_sim/machine/true_machine.hpp"

namespace volcomp::sim {

class MotionCell {
 public:
  // `machine` must outlive the cell.
  MotionCell(const TrueMachine& machine, std::unique_ptr<AxisGroup> axes);

  using OnTick = std::function<void(const MotionCell&)>;

  // Stands still at a place until everything has settled, without travelling there.
  void place(const Vec3& at_mm);
  // Straight line with trapezoidal speed, then settles. `on_tick` sees every control period of the
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
  [[nodiscard]] const AxisGroup& axes() const { return *axes_; }

 private:
  void cycle(const Vec3& target_mm, const OnTick& on_tick);
  void settle();

  const TrueMachine& machine_;
  std::unique_ptr<AxisGroup> axes_;
  double period_s_;
  Vec3 target_ = Vec3::Zero();
};

// Builds a cell around a true machine, which must outlive it. `image`: tables of the compensation,
// empty for none. Throws UserError.
using CellFactory = std::function<std::unique_ptr<MotionCell>(
    const TrueMachine& machine, const CorrectionFile& correction,
    const std::vector<std::uint8_t>& image)>;

}  // namespace volcomp::sim
