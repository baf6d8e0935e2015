#pragma once
// From an integer position to the six interpolated channels of one axis: one 32×32→64-bit multiply
// gives the knot index (upper 10 bits) and the fraction (lower 22 bits).

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/units.hpp"
#include "comp/machine/fixed_trig.hpp"
#include "comp/tables/direction.hpp"

namespace volcomp {

// What an axis table holds at a knot, and how the tick takes it from there.
using ChannelValues = std::array<float, 6>;

// Values at a knot and their differences to the next one: one row, one load, v + t·d.
struct Knot {
  ChannelValues v;
  ChannelValues d;
};

// The whole row in registers. A Cortex-M loads it by one instruction, for which the compiler takes
// twelve of its own accord.
VOLCOMP_INLINE Knot fetch(const Knot& knot) {
#if defined(__arm__) && defined(__ARM_FP) && defined(__GNUC__) && !defined(__clang__)
  register float v0 __asm("s0");
  register float v1 __asm("s1");
  register float v2 __asm("s2");
  register float v3 __asm("s3");
  register float v4 __asm("s4");
  register float v5 __asm("s5");
  register float d0 __asm("s6");
  register float d1 __asm("s7");
  register float d2 __asm("s8");
  register float d3 __asm("s9");
  register float d4 __asm("s10");
  register float d5 __asm("s11");
  __asm("vldmia %[knot], {s0-s11}"
        : "=t"(v0), "=t"(v1), "=t"(v2), "=t"(v3), "=t"(v4), "=t"(v5), "=t"(d0), "=t"(d1), "=t"(d2),
          "=t"(d3), "=t"(d4), "=t"(d5)
        : [knot] "r"(&knot), "m"(knot));
  return {{v0, v1, v2, v3, v4, v5}, {d0, d1, d2, d3, d4, d5}};
#else
  return knot;
#endif
}

// Six registers into memory by one instruction, for which the compiler takes six.
VOLCOMP_INLINE void store(const ChannelValues& values, ChannelValues& to) {
#if defined(__arm__) && defined(__ARM_FP) && defined(__GNUC__) && !defined(__clang__)
  register float v0 __asm("s0") = values[0];
  register float v1 __asm("s1") = values[1];
  register float v2 __asm("s2") = values[2];
  register float v3 __asm("s3") = values[3];
  register float v4 __asm("s4") = values[4];
  register float v5 __asm("s5") = values[5];
  __asm("vstmia %[to], {s0-s5}"
        : "=m"(to)
        : [to] "r"(&to), "t"(v0), "t"(v1), "t"(v2), "t"(v3), "t"(v4), "t"(v5));
#else
  to = values;
#endif
}

// At t, 0…1, from one knot to the next.
VOLCOMP_INLINE void interpolate(const Knot& knot, float t, ChannelValues& out) {
  const Knot k = fetch(knot);
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < 6; ++c)
    out[c] = k.v[c] + t * k.d[c];
}

// Makes `mean` a row that gives the mean of two others at t: v + t·0. Its differences are 0 and
// stay so.
VOLCOMP_INLINE void set_mean(Knot& mean, const Knot& a, const Knot& b, float t) {
  ChannelValues first;
  ChannelValues second;
  interpolate(a, t, first);
  interpolate(b, t, second);
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < 6; ++c)
    first[c] = 0.5F * (first[c] + second[c]);
  store(first, mean.v);
}

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

// Holds a distance beyond the table at its end. Returns whether it was beyond the margin, too.
VOLCOMP_INLINE bool hold_inside(const AxisLookup& axis, std::int64_t& distance) {
  const bool below = distance < 0;
  const std::int64_t excess = below ? -distance : distance - axis.travel;
  distance = below ? 0 : std::int64_t{axis.travel};
  return excess > axis.margin;
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
VOLCOMP_INLINE void locate_any(const AxisLookup& axis, std::uint32_t distance, bool rotary,
                               const std::array<Knot, 2>* rows, Direction direction, Knot& mean,
                               Located& at) {
  const bool known = direction != Direction::unknown;
  locate(axis, distance, rotary, rows, known ? direction : Direction::forward, at);
  if (known) return;
  set_mean(mean, at.knot[0], at.knot[1], at.t);  // both directions lie side by side
  at.knot = &mean;
}

}  // namespace volcomp
