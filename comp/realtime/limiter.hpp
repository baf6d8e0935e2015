#pragma once
// Clamp, slew and ramp: what stands between a computed correction and a drive.

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "comp/realtime/inline.hpp"

namespace volcomp {

// One template for the tick (float, int32) and the double reference. A double is given a dead zone
// of 1e-12 so that a value exactly at the limit is not reported as limited.
template <class T>
struct Limiter {
  T limit{};  // |value| ≤ limit
  T rate{};   // |value − previous| ≤ rate

  static constexpr T kDeadZone =
      std::is_same_v<T, double> ? static_cast<T>(1e-12) : static_cast<T>(0);

  VOLCOMP_INLINE T clamp(T wanted, bool& hit) const { return between(-limit, limit, wanted, hit); }

  VOLCOMP_INLINE T slew(T wanted, T previous, bool& hit) const {
    return between(previous - rate, previous + rate, wanted, hit);
  }

 private:
  // Branches, not selections: what is limited is the exception.
  VOLCOMP_INLINE static T between(T lo, T hi, T wanted, bool& hit) {
    hit = false;
    if (wanted > hi) {
      hit = wanted > hi + kDeadZone;
      return hi;
    }
    if (wanted < lo) {
      hit = wanted < lo - kDeadZone;
      return lo;
    }
    return wanted;
  }
};

// Nearest integer, half to even, |x| < 2^22: adding 1.5·2^23 leaves the integer in the low mantissa
// bits (conventions, section 5). No library call, the same on every target.
VOLCOMP_INLINE std::int32_t round_half_even(float x) {
  const float shifted = x + 12582912.0F;
  std::int32_t bits = 0;
  std::memcpy(&bits, &shifted, sizeof bits);
  return bits - 0x4B400000;
}

inline constexpr float kMaxRounded = 4194303.0F;

// Smooth step from 0 to 1: s(u) = u³ (10 − 15u + 6u²), zero slope and curvature at both ends.
class Ramp {
 public:
  void restart(std::uint32_t ticks) {
    ticks_ = ticks;
    passed_ = 0;
    per_tick_ = ticks == 0 ? 0.0F : 1.0F / static_cast<float>(ticks);
  }

  [[nodiscard]] bool running() const { return passed_ < ticks_; }

  VOLCOMP_INLINE float advance() {
    if (passed_ >= ticks_) return 1.0F;
    ++passed_;
    const float u = static_cast<float>(static_cast<std::int32_t>(passed_)) * per_tick_;
    return passed_ == ticks_ ? 1.0F : u * u * u * (10.0F + u * (6.0F * u - 15.0F));
  }

 private:
  std::uint32_t ticks_ = 0;
  std::uint32_t passed_ = 0;
  float per_tick_ = 0.0F;
};

}  // namespace volcomp
