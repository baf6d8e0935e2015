#pragma once
// From an integer position to the six interpolated channels of one axis: one 32×32→64-bit multiply
// gives the knot index (upper 10 bits) and the fraction (lower 22 bits).

#include <array>
#include <cstdint>

#include "comp/realtime/direction.hpp"
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
  std::uint32_t usual_travel = 0;  // travel, or 0 for a table that is too long for usual ticks
  std::uint32_t scale = 0;         // 2^(32 + fraction) / (pitch << shift)
  std::uint32_t shift = 0;
  bool periodic = false;
  float origin_nm = 0.0F;    // q0 of a linear axis
  std::uint32_t phase = 0;   // q0 of a rotary axis, 2^-32 turn
  std::uint32_t travel = 0;  // last − first knot, nm or 2^-32 turn
  std::uint32_t margin = 0;  // half a pitch: further out is an alarm
};

// A usual tick compares the low 32 bits of a linear position with the last one. Within a table they
// tell how far the axis has moved as long as table, step and the largest offset on both ends do not
// fill 2^32 nm together.
inline constexpr std::uint32_t kMaxUsualStep = 1U << 28U;  // 0.27 m per tick
inline constexpr std::uint32_t kMaxUsualTravel = UINT32_MAX - kMaxUsualStep - (1U << 23U);

// Where an axis stands in its table.
struct Located {
  const Knot* knot;
  float t;              // 0…1 within the row
  float travel_nm;      // of a linear axis, held at the ends of the table
  std::uint32_t angle;  // of a rotary axis, 2^-32 turn, held likewise
};

enum class RangeState : std::uint8_t { inside, outside, far_outside };

// Distance from the first knot in the units of the lookup: nm, or 2^-32 turn, to which 2^-40 turn
// is reduced so that it wraps like the axis does; `offset` is in these units. Positions at the ends
// of the integers wrap, too: to the other side, still far outside.
VOLCOMP_INLINE std::int64_t distance(const AxisLookup& axis, std::int64_t position,
                                     std::int32_t offset, bool rotary) {
  const auto r = static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(axis.q0);
  const std::int64_t more = offset;
  if (rotary) return (static_cast<std::int64_t>(r) >> 8) + more;
  return static_cast<std::int64_t>(r + static_cast<std::uint64_t>(more));
}

VOLCOMP_INLINE bool outside(const AxisLookup& axis, std::int64_t distance, bool rotary,
                            std::uint32_t travel) {
  if (rotary && axis.periodic) return false;
  if (VOLCOMP_RARELY(static_cast<std::int32_t>(distance >> 32) != 0)) return true;
  return static_cast<std::uint32_t>(distance) > travel;
}

// Holds a distance beyond the table at its end.
inline RangeState hold_inside(const AxisLookup& axis, bool rotary, std::int64_t& distance) {
  if (!outside(axis, distance, rotary, axis.travel)) return RangeState::inside;
  const bool below = distance < 0;
  const std::int64_t excess = below ? -distance : distance - axis.travel;
  distance = below ? 0 : std::int64_t{axis.travel};
  return excess > axis.margin ? RangeState::far_outside : RangeState::outside;
}

// `distance` lies inside the table of these `rows`, [knot][direction].
VOLCOMP_INLINE Located locate(const AxisLookup& axis, std::uint32_t distance, bool rotary,
                              const std::array<Knot, 2>* rows, Direction direction) {
  constexpr std::uint32_t kFraction = (1U << kFractionBits) - 1U;
  constexpr float kPerFraction = 1.0F / static_cast<float>(1U << kFractionBits);
  const auto product = static_cast<std::uint64_t>(distance << axis.shift) * axis.scale;
  const auto place = static_cast<std::uint32_t>(product >> 32U);
  const auto fraction = static_cast<std::int32_t>(place & kFraction);
  const std::uint32_t row = 2U * (place >> kFractionBits) + static_cast<std::uint32_t>(direction);
  return {rows->data() + row, static_cast<float>(fraction) * kPerFraction,
          rotary ? 0.0F : static_cast<float>(distance) + axis.origin_nm,
          rotary ? distance + axis.phase : 0U};
}

using ChannelValues = std::array<float, 6>;

VOLCOMP_INLINE void interpolate(const Located& at, ChannelValues& out) {
  const Knot& k = *at.knot;
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < 6; ++c)
    out[c] = k.v[c] + at.t * k.d[c];
}

// A row that gives the mean of two others at t: v + t·0.
inline void set_mean(Knot& mean, const Knot& a, const Knot& b, float t) {
  for (std::size_t c = 0; c < 6; ++c)
    mean.v[c] = 0.5F * ((a.v[c] + t * a.d[c]) + (b.v[c] + t * b.d[c]));
  mean.d = {};
}

}  // namespace volcomp
