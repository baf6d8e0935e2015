#pragma once
// Sine and cosine of an angle in 2^-40 turn in double, without libm: the same bits on every target.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/geometry/double3.hpp"
#include "comp/units.hpp"

namespace volcomp {

namespace detail {

// Taylor, from the highest.
inline constexpr std::array<double, 7> kSineTerms{
    -1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
    -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0};
inline constexpr std::array<double, 7> kCosineTerms{
    1.0 / 20922789888000.0, -1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0,
    1.0 / 40320.0,          -1.0 / 720.0,         1.0 / 24.0};

inline double horner(const std::array<double, 7>& terms, double z) {
  double sum = terms[0];
  VOLCOMP_UNROLL_16
  for (std::size_t i = 1; i < terms.size(); ++i)
    sum = terms[i] + z * sum;
  return sum;
}

}  // namespace detail

struct FineSineCosine {
  double sine;
  double cosine;
};

// Error ≤ 3e-16 for |units| ≤ 2^41: two turns. Quarter turns are taken off exactly; what is left,
// ±45°, goes into the Taylor series, whose first term left out is below 4e-17.
inline FineSineCosine fine_sine_cosine(double units) {
  constexpr double kQuarter = static_cast<double>(kUnitsPerTurn) / 4.0;
  constexpr double kRadPerUnit = 2.0 * kPi / static_cast<double>(kUnitsPerTurn);
  const double quarters = units / kQuarter;  // exact: a power of two
  const auto quadrant = static_cast<std::int32_t>(quarters + (quarters < 0.0 ? -0.5 : 0.5));
  const double x = (units - static_cast<double>(quadrant) * kQuarter) * kRadPerUnit;
  const double z = x * x;
  const double s = x + x * z * detail::horner(detail::kSineTerms, z);
  const double c = 1.0 - 0.5 * z + z * z * detail::horner(detail::kCosineTerms, z);
  const auto turn = static_cast<std::uint32_t>(quadrant);
  const double a = (turn & 1U) != 0 ? c : s;
  const double b = (turn & 1U) != 0 ? s : c;
  return {(turn & 2U) != 0 ? -a : a, ((turn + 1U) & 2U) != 0 ? -b : b};
}

// An angle in radians, |angle| < 1e9, in 2^-40 turn, at most half a turn either way.
inline double units_within_a_turn(double angle) {
  constexpr double kRadPerTurn = 2.0 * kPi;
  const double turns = angle / kRadPerTurn;
  const auto whole = static_cast<std::int32_t>(turns + (turns < 0.0 ? -0.5 : 0.5));
  return (turns - static_cast<double>(whole)) * static_cast<double>(kUnitsPerTurn);
}

}  // namespace volcomp
