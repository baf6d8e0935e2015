#pragma once
// Units of the module. Commissioning: double, mm and rad. Run time: int64 positions in nm (linear)
// or 2^-40 turn (rotary), float corrections in nm or rad.

#include <cstdint>

namespace volcomp {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kNmPerMm = 1e6;
inline constexpr double kUmPerMm = 1e3;
inline constexpr std::int64_t kUnitsPerTurn = std::int64_t{1} << 40;
inline constexpr double kUnitsPerRad = static_cast<double>(kUnitsPerTurn) / (2.0 * kPi);

// Linear positions and the knots of every table beyond this are clamped before any arithmetic:
// 10 km.
inline constexpr std::int64_t kMaxPosition = 10'000'000'000'000;

constexpr std::int64_t clamp_position(std::int64_t q) {
  if (q > kMaxPosition) return kMaxPosition;
  if (q < -kMaxPosition) return -kMaxPosition;
  return q;
}

// Nearest run-time unit of a commissioning value (`units` per mm or rad), half away from zero,
// saturating at ±kMaxPosition. The argument must be finite.
constexpr std::int64_t to_units(double value, double units) {
  const double scaled = value * units;
  const auto limit = static_cast<double>(kMaxPosition);
  if (scaled >= limit) return kMaxPosition;
  if (scaled <= -limit) return -kMaxPosition;
  return static_cast<std::int64_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
}

constexpr std::int64_t to_nm(double mm) { return to_units(mm, kNmPerMm); }

}  // namespace volcomp
