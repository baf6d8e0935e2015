#pragma once
// Sine and cosine of an angle in 2^-40 turn, square root and arc tangent in double, without libm:
// the same bits on every target.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "comp/core/bytes.hpp"
#include "comp/core/units.hpp"
#include "comp/machine/double3.hpp"

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

// Sine and cosine of an angle in radians, |angle| < 1e9.
inline FineSineCosine fine_sine_cosine_rad(double angle) {
  return fine_sine_cosine(units_within_a_turn(angle));
}

namespace detail {

// √x for x in 1e-30…1e30. The root of the float is right to 2^-24; its square is exact in double,
// and so is what is missing from x. With d = x/s² − 1, the series of √(1 + d) needs two terms: the
// third is below 2^-70.
inline double root_of_mid_range(double x) {
  const auto s = static_cast<double>(std::sqrt(static_cast<float>(x)));
  const double square = s * s;
  const double d = (x - square) / square;
  return s + s * d * (0.5 - 0.125 * d);
}

inline double power_of_two(int exponent) {  // −1022…1023
  return bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

// √x for any finite x > 0: half the exponent, and the root of what is left, 1…4.
inline double root_of_any(double x) {
  constexpr double kTiny = 0x1p-1000;
  const bool tiny = x < kTiny;  // subnormal, perhaps
  const double normal = tiny ? x * 0x1p108 : x;
  const int exponent = static_cast<int>(bit_cast<std::uint64_t>(normal) >> 52U) - 1023;
  const int half = (exponent + 1024) / 2 - 512;
  const double root = root_of_mid_range(normal * power_of_two(-2 * half)) * power_of_two(half);
  return tiny ? root * 0x1p-54 : root;
}

inline constexpr std::array<double, 12> kArcTerms{-1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,
                                                  -1.0 / 11.0, 1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0,
                                                  -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0, 1.0 / 25.0};

VOLCOMP_SHARED inline double four_terms(const double* k, double z, double zz) {
  return (k[0] + z * k[1]) + zz * (k[2] + z * k[3]);
}

// arctan t = t − t³/3 + t⁵/5 …, |t| ≤ 0.204: the first term left out is below 2e-17 of the first.
// Pairs are summed side by side.
inline double arc_of_small(double t) {
  const double z = t * t;
  const double zz = z * z;
  const double z4 = zz * zz;
  const double a = four_terms(kArcTerms.data(), z, zz);
  const double b = four_terms(kArcTerms.data() + 4, z, zz);
  const double c = four_terms(kArcTerms.data() + 8, z, zz);
  return t * z * (a + z4 * (b + z4 * c));  // without the leading t
}

// What an angle is turned back by.
struct ArcTurn {
  double tangent;
  double angle;       // rounded,
  double rest;        // and what is lost by that
  double complement;  // π/2 − angle, likewise
  double complement_rest;
};
inline constexpr ArcTurn kArcNone{0.0, 0.0, 0.0, 0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
inline constexpr ArcTurn kArcMiddle{0.40625, 0x1.8b24d394a1b25p-2, 0x1.b6d0ba3748fa8p-56,
                                    0x1.2f56805f1a64fp+0, -0x1.4d472d7231f8dp-56};
inline constexpr ArcTurn kArcEighth{1.0, 0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55,
                                    0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};

}  // namespace detail

// √x of x in 1e-30…1e30, as fine_root() has it, which a processor without double need not carry.
inline double mid_range_root(double x) { return detail::root_of_mid_range(x); }

// √x, at most one unit in the last place off; 0 of 0, infinity of infinity, NaN of anything else
// that is not positive. Interrupt-safe.
inline double fine_root(double x) {
  if (x > 1e-30 && x < 1e30) return detail::root_of_mid_range(x);
  if (x > 0.0) return x <= std::numeric_limits<double>::max() ? detail::root_of_any(x) : x;
  return x < 0.0 ? std::numeric_limits<double>::quiet_NaN() : x;
}

// The angle of (x, y) from +x, −π…π, relative error ≤ 4e-16; 0 of (0, 0). Coordinates up to 1e300,
// and not both below 1e-290. The smaller over the larger coordinate is turned back by 0, atan 13/32
// or 45°, whichever is nearest; what is left goes into the series. Interrupt-safe.
inline double fine_arc_tangent(double y, double x) {
  const double ax = x < 0.0 ? -x : x;
  const double ay = y < 0.0 ? -y : y;
  const bool steep = ay > ax;
  const double low = steep ? ax : ay;
  const double high = steep ? ay : ax;
  if (!(high > 0.0)) return x + y;  // 0, or NaN
  const detail::ArcTurn& turn = low < 0.195 * high   ? detail::kArcNone
                                : low < 0.664 * high ? detail::kArcMiddle
                                                     : detail::kArcEighth;
  const double t = (low - turn.tangent * high) / (high + turn.tangent * low);
  const double rest = detail::arc_of_small(t);
  const double angle = steep ? turn.complement - (t + (rest - turn.complement_rest))
                             : turn.angle + (t + (rest + turn.rest));
  const double half = x < 0.0 ? kPi - (angle - 0x1.1a62633145c07p-53) : angle;
  return y < 0.0 ? -half : half;
}

}  // namespace volcomp
