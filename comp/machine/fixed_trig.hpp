#pragma once
// Sine and cosine of a 32-bit angle (2^-32 turn) without libm, the same bits on every target.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/units.hpp"

namespace volcomp {

struct SineCosine {
  float sine;
  float cosine;
};

namespace detail {

inline constexpr unsigned kCircleBits = 7;
using Circle = std::array<SineCosine, 1U << kCircleBits>;

// Sine on 0…π/2 by its series: the first term left out is < 2e-16.
constexpr double sine_by_series(double x) {
  double sum = x;
  double term = x;
  for (int k = 2; k < 22; k += 2) {
    term *= -x * x / static_cast<double>(k * (k + 1));
    sum += term;
  }
  return sum;
}

// The points of the circle, each quadrant from the same numbers: its symmetries hold bit for bit.
constexpr Circle make_circle() {
  constexpr double kQuarter = kPi / 2.0;
  constexpr std::size_t n = 1U << (kCircleBits - 2U);
  Circle circle{};
  for (std::size_t k = 0; k < n; ++k) {
    const auto part = static_cast<double>(k) / static_cast<double>(n);
    const auto s = static_cast<float>(sine_by_series(kQuarter * part));
    const auto c = k == 0 ? 1.0F : static_cast<float>(sine_by_series(kQuarter * (1.0 - part)));
    circle[k] = {s, c};
    circle[k + n] = {c, -s};
    circle[k + 2 * n] = {-s, -c};
    circle[k + 3 * n] = {-c, s};
  }
  return circle;
}

inline constexpr Circle kCircle = make_circle();

}  // namespace detail

// Absolute error ≤ 2e-7. From the nearest point of the circle by what is left, at most 1/256 turn:
// two terms of either series. Wraps exactly. Interrupt-safe.
VOLCOMP_INLINE SineCosine sine_cosine(std::uint32_t angle) {
  constexpr unsigned kRestBits = 32U - detail::kCircleBits;
  constexpr float kRadPerUnit = 1.4629180792671596e-9F;  // 2π / 2^32
  const std::uint32_t nearest = (angle + (1U << (kRestBits - 1U))) >> kRestBits;
  const auto rest = static_cast<std::int32_t>(angle - (nearest << kRestBits));
  const SineCosine& at = detail::kCircle[nearest];
  const float x = static_cast<float>(rest) * kRadPerUnit;
  const float z = x * x;
  const float s = x - x * z * (1.0F / 6.0F);
  const float c = 1.0F - 0.5F * z;
  return {at.sine * c + at.cosine * s, at.cosine * c - at.sine * s};
}

}  // namespace volcomp
