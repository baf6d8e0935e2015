#include "host_sim/sim/controller/motion_cell.hpp"

#include <cmath>
#include <utility>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/sim/controller/straight_move.hpp"

namespace volcomp::sim {

MotionCell::MotionCell(const TrueMachine& machine, std::unique_ptr<AxisGroup> axes)
    : machine_(machine),
      kinds_(host::axis_kinds(machine.chain)),
      axes_(std::move(axes)),
      period_s_(axes_->period_s()) {}

void MotionCell::cycle(const Pose& target, const OnTick& on_tick) {
  target_ = target;
  axes_->cycle(kinds_.targets(target));
  if (on_tick) on_tick(*this);
}

// Until the offsets stop changing, the ramp is over and the drives have arrived.
void MotionCell::settle() {
  constexpr int kQuiet = 3;
  constexpr int kLongest = 20000;
  int quiet = 0;
  for (int i = 0; i < kLongest && quiet < kQuiet; ++i) {
    const host::Offsets before = axes_->offset();
    cycle(target_, {});
    const bool still =
        axes_->offset() == before && axes_->following_error() < 0.5 && !axes_->ramping();
    quiet = still ? quiet + 1 : 0;
  }
}

bool MotionCell::hold(const std::function<bool()>& until, int most) {
  for (int i = 0; i < most && !until(); ++i)
    cycle(target_, {});
  return until();
}

void MotionCell::place(const Pose& at) {
  axes_->stand_at(at);
  target_ = at;
  settle();
}

void MotionCell::move_to(const Pose& to, double feed, const OnTick& on_tick) {
  const StraightMove move(target_, to, kinds_, feed);
  if (move.duration_s() > 0.0) {
    for (int k = 1; k * period_s_ < move.duration_s(); ++k)
      cycle(move.at(k * period_s_), on_tick);
    cycle(to, on_tick);
  }
  settle();
}

Touch MotionCell::touch_since(const Latches& before) const {
  const Latches now = axes_->latches();
  Touch touch;
  for (std::size_t a = 0; a < kinds_.count; ++a) {
    touch.latched[a] = now[a].count != before[a].count;
    touch.latch[a] = now[a].position;
    touch.touched = touch.touched || touch.latched[a];
  }
  return touch;
}

Touch MotionCell::probe_to(const Pose& to, double feed, const Pose& retract, double retract_feed) {
  const Latches before = axes_->latches();
  const StraightMove move(target_, to, kinds_, feed);
  int k = 0;
  while (k * period_s_ < move.duration_s() && !touch_since(before).touched)
    cycle(move.at(++k * period_s_), {});
  const double stop_s = k * period_s_;
  const double braking_s = move.braking_s(stop_s);
  for (int i = 1; (i - 1) * period_s_ < braking_s; ++i)
    cycle(move.braking(stop_s, i * period_s_), {});
  // A slow drive may report its latch a cycle after the others.
  settle();
  const Touch touch = touch_since(before);
  move_to(retract, retract_feed);
  return touch;
}

void MotionCell::circle(const Vec3& centre_mm, double radius_mm, double feed_mm_per_s, int turns,
                        const OnTick& on_tick) {
  const double length = 2.0 * kPi * radius_mm * std::abs(turns);
  const Trapezoid profile(length, feed_mm_per_s, kAcceleration_mm_s2);
  const double sense = turns < 0 ? -1.0 : 1.0;
  for (int k = 1; k * period_s_ < profile.duration_s(); ++k) {
    const double angle = sense * profile.at(k * period_s_) / radius_mm;
    cycle(host::pose_of(centre_mm + radius_mm * Vec3(std::cos(angle), std::sin(angle), 0.0)),
          on_tick);
  }
}

// From where the ideal machine is at the target to where it is at `shown`, work frame.
Vec3 MotionCell::shown_beside_target(const Pose& shown) const {
  const MachineChain& chain = machine_.chain;
  const Vec3 tool = chain.tool_point();
  if (chain.has_rotary())
    return ideal_points(chain, shown, tool).work - ideal_points(chain, target_, tool).work;
  // The difference of the coordinates, without the rounding of two points a metre away.
  Vec3 way = Vec3::Zero();
  for (std::size_t a = 0; a < kinds_.count; ++a)
    way += (shown[a] - target_[a]) * jacobian_column(chain, shown, tool, a);
  return chain.ideal(chain.work(), shown).R.transpose() * way;
}

Vec3 MotionCell::deviation_mm() const {
  const Pose q = axes_->position();
  return shown_beside_target(q) +
         machine_.error(q, axes_->approach(), machine_.chain.tool_point()).position_work;
}

Vec3 MotionCell::orientation_rad() const {
  const Pose q = axes_->position();
  const MachineChain& chain = machine_.chain;
  const auto tool_in_work = [&chain](const Pose& at) {
    const Frame work = chain.ideal(chain.work(), at);
    const Frame tool = chain.ideal(chain.tool(), at);
    return Mat3(work.R.transpose() * tool.R);
  };
  const Mat3 turn = tool_in_work(q) * tool_in_work(target_).transpose();
  const Vec3 beside_target(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                           turn(1, 0) - turn(0, 1));
  return 0.5 * beside_target +
         machine_.error(q, axes_->approach(), chain.tool_point()).orientation_work;
}

}  // namespace volcomp::sim
