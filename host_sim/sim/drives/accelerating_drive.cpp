#include "host_sim/sim/drives/accelerating_drive.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp::sim {

AcceleratingDrive::AcceleratingDrive(const Settings& settings, double position_mm, double speed)
    : settings_(settings),
      loop_(2.0 * kPi * settings.loop_hz),
      position_(position_mm),
      speed_(speed),
      target_(position_mm),
      before_(position_mm - speed * settings.period_s) {}

void AcceleratingDrive::follow(double target_mm) {
  const double T = settings_.period_s;
  const double wanted_speed = (target_mm - target_) / T;
  const double fed_forward = (target_mm - 2.0 * target_ + before_) / (T * T);
  const double asked =
      fed_forward + loop_ * loop_ * following_error_mm() + 2.0 * loop_ * (wanted_speed - speed_);
  const double given = std::clamp(asked, -settings_.acceleration, settings_.acceleration);
  saturated_ = std::abs(asked) > settings_.acceleration;
  position_ += (speed_ + 0.5 * given * T) * T;
  speed_ += given * T;
  before_ = target_;
  target_ = target_mm;
}

}  // namespace volcomp::sim
