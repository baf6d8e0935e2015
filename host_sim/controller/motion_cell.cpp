#include "host_sim/controller/motion_cell.hpp"

#include "comp/tables/crc32.hpp"
#include "comp/tables/image.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr double kDriveTimeConstant_s = 0.002;
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

std::unique_ptr<LoadedCompensator> make_compensator(const CorrectionFile& settings,
                                                    const std::vector<std::uint8_t>& image) {
  if (image.empty()) {
    auto idle = std::make_unique<LoadedCompensator>();
    require(idle->configure(compensator_settings(settings)), "[correction]");
    return idle;
  }
  const auto tables = std::make_unique<MachineTables>();
  require(decode_image(image, kDefaultKnots, *tables), "table image");
  auto compensator =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(tables->machine)});
  require(compensator->configure(compensator_settings(settings)), "[correction]");
  const Vec3 tool = Eigen::Map<const Vec3>(tables->machine.tool_point.data());
  const std::uint32_t crc = crc32({image.data(), image.size()});
  require(compensator->stage(*tables, tool, crc), "table image");
  require(compensator->activate(), "table image");
  return compensator;
}

}  // namespace

LoadedCompensator::Settings compensator_settings(const CorrectionFile& c) {
  LoadedCompensator::Settings s;
  const double period = 1.0 / c.tick_hz;
  for (AxisLimits& l : s.axis) {
    l.limit = static_cast<std::int32_t>(to_nm(c.limit_mm));
    l.rate = static_cast<std::int32_t>(std::max<std::int64_t>(1, to_nm(c.rate_mm_per_s * period)));
    l.soft_rate = std::max(
        1, std::min(l.rate, static_cast<std::int32_t>(to_nm(c.limit_mm * period / c.ramp_s))));
    l.hysteresis = static_cast<std::int32_t>(to_nm(c.hysteresis_mm));
    l.max_step = to_nm(2.0 * c.max_speed_mm_per_s *
                       period);  // seed 001, bad input: a jump beyond v_max·Δt·2
  }
  s.ramp_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(c.ramp_s * c.tick_hz)));
  return s;
}

MotionCell::MotionCell(const TrueMachine& machine, const CorrectionFile& settings,
                       const std::vector<std::uint8_t>& image)
    : machine_(machine),
      period_s_(1.0 / settings.tick_hz),
      axes_(period_s_, kDriveTimeConstant_s),
      compensator_(make_compensator(settings, image)),
      loop_(*compensator_, axes_) {}

void MotionCell::servo_period(const Vec3& target_mm, const OnTick& on_tick) {
  target_ = target_mm;
  axes_.set_target(target_mm);
  loop_.on_servo_interrupt();
  ++ticks_;
  if (on_tick) on_tick(*this);
}

// Until the offsets stop changing, the ramp is over and the drives have arrived.
void MotionCell::settle(const OnTick& on_tick) {
  constexpr int kQuiet = 3;
  constexpr int kLongest = 20000;
  int quiet = 0;
  for (int i = 0; i < kLongest && quiet < kQuiet; ++i) {
    const auto before = axes_.offset_nm();
    servo_period(target_, on_tick);
    const bool ramping = (loop_.last_output().status[0] & kRamping) != 0;
    const bool still = axes_.offset_nm() == before && axes_.following_error_nm() < 0.5 && !ramping;
    quiet = still ? quiet + 1 : 0;
  }
}

void MotionCell::place(const Vec3& at_mm) {
  axes_.stand_at(at_mm);
  target_ = at_mm;
  settle({});
}

void MotionCell::move_to(const Vec3& to_mm, double feed_mm_per_s, const OnTick& on_tick) {
  const Vec3 from = target_;
  const Vec3 path = to_mm - from;
  const Trapezoid profile(path.norm(), feed_mm_per_s);
  if (profile.duration() > 0.0) {
    const Vec3 direction = path / path.norm();
    for (int k = 1; k * period_s_ < profile.duration(); ++k) {
      servo_period(from + profile.at(k * period_s_) * direction, on_tick);
    }
    servo_period(to_mm, on_tick);
  }
  settle({});
}

void MotionCell::circle(const Vec3& centre_mm, double radius_mm, double feed_mm_per_s, int turns,
                        const OnTick& on_tick) {
  const double length = 2.0 * kPi * radius_mm * std::abs(turns);
  const Trapezoid profile(length, feed_mm_per_s);
  const double sense = turns < 0 ? -1.0 : 1.0;
  for (int k = 1; k * period_s_ < profile.duration(); ++k) {
    const double angle = sense * profile.at(k * period_s_) / radius_mm;
    servo_period(centre_mm + radius_mm * Vec3(std::cos(angle), std::sin(angle), 0.0), on_tick);
  }
}

Vec3 MotionCell::deviation_mm() const {
  const Pose q = axes_.position();
  const Vec3 shown(q[0], q[1], q[2]);
  return shown - target_ +
         machine_.error(q, axes_.approach(), machine_.chain.tool_point()).position_work;
}

}  // namespace volcomp::sim
