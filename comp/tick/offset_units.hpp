#pragma once
// Rates, accelerations and times: from seconds, as a person states them, to ticks.

#include <cstdint>

#include "comp/core/status.hpp"
#include "comp/core/units.hpp"
#include "comp/tick/offset_bounds.hpp"

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

namespace detail {

inline Status refuse_setting(Reason reason, const char* field) {
  Where where;
  where.field = field;
  return refuse(reason, where);
}

// Of the tick, s.
constexpr bool is_period(double period_s) { return period_s >= 1e-6 && period_s <= 1.0; }

}  // namespace detail

// The four below compute in double and take no memory: they belong to the background. Where they
// refuse, the result is as before.

// mm/s², 0…1e9, or rad/s², 0…1e6, and the period of the tick, 1e-6…1 s, to units per tick and tick,
// rounded down. 0: none. Refuses bad_setting, and acceleration_too_small where less than one unit
// is left, because 0 would mean none.
inline Status acceleration_in_units(bool rotary, double acceleration, double period_s,
                                    std::int32_t& units) {
  const auto refused = [](Reason reason) { return detail::refuse_setting(reason, "acceleration"); };
  if (!(acceleration >= 0.0 && acceleration <= (rotary ? 1e6 : 1e9)))
    return refused(Reason::bad_setting);
  if (!detail::is_period(period_s)) return detail::refuse_setting(Reason::bad_setting, "period");
  const std::int32_t down = whole_units(acceleration * offset_units(rotary) * period_s * period_s);
  if (down == 0 && acceleration > 0.0) return refused(Reason::acceleration_too_small);
  units = down;
  return {};
}

// mm/s or rad/s, above 0, and the period of the tick, 1e-6…1 s, to units per tick, rounded down.
// Refuses bad_setting with `field`, the name of the rate, where the result is not one that a
// compensator takes, 1…kMostOffsetRate.
inline Status rate_in_units(const char* field, bool rotary, double rate, double period_s,
                            std::int32_t& units) {
  if (!(rate > 0.0 && rate <= 1e9)) return detail::refuse_setting(Reason::bad_setting, field);
  if (!detail::is_period(period_s)) return detail::refuse_setting(Reason::bad_setting, "period");
  const std::int32_t down = whole_units(rate * offset_units(rotary) * period_s);
  if (down < 1 || down > kMostOffsetRate) return detail::refuse_setting(Reason::bad_setting, field);
  units = down;
  return {};
}

// Speed of an axis that is plausible, mm/s or rad/s, 0…1e9, and the period of the tick, 1e-6…1 s,
// to units of its position (nm, 2^-40 turn) per tick, to the nearest, at most kMaxPosition. 0: any.
// Refuses bad_setting, also where half a unit is not reached, because 0 would mean any.
inline Status step_in_units(bool rotary, double speed, double period_s, std::int64_t& units) {
  const auto refused = [] { return detail::refuse_setting(Reason::bad_setting, "max_speed"); };
  if (!(speed >= 0.0 && speed <= 1e9)) return refused();
  if (!detail::is_period(period_s)) return detail::refuse_setting(Reason::bad_setting, "period");
  const std::int64_t step = to_units(speed * period_s, rotary ? kUnitsPerRad : kNmPerMm);
  if (step == 0 && speed > 0.0) return refused();
  units = step;
  return {};
}

// s, 0 or more, and the period of the tick, 1e-6…1 s, to the nearest number of ticks, 0…most ≤
// 2^31. Refuses bad_setting with `field`, the name of the time, where it is none or too long.
inline Status ticks_in(const char* field, double seconds, double period_s, std::uint32_t most,
                       std::uint32_t& ticks) {
  if (!detail::is_period(period_s)) return detail::refuse_setting(Reason::bad_setting, "period");
  const double nearest = seconds / period_s + 0.5;
  if (!(seconds >= 0.0 && nearest < static_cast<double>(most) + 1.0))
    return detail::refuse_setting(Reason::bad_setting, field);
  ticks = static_cast<std::uint32_t>(nearest);
  return {};
}

}  // namespace volcomp
