#pragma once
// Sine and cosine of a 32-bit angle (2^-32 turn) without libm, the same bits on every target.

#include <cstdint>

#include "comp/realtime/inline.hpp"

namespace volcomp {

struct SineCosine {
  float sine;
  float cosine;
};

// Absolute error ≤ 2e-7. Quadrant by rounding to the nearest quarter turn, then minimax polynomials
// (degree 7 and 8) on ±45°. Wraps exactly. Interrupt-safe.
VOLCOMP_INLINE SineCosine sine_cosine(std::uint32_t angle) {
  constexpr std::uint32_t kEighth = 0x20000000U;
  constexpr float kRadPerUnit = 1.4629180792671596e-9F;  // 2π / 2^32
  const std::uint32_t quadrant = (angle + kEighth) >> 30U;
  const auto rest = static_cast<std::int32_t>(angle - (quadrant << 30U));
  const float x = static_cast<float>(rest) * kRadPerUnit;
  const float z = x * x;
  const float s = x + x * z * (-1.6666654611e-1F + z * (8.3321608736e-3F + z * -1.9515295891e-4F));
  const float c =
      1.0F - 0.5F * z +
      z * z * (4.166664568298827e-2F + z * (-1.388731625493765e-3F + z * 2.443315711809948e-5F));
  const bool swap = (quadrant & 1U) != 0;
  const float a = swap ? c : s;
  const float b = swap ? s : c;
  return {(quadrant & 2U) != 0 ? -a : a, ((quadrant + 1U) & 2U) != 0 ? -b : b};
}

}  // namespace volcomp
