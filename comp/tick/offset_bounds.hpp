#pragma once
// The bounds of an offset: as a user states them, and as a tick uses them. Units: those of the
// offset (nm, 2^-32 turn, wire units) per tick.

#include <cstdint>

#include "comp/core/inline.hpp"

namespace volcomp {

inline constexpr std::int32_t kMostOffsetLimit = 4'194'303;     // what the rounding represents
inline constexpr std::int32_t kMostOffsetRate = 1'000'000'000;  // in effect unlimited
inline constexpr std::int32_t kMostOffsetAcceleration = 1 << 24;
inline constexpr std::int32_t kMostHeldOffset = 1 << 30;  // no drive starts further out

// S_a(d) = d + (d − a) + (d − 2a) + … over the positive terms: the way to standstill of an offset
// that moves by d in this tick and brakes by a per tick from then on. 0 for d ≤ 0; a ≥ 1. Twice the
// way must be representable.
constexpr std::int32_t stopping_way(std::int32_t d, std::int32_t a) {
  if (d <= 0) return 0;
  const std::int32_t n = (d - 1) / a + 1;
  return n * d - a * (n * (n - 1) / 2);
}

// D_a(x): the largest d with S_a(d) ≤ x, 0 ≤ x ≤ 2^30. For settings: √(2x/a) rounds; a tick finds
// it by two divisions.
constexpr std::int32_t stopping_step(std::int32_t x, std::int32_t a) {
  std::int32_t n = 0;
  std::int32_t way = 0;  // S(n·a)
  while (x - way >= a * (n + 1))
    way += a * ++n;
  const std::uint32_t sum = static_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(way);
  return static_cast<std::int32_t>(sum / static_cast<std::uint32_t>(n + 1));
}

// As a user states them.
struct OffsetLimits {
  std::int32_t limit = 200'000;    // largest |offset|, 1…kMostOffsetLimit
  std::int32_t rate = 10'000;      // largest change per tick, 1…kMostOffsetRate
  std::int32_t soft_rate = 1'000;  // the same in ticks at the soft rate, 1…rate
  // Largest change of the change per tick, 1…kMostOffsetAcceleration; 0 or ≥ 2·rate: none.
  std::int32_t acceleration = 0;

  [[nodiscard]] constexpr bool accelerates_freely() const {
    return acceleration == 0 || acceleration / 2 >= rate;
  }
};

// The field that is refused, or nullptr.
constexpr const char* refused_field(const OffsetLimits& l) {
  if (l.limit < 1 || l.limit > kMostOffsetLimit) return "limit";
  if (l.rate < 1 || l.rate > kMostOffsetRate) return "rate";
  if (l.soft_rate < 1 || l.soft_rate > l.rate) return "soft_rate";
  const bool too_large = !l.accelerates_freely() && l.acceleration > kMostOffsetAcceleration;
  return l.acceleration < 0 || too_large ? "acceleration" : nullptr;
}

// As a tick uses them.
struct OffsetBounds {
  std::int32_t rate = 0;
  std::int32_t free = 0;  // targets up to ±free are followed at their own speed
  std::int32_t soft_rate = 0;
  std::int32_t acceleration = 0;  // at most twice the stated rate, which bounds nothing
  std::int32_t limit = 0;

  constexpr OffsetBounds() = default;
  // The rate becomes one from which stopping takes at most half the limit, so that an offset that
  // follows a moving target can stop before the limit.
  constexpr explicit OffsetBounds(const OffsetLimits& l)
      : rate(l.rate),
        free(l.limit),
        soft_rate(l.soft_rate),
        acceleration(l.acceleration),
        limit(l.limit) {
    if (l.accelerates_freely()) {
      acceleration = 2 * l.rate;
      return;
    }
    const std::int32_t most = acceleration + stopping_step(limit / 2, acceleration);
    if (rate > most) rate = most;
    if (soft_rate > rate) soft_rate = rate;
    free -= stopping_way(rate, acceleration) - rate;
  }

  // The change of the change has no bound. One that is bounded is less than twice the rate: that is
  // the stated rate, or at least the acceleration.
  [[nodiscard]] constexpr bool none() const { return acceleration >= 2 * rate; }
  // A state that is safe within `b` is safe within these.
  [[nodiscard]] constexpr bool contain(const OffsetBounds& b) const {
    return limit >= b.limit && rate >= b.rate && acceleration >= b.acceleration;
  }
  friend constexpr bool operator==(const OffsetBounds& a, const OffsetBounds& b) {
    return a.rate == b.rate && a.free == b.free && a.soft_rate == b.soft_rate &&
           a.acceleration == b.acceleration && a.limit == b.limit;
  }
};

}  // namespace volcomp
