#include "host_sim/controller/motion_cell.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "comp/units.hpp"

namespace volcomp::sim {
namespace {

constexpr double kAcceleration_mm_s2 = 2000.0;

// Distance travelled along a trapezoidal profile.
class Trapezoid {
 public:
  Trapezoid(double length, double feed)
      : length_(length),
        speed_(std::min(feed, std::sqrt(length * kAcceleration_mm_s2))),
        ramp_s_(speed_ / kAcceleration_mm_s2),
        duration_s_(length > 0.0 ? length / speed_ + ramp_s_ : 0.0) {}

  [[nodiscard]] double duration() const { return duration_s_; }
  [[nodiscard]] double at(double t) const {
    if (t >= duration_s_) return length_;
    if (t < ramp_s_) return 0.5 * kAcceleration_mm_s2 * t * t;
    const double rest = duration_s_ - t;
    if (rest < ramp_s_) return length_ - 0.5 * kAcceleration_mm_s2 * rest * rest;
    return speed_ * (t - 0.5 * ramp_s_);
  }

 private:
  double length_;
  double speed_;
  double ramp_s_;
  double duration_s_;
};

}  // namespace

MotionCell::MotionCell(const TrueMachine& machine, std::unique_ptr<AxisGroup> axes)
    : machine_(machine), axes_(std::move(axes)), period_s_(axes_->period_s()) {}

void MotionCell::cycle(const Vec3& target_mm, const OnTick& on_tick) {
  target_ = target_mm;
  axes_->cycle(to_targets(target_mm));
  if (on_tick) on_tick(*this);
}

// Until the offsets stop changing, the ramp is over and the drives have arrived.
void MotionCell::settle() {
  constexpr int kQuiet = 3;
  constexpr int kLongest = 20000;
  int quiet = 0;
  for (int i = 0; i < kLongest && quiet < kQuiet; ++i) {
    const OffsetsNm before = axes_->offset_nm();
    cycle(target_, {});
    const bool still =
        axes_->offset_nm() == before && axes_->following_error_nm() < 0.5 && !axes_->ramping();
    quiet = still ? quiet + 1 : 0;
  }
}

void MotionCell::place(const Vec3& at_mm) {
  axes_->stand_at(at_mm);
  target_ = at_mm;
  settle();
}

void MotionCell::move_to(const Vec3& to_mm, double feed_mm_per_s, const OnTick& on_tick) {
  const Vec3 from = target_;
  const Vec3 path = to_mm - from;
  const Trapezoid profile(path.norm(), feed_mm_per_s);
  if (profile.duration() > 0.0) {
    const Vec3 direction = path / path.norm();
    for (int k = 1; k * period_s_ < profile.duration(); ++k) {
      cycle(from + profile.at(k * period_s_) * direction, on_tick);
    }
    cycle(to_mm, on_tick);
  }
  settle();
}

void MotionCell::circle(const Vec3& centre_mm, double radius_mm, double feed_mm_per_s, int turns,
                        const OnTick& on_tick) {
  const double length = 2.0 * kPi * radius_mm * std::abs(turns);
  const Trapezoid profile(length, feed_mm_per_s);
  const double sense = turns < 0 ? -1.0 : 1.0;
  for (int k = 1; k * period_s_ < profile.duration(); ++k) {
    const double angle = sense * profile.at(k * period_s_) / radius_mm;
    cycle(centre_mm + radius_mm * Vec3(std::cos(angle), std::sin(angle), 0.0), on_tick);
  }
}

Vec3 MotionCell::deviation_mm() const {
  const Pose q = axes_->position();
  const Vec3 shown(q[0], q[1], q[2]);
  return shown - target_ +
         machine_.error(q, axes_->approach(), machine_.chain.tool_point()).position_work;
}

}  // namespace volcomp::sim
