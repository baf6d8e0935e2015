#pragma once
// Rate and acceleration of an offset: from seconds, as a person states them, to ticks.

#include <cstdint>

#include "comp/core/status.hpp"
#include "comp/core/units.hpp"

namespace volcomp {

// Acceleration that every drive is taken to have to spare where nothing is known, and the share of
// the acceleration of its axis where that is.
inline constexpr double kSpareAcceleration_mm_per_s2 = 200.0;
inline constexpr double kSpareAcceleration_rad_per_s2 = 2.0;
inline constexpr double kSpareShare = 0.1;

// Fewer units per tick and tick are coarse: rounding down makes them up to half tighter than
// stated, and the rounding of targets, ±1 unit of acceleration, takes part.
inline constexpr std::int32_t kFineAcceleration = 4;

// Units of an offset (nm, 2^-32 turn) per mm or rad.
constexpr double offset_units(bool rotary) { return rotary ? kUnitsPerRad / 256.0 : kNmPerMm; }

// Rounded down, for 0 ≤ value; saturates at INT32_MAX. A number that only the rounding of a double
// keeps from being whole is whole: 200 mm/s² are 200 nm per ms and ms.
constexpr std::int32_t whole_units(double value) {
  constexpr double kRounding = 1e-12;
  const double most = value * (1.0 + kRounding);
  return most < static_cast<double>(INT32_MAX) ? static_cast<std::int32_t>(most) : INT32_MAX;
}

// mm/s² or rad/s², 0…1e9, and the period of the tick, 1e-6…1 s, to units per tick and tick. 0:
// none. Refuses bad_setting, and acceleration_too_small where less than one unit is left, because 0
// would mean none.
inline Status acceleration_in_units(bool rotary, double acceleration, double period_s,
                                    std::int32_t& units) {
  Where where;
  where.field = "acceleration";
  if (!(acceleration >= 0.0 && acceleration <= 1e9)) return refuse(Reason::bad_setting, where);
  where.field = "period";
  if (!(period_s >= 1e-6 && period_s <= 1.0)) return refuse(Reason::bad_setting, where);
  where.field = "acceleration";
  const double exact = acceleration * offset_units(rotary) * period_s * period_s;
  const std::int32_t down = whole_units(exact);
  if (down == 0 && acceleration > 0.0) return refuse(Reason::acceleration_too_small, where);
  units = down;
  return {};
}

}  // namespace volcomp
