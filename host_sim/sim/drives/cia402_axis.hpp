#pragma once
// The mechanics and the encoder behind a drive: follows a position, brakes, or stands; has its true
// position and the reading of the drive, which differ by where the drive was homed.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

namespace volcomp::sim {

// Time constant of the position loop of every simulated drive.
inline constexpr double kDriveTimeConstant_s = 0.002;

// One following axis: first-order position loop, 1 nm encoder, and the friction that makes an axis
// arrive differently from the two sides.
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

// Position units: those of the drive, 1 nm of a linear axis and 2⁻³¹ turn of a rotary one unless
// its settings differ; counted through.
inline constexpr double kDriveUnitsPerTurn = 2147483648.0;

// As INTEGER32 on the bus: a linear position stays at the end of the range.
constexpr std::int32_t saturated(std::int64_t units) {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(units, INT32_MIN, INT32_MAX));
}
// A rotary one wraps.
constexpr std::int32_t wrapped(std::int64_t units) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(units));
}

// Mechanics of another kind than the axis' own, counted through in position units.
struct ForeignMechanics {
  std::function<std::int64_t()> read;               // the encoder, now
  std::function<void(std::int64_t demand)> follow;  // one period; without a call the axis stands
};

class Cia402Axis {
 public:
  // `presliding_units`: way over which the reversal of the axis builds up.
  Cia402Axis(double period_s, double time_constant_s, double presliding_units = 2000.0)
      : period_s_(period_s),
        gain_(1.0 - std::exp(-period_s / time_constant_s)),
        drive_(period_s, time_constant_s, presliding_units) {}

  // The world's side. The reading moves along: the encoder is absolute.
  void stand_at(std::int64_t units);
  // From now on these are the mechanics. The reading is then of the begin of a period, as an
  // encoder that is sampled at SYNC; such an axis stops at once and knows no way between readings.
  void couple(ForeignMechanics mechanics);
  [[nodiscard]] double position_units() const { return drive_.position_mm() * 1e6; }
  [[nodiscard]] double approach() const { return drive_.approach(); }

  // The drive's side: positions as the drive counts them.
  [[nodiscard]] std::int64_t reading() const { return drive_.encoder_nm() + zero_shift_; }
  // On the way of the last period, as if it had been travelled evenly: 0 at its begin, 1 at its
  // end.
  [[nodiscard]] std::int64_t reading_at(double part) const {
    return std::llround(position_units() - (1.0 - part) * step_) + zero_shift_;
  }
  // From now on the place where the axis stands reads `units`.
  void home(std::int64_t units) { zero_shift_ = units - drive_.encoder_nm(); }

  // One period each.
  void follow(std::int64_t demand);
  void stand();
  // Slows down evenly from the speed the axis has; true once it stands.
  [[nodiscard]] bool brake(double units_per_s2);

 private:
  void advance(std::int64_t command);
  [[nodiscard]] double speed_before_braking() const;

  double period_s_;
  double gain_;  // share of the distance to the command that one period covers
  AxisDrive drive_;
  ForeignMechanics foreign_;  // empty: drive_
  std::int64_t zero_shift_ = 0;
  double step_ = 0.0;           // units, last period
  double previous_step_ = 0.0;  // the one before
  double braking_step_ = 0.0;
  bool braking_ = false;
};

}  // namespace volcomp::sim
