#pragma once
// From an integer position to the six interpolated channels of one axis: one 32×32→64-bit multiply
// gives the knot index (upper 10 bits) and the fraction (lower 22 bits).

#include <array>
#include <cstdint>

#include "comp/realtime/inline.hpp"
#include "comp/units.hpp"

namespace volcomp {

// Values at a knot and their differences to the next one: one row, one load, v + t·d.
struct Knot {
  std::array<float, 6> v;
  std::array<float, 6> d;
};

inline constexpr unsigned kFractionBits = 22;
// Half of what the index could count: the scale of a longer table would not fit 32 bits.
inline constexpr std::uint32_t kMaxLookupKnots = 1U << (31 - kFractionBits);

struct AxisLookup {
  std::int64_t q0 = 0;
  std::uint32_t travel = 0;  // last − first knot, nm or 2^-32 turn
  std::uint32_t scale = 0;   // 2^(32 + fraction) / (pitch << shift)
  std::uint32_t margin = 0;  // half a pitch: further out is an alarm
  std::uint8_t shift = 0;
  bool periodic = false;
  float origin_nm = 0.0F;   // q0 of a linear axis
  std::uint32_t phase = 0;  // q0 of a rotary axis, 2^-32 turn
};

struct Located {
  const Knot* knot = nullptr;  // row of the direction in use
  const Knot* other =
      nullptr;          // row of the other direction while the direction is unknown, else null
  float t = 0.0F;       // 0…1 within the row
  std::uint32_t u = 0;  // distance from the first knot, held at the ends
};

enum class RangeState : std::uint8_t { inside, outside, far_outside };

struct Index {
  std::uint32_t row = 0;
  float t = 0.0F;
  std::uint32_t u = 0;
  RangeState range = RangeState::inside;
};

// `rotary` decides the unit: 2^-40 turn is reduced to 2^-32, which wraps like the axis does.
VOLCOMP_INLINE Index locate(const AxisLookup& axis, std::int64_t position, bool rotary) {
  std::int64_t r = position - axis.q0;  // both clamped before: no overflow
  if (rotary) r >>= 8;
  Index at;
  at.u = static_cast<std::uint32_t>(r);
  if (!(rotary && axis.periodic)) {
    const auto high = static_cast<std::int32_t>(r >> 32);
    if (high != 0 || at.u > axis.travel) {
      const bool below = high < 0;
      const std::int64_t excess = below ? -r : r - axis.travel;
      at.range = excess > axis.margin ? RangeState::far_outside : RangeState::outside;
      at.u = below ? 0U : axis.travel;
    }
  }
  const auto product = static_cast<std::uint64_t>(at.u << axis.shift) * axis.scale;
  const auto place = static_cast<std::uint32_t>(product >> 32U);
  constexpr float kPerFraction = 1.0F / static_cast<float>(1U << kFractionBits);
  at.row = place >> kFractionBits;
  at.t = static_cast<float>(static_cast<std::int32_t>(place & ((1U << kFractionBits) - 1U))) *
         kPerFraction;
  return at;
}

using ChannelValues = std::array<float, 6>;

VOLCOMP_INLINE void interpolate(const Located& at, ChannelValues& out) {
  const Knot& k = *at.knot;
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < 6; ++c)
    out[c] = k.v[c] + at.t * k.d[c];
  if (at.other != nullptr) {  // before the first motion: mean of both directions
    const Knot& o = *at.other;
    VOLCOMP_UNROLL
    for (std::size_t c = 0; c < 6; ++c)
      out[c] = 0.5F * (out[c] + (o.v[c] + at.t * o.d[c]));
  }
}

}  // namespace volcomp
