#pragma once
// Temperatures as sensors report them, before axes are believed to have grown: in hundredths of a
// degree Celsius, with what they may be and how fast they may change. A machine is heavy: what
// comes faster, or from outside −20…80 °C, is a fault of the sensor or its wire. Then, and when
// nothing comes any more, the last good value stays. The room for a change grows with the time
// since that value, so that a lasting change is believed in the end.

#include <array>
#include <cstdint>

#include "comp/tables/thermal.hpp"

namespace volcomp {

enum class TemperatureState : std::uint8_t {
  unknown = 0,      // none was ever good: the axis is as long as at the reference
  good = 1,         //
  stale = 2,        // nothing came for too long: the last good one is used
  implausible = 3,  // the latest was not believed: the last good one is used
};

class TemperatureInput {
 public:
  static constexpr std::int32_t kJump = 200;        // 2 K at once, and
  static constexpr std::int32_t kPerSecond = 10;    // 0.1 K more for every second
  static constexpr std::int32_t kLeast = -2'000;    // −20 °C
  static constexpr std::int32_t kMost = 8'000;      // 80 °C
  static constexpr std::int16_t kNone = INT16_MIN;  // the sensor is broken or not there

  // Seconds of any clock that only goes forward.
  void take(std::int16_t hundredths, std::uint32_t now_s) {
    heard_s_ = now_s;
    believed_ = plausible(hundredths, now_s);
    if (!believed_) return;
    known_ = true;
    value_ = hundredths;
    good_s_ = now_s;
  }

  [[nodiscard]] TemperatureState state(std::uint32_t now_s, std::uint32_t stale_s) const {
    if (known_ && now_s - heard_s_ > stale_s) return TemperatureState::stale;
    if (known_ && believed_) return TemperatureState::good;
    return heard_s_ == kNever ? TemperatureState::unknown : TemperatureState::implausible;
  }

  // The last good one, °C; not a number: there was none.
  [[nodiscard]] float celsius() const {
    return known_ ? 0.01F * static_cast<float>(value_) : kUnknownTemperature;
  }

 private:
  static constexpr std::uint32_t kNever = UINT32_MAX;

  [[nodiscard]] bool plausible(std::int32_t hundredths, std::uint32_t now_s) const {
    if (hundredths < kLeast || hundredths > kMost) return false;
    if (!known_) return true;
    const std::uint32_t waited_s = now_s - good_s_;
    if (waited_s > (kMost - kLeast) / kPerSecond) return true;
    const std::int32_t room = kJump + kPerSecond * static_cast<std::int32_t>(waited_s);
    return hundredths - value_ <= room && value_ - hundredths <= room;
  }

  std::int16_t value_ = 0;
  bool known_ = false;
  bool believed_ = false;
  std::uint32_t heard_s_ = kNever;
  std::uint32_t good_s_ = 0;
};

using TemperatureInputs = std::array<TemperatureInput, kTemperatureInputs>;

[[nodiscard]] inline Temperatures temperatures_of(const TemperatureInputs& inputs) {
  Temperatures celsius{};
  for (std::size_t i = 0; i < celsius.size(); ++i)
    celsius[i] = inputs[i].celsius();
  return celsius;
}

}  // namespace volcomp
