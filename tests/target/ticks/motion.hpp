#pragma once
// What the measured ticks are given: every axis travels up and down its table, crosses knots and
// turns round, at the ends and anywhere else; on demand axes misbehave.

#include <cstdint>

#include "comp/core/units.hpp"
#include "comp/tables/direction.hpp"
#include "comp/tables/machine_tables.hpp"
#include "comp/tick/tick_types.hpp"
#include "tests/target/ticks/draw.hpp"
#include "tests/target/ticks/tally.hpp"

namespace volcomp::target {

class AxisMotion {
 public:
  AxisMotion() = default;
  AxisMotion(const AxisTable& table, bool rotary)
      : q0_(table.q0),
        pitch_(table.pitch),
        rotary_(rotary),
        unit_(rotary ? kMilliradian : kMillimetre) {
    // Tilts of ±0.5 rad keep the authority of the correcting axes.
    low_ = rotary ? -500 * unit_ : q0_ + 2 * unit_;
    high_ = rotary ? 500 * unit_ : table.last() - 2 * unit_;
    position_ = (low_ + high_) / 2;
  }

  // 0.1 to 2 mm or mrad further: up to 120 m/min at 1 kHz. Turns round once in 64 ticks. `offset`
  // of the last tick: in target mode the table is entered where it will have moved the axis to.
  Kinds step(Draw& draw, std::int32_t offset) {
    if (draw.once_in(64)) sense_ = -sense_;
    if (position_ > high_) sense_ = -1;
    if (position_ < low_) sense_ = 1;
    position_ += sense_ * (unit_ / 10 + unit_ / 1000 * static_cast<std::int64_t>(draw.below(1901)));
    return entered_segment(position_ + std::int64_t{offset} * (rotary_ ? 256 : 1)) | turned_round();
  }

  [[nodiscard]] std::int64_t position() const { return position_; }
  // Farther than an axis comes in one tick.
  [[nodiscard]] std::int64_t implausible_step() const { return 8 * unit_; }

 private:
  static constexpr std::int64_t kMillimetre = 1'000'000;
  static constexpr auto kMilliradian = static_cast<std::int64_t>(kUnitsPerRad / 1000.0);

  Kinds entered_segment(std::int64_t position) {
    const std::int64_t from_first = position - q0_;
    const std::int64_t segment =
        from_first >= 0 ? from_first / pitch_ : (from_first + 1) / pitch_ - 1;
    const bool entered = segment != segment_;
    segment_ = segment;
    return entered ? bit(Kind::segment) : 0U;
  }

  Kinds turned_round() {
    constexpr std::int32_t kHysteresis = AxisLimits{}.hysteresis;
    const Direction before = direction_.direction();
    const auto low = static_cast<std::uint32_t>(rotary_ ? position_ >> 8U : position_);
    return direction_.update(low, kHysteresis) != before ? bit(Kind::reversal) : 0U;
  }

  std::int64_t q0_ = 0;
  std::int64_t pitch_ = 1;
  bool rotary_ = false;
  std::int64_t unit_ = kMillimetre;
  std::int64_t low_ = 0;
  std::int64_t high_ = 0;
  std::int64_t position_ = 0;
  std::int64_t sense_ = 1;
  std::int64_t segment_ = 0;
  DirectionTracker direction_;
};

// Positions get lost, axes lose their reference, leave their tables or claim to be nowhere, each
// now and then and for some ticks.
class AxisTrouble {
 public:
  void disturb(AxisSample& sample, Draw& draw) {
    if (what_ == What::none) {
      if (draw.once_in(40)) what_ = static_cast<What>(1U + draw.below(4));
    } else if (draw.once_in(15)) {
      what_ = What::none;
    }
    switch (what_) {
      case What::none:
        break;
      case What::lost:
        sample.valid = false;
        break;
      case What::not_homed:
        sample.homed = false;
        break;
      case What::beyond:
        sample.position += 2 * kUnitsPerTurn;
        break;
      case What::absurd:
        sample.position = INT64_MIN + static_cast<std::int64_t>(draw.below(9));
        break;
    }
  }

 private:
  enum class What : std::uint8_t { none, lost, not_homed, beyond, absurd };
  What what_ = What::none;
};

}  // namespace volcomp::target
