#pragma once
// A simulated machine under control: an interpolator, the axes it moves, and the true machine that
// all of them are.

#include <functional>
#include <memory>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/controller/axis_group.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// How a probing move has ended.
struct Touch {
  bool touched = false;                         // at least one axis has latched
  std::array<bool, host::kMostAxes> latched{};  // which
  Pose latch{};                                 // where: encoders, offsets included, mm or rad
};

class MotionCell {
 public:
  // `machine` must outlive the cell.
  MotionCell(const TrueMachine& machine, std::unique_ptr<AxisGroup> axes);

  using OnTick = std::function<void(const MotionCell&)>;

  // Stands still at a place until everything has settled, without travelling there.
  void place(const Pose& at);
  // Straight line of all axes together (straight_move.hpp: what the feed means), then settles.
  // `on_tick` sees every control period of the motion.
  void move_to(const Pose& to, double feed, const OnTick& on_tick = {});

  // Like move_to(), but stops on its way as soon as an axis reports a latch; then goes to `retract`
  // and settles there. An axis that latches several times, for instance because the probe bounces,
  // leaves its last latch. A probe that is in contact from the beginning has no edge and touches
  // nothing.
  [[nodiscard]] Touch probe_to(const Pose& to, double feed, const Pose& retract,
                               double retract_feed);

  // Stands still until something is so; false when it is not after `most` periods.
  [[nodiscard]] bool hold(const std::function<bool()>& until, int most);

  // --- machines whose first three axes are X, Y and Z
  void place(const Vec3& at_mm) { place(host::pose_of(at_mm)); }
  void move_to(const Vec3& to_mm, double feed_mm_per_s, const OnTick& on_tick = {}) {
    move_to(host::pose_of(to_mm), feed_mm_per_s, on_tick);
  }
  // Full circle in the XY plane, counter-clockwise (turns > 0) or clockwise, starting and ending at
  // angle 0.
  void circle(const Vec3& centre_mm, double radius_mm, double feed_mm_per_s, int turns,
              const OnTick& on_tick);

  [[nodiscard]] Vec3 target_mm() const { return {target_[0], target_[1], target_[2]}; }

  // --- what the world sees
  // Where the functional point really is relative to the work, against where it should be at the
  // commanded target: mm, work frame.
  [[nodiscard]] Vec3 deviation_mm() const;
  // The same of the orientation: rotation vector, work frame.
  [[nodiscard]] Vec3 orientation_rad() const;
  [[nodiscard]] const Pose& target() const { return target_; }
  [[nodiscard]] const AxisGroup& axes() const { return *axes_; }

 private:
  void cycle(const Pose& target, const OnTick& on_tick);
  void settle();
  [[nodiscard]] Touch touch_since(const Latches& before) const;
  [[nodiscard]] Vec3 shown_beside_target(const Pose& shown) const;

  const TrueMachine& machine_;
  host::AxisKinds kinds_;
  std::unique_ptr<AxisGroup> axes_;
  double period_s_;
  Pose target_{};
};

// Builds a cell around a true machine, which must outlive it. `image`: tables of the compensation,
// empty for none. Throws UserError.
using CellFactory = std::function<std::unique_ptr<MotionCell>(
    const TrueMachine& machine, const host::CorrectionFile& correction,
    const std::vector<std::uint8_t>& image)>;

}  // namespace volcomp::sim
