#pragma once
// One following axis: first-order position loop, 1 nm encoder, and the friction that makes an axis
// arrive differently from the two sides.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace volcomp::sim {

// Time constant of the position loop of every simulated drive.
inline constexpr double kDriveTimeConstant_s = 0.002;

class AxisDrive {
 public:
  // `presliding_nm`: way over which the reversal builds up.
  AxisDrive(double period_s, double time_constant_s, double presliding_nm = 2000.0)
      : gain_(1.0 - std::exp(-period_s / time_constant_s)), presliding_nm_(presliding_nm) {}

  void stand_at(std::int64_t position_nm) { position_nm_ = static_cast<double>(position_nm); }

  void command(std::int64_t position_nm) {
    const double step = gain_ * (static_cast<double>(position_nm) - position_nm_);
    position_nm_ += step;
    // Reversal builds up over 2 µm of travel and then stays: a nanometre of correction does not
    // turn it round.
    approach_ = std::clamp(approach_ + 2.0 * step / presliding_nm_, -1.0, 1.0);
  }

  [[nodiscard]] double position_mm() const { return position_nm_ * 1e-6; }
  [[nodiscard]] std::int64_t encoder_nm() const { return std::llround(position_nm_); }
  [[nodiscard]] double approach() const { return approach_; }  // −1…+1

 private:
  double gain_;
  double presliding_nm_;
  double position_nm_ = 0.0;
  double approach_ = 0.0;
};

}  // namespace volcomp::sim
