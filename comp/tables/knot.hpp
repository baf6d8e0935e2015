#pragma once
// What an axis table holds at a knot, and how the tick takes it from there.

#include <array>
#include <cstddef>

#include "comp/core/inline.hpp"

namespace volcomp {

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

// At t, 0…1, from one knot to the next.
VOLCOMP_INLINE void interpolate(const Knot& knot, float t, ChannelValues& out) {
  const Knot k = fetch(knot);
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < 6; ++c)
    out[c] = k.v[c] + t * k.d[c];
}

// A row that gives the mean of two others at t: v + t·0.
inline void set_mean(Knot& mean, const Knot& a, const Knot& b, float t) {
  for (std::size_t c = 0; c < 6; ++c)
    mean.v[c] = 0.5F * ((a.v[c] + t * a.d[c]) + (b.v[c] + t * b.d[c]));
  mean.d = {};
}

}  // namespace volcomp
