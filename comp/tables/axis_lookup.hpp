#pragma once
// From an integer position to the six interpolated channels of one axis: one 32×32→64-bit multiply
// gives the knot index (upper 10 bits) and the fraction (lower 22 bits).

#include <array>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/units.hpp"
#include "comp/machine/fixed_trig.hpp"
#include "comp/tables/direction.hpp"
#include "comp/tables/knot.hpp"

namespace volcomp {

inline constexpr unsigned kFractionBits = 22;
// Half of what the index could count: the scale of a longer table would not fit 32 bits.
inline constexpr std::uint32_t kMaxLookupKnots = 1U << (31 - kFractionBits);

struct AxisLookup {
  std::int64_t q0 = 0;
  std::uint32_t fast_path_travel =
      0;                    // travel, or 0 for a table that is too long for the fast path
  std::uint32_t scale = 0;  // 2^(32 + fraction) / (pitch << shift)
  std::uint32_t shift = 0;
  std::uint32_t counted = ~0U;  // upper half of a distance that must be 0: none of it if periodic
  float origin_nm = 0.0F;       // q0 of a linear axis
  std::uint32_t phase = 0;      // q0 of a rotary axis, 2^-32 turn
  std::uint32_t travel = 0;     // last − first knot, nm or 2^-32 turn
  std::uint32_t margin = 0;     // half a pitch: further out is an alarm
};

// The fast path compares the low 32 bits of a linear position with the last one. Within a table
// they determine how far the axis has moved as long as table, step and the largest offset on both
// ends do not fill 2^32 nm together.
inline constexpr std::uint32_t kMaxFastPathStep = 1U << 28U;  // 0.27 m per tick
inline constexpr std::uint32_t kMaxFastPathTravel = UINT32_MAX - kMaxFastPathStep - (1U << 23U);

// Where an axis stands in its table, at whose ends it is held.
struct Located {
  const Knot* knot;
  float t;  // 0…1 within the row
  union {
    float travel_nm;  // of a linear axis
    SineCosine turn;  // of a rotary axis
  };
};

enum class RangeState : std::uint8_t { inside, outside, far_outside };

// Distance from the first knot in the units of the lookup: nm, or 2^-32 turn, to which 2^-40 turn
// is reduced so that it wraps like the axis does; `offset` is in these units. Positions at the ends
// of the integers wrap, too: to the other side, still far outside.
VOLCOMP_INLINE std::int64_t distance(const AxisLookup& axis, std::int64_t position,
                                     std::int32_t offset, bool rotary) {
  const auto r = static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(axis.q0);
  const std::int64_t more = offset;
  if (rotary) return static_cast<std::int64_t>(r + static_cast<std::uint64_t>(more * 256)) >> 8;
  return static_cast<std::int64_t>(r + static_cast<std::uint64_t>(more));
}

VOLCOMP_INLINE bool outside(const AxisLookup& axis, std::int64_t distance, bool rotary,
                            std::uint32_t travel) {
  const auto upper = static_cast<std::uint32_t>(distance >> 32);
  if (VOLCOMP_UNLIKELY((rotary ? upper & axis.counted : upper) != 0)) return true;
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
VOLCOMP_INLINE void locate(const AxisLookup& axis, std::uint32_t distance, bool rotary,
                           const std::array<Knot, 2>* rows, Direction direction, Located& at) {
  constexpr std::uint32_t kFraction = (1U << kFractionBits) - 1U;
  constexpr float kPerFraction = 1.0F / static_cast<float>(1U << kFractionBits);
  const auto product = static_cast<std::uint64_t>(distance << axis.shift) * axis.scale;
  const auto place = static_cast<std::uint32_t>(product >> 32U);
  const auto fraction = static_cast<std::int32_t>(place & kFraction);
  const std::uint32_t row = 2U * (place >> kFractionBits) + static_cast<std::uint32_t>(direction);
  at.knot = rows->data() + row;
  at.t = static_cast<float>(fraction) * kPerFraction;
  if (rotary) {
    at.turn = sine_cosine(distance + axis.phase);
  } else {
    at.travel_nm = static_cast<float>(distance) + axis.origin_nm;
  }
}

// As locate(); while the direction is unknown `mean` becomes the row between both.
inline void locate_any(const AxisLookup& axis, std::uint32_t distance, bool rotary,
                       const std::array<Knot, 2>* rows, Direction direction, Knot& mean,
                       Located& at) {
  const bool known = direction != Direction::unknown;
  locate(axis, distance, rotary, rows, known ? direction : Direction::forward, at);
  if (known) return;
  set_mean(mean, at.knot[0], at.knot[1], at.t);  // both directions lie side by side
  at.knot = &mean;
}

}  // namespace volcomp
