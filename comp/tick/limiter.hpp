#pragma once
// Clamp, rounding and ramp: what stands between a computed correction and the limiter of offsets.

#include <cstdint>

#include "comp/core/bytes.hpp"
#include "comp/core/inline.hpp"

namespace volcomp {

// |a − b| > most, most ≥ 0; a − b wraps.
VOLCOMP_INLINE bool further(std::int32_t a, std::int32_t b, std::int32_t most) {
  const auto span = static_cast<std::uint32_t>(most);
  return static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b) + span > 2U * span;
}

// A largest magnitude, ≥ 0, in the form it is compared in: magnitudes of floats compare like
// integers (IEEE 754).
class Magnitude {
 public:
  constexpr Magnitude() = default;
  explicit Magnitude(float most) : twice_(bits_of(most) << 1U) {}

  [[nodiscard]] float value() const { return bit_cast<float>(twice_ >> 1U); }
  // The same magnitude with the sign of `x`.
  VOLCOMP_INLINE float signed_like(float x) const {
    return bit_cast<float>((bits_of(x) & 0x80000000U) | twice_ >> 1U);
  }
  // NaN exceeds all.
  VOLCOMP_INLINE friend bool exceeds(float x, Magnitude most) {
    return bits_of(x) << 1U > most.twice_;
  }

  // Neither infinite nor not a number.
  VOLCOMP_INLINE static bool finite(float x) { return bits_of(x) << 1U < 0xFF00'0000U; }
  VOLCOMP_INLINE static bool negative(float x) { return bits_of(x) >> 31U != 0; }

 private:
  VOLCOMP_INLINE static std::uint32_t bits_of(float x) { return bit_cast<std::uint32_t>(x); }

  std::uint32_t twice_ = 0;
};

// Nearest integer, half to even, |x| < 2^22: adding 1.5·2^23 leaves the integer in the low mantissa
// bits (conventions, section 5). Anything else becomes some integer beyond ±(2^22 − 1): numbers
// further out, infinities and what is not a number. No library call, the same on every target.
VOLCOMP_INLINE std::int32_t round_half_even(float x) {
  return static_cast<std::int32_t>(bit_cast<std::uint32_t>(x + 12582912.0F) - 0x4B400000U);
}

inline constexpr std::int32_t kMostRounded = 4'194'303;
inline constexpr float kMaxRounded = 4194303.0F;

// Smooth step from 0 to 1: s(u) = u³ (10 − 15u + 6u²), zero slope and curvature at both ends.
class Ramp {
 public:
  void restart(std::uint32_t ticks) {
    ticks_ = ticks;
    next_ = ticks == 0 ? 0 : 1;
    per_tick_ = ticks == 0 ? 0.0F : 1.0F / static_cast<float>(ticks);
    ten_ = ticks < kLongRamp ? 10.0F : 9.999998F;
    first_ = ticks <= 1 ? 1.0F : smooth(per_tick_);
  }

  // Has steps to take.
  [[nodiscard]] bool running() const { return next_ - 1U < ticks_; }
  // From the second tick after its last step on. A ramp that begins before that continues this one.
  [[nodiscard]] bool at_rest() const { return next_ == 0; }

  // 0 at rest.
  [[nodiscard]] std::uint32_t next() const { return next_; }

  // Factor of the first tick. It is known beforehand: this tick, the one of an exchange of tables,
  // has enough to do.
  VOLCOMP_INLINE float begin() {
    next_ = 2;
    return first_;
  }

  // Factor of one more tick, at most 1. Not at rest.
  VOLCOMP_INLINE float advance() {
    const std::uint32_t step = next_;
    next_ = step + 1U;
    if (step < ticks_) return factor(step);
    if (step > ticks_) next_ = 0;
    return 1.0F;
  }

 private:
  [[nodiscard]] VOLCOMP_INLINE float factor(std::uint32_t step) const {
    return smooth(static_cast<float>(static_cast<std::int32_t>(step)) * per_tick_);
  }
  [[nodiscard]] VOLCOMP_INLINE float smooth(float u) const {
    return u * u * u * (ten_ + u * (6.0F * u - 15.0F));
  }

  std::uint32_t next_ = 0;  // step, 1…ticks; ticks + 1 in the tick after the last; 0 at rest
  std::uint32_t ticks_ = 0;
  float per_tick_ = 0.0F;
  float first_ = 1.0F;
  // In ramps of 269 ticks and more rounding would bring the factor up to 1.1e-6 above 1 before the
  // end: with 8 mm to go, an offset 9 nm beyond its limit. Two units of the last place less prevent
  // it; a comparison would cost every tick of a ramp.
  static constexpr std::uint32_t kLongRamp = 269;
  float ten_ = 10.0F;
};

}  // namespace volcomp
