#include "host_sim/host/machine/compensator_settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/tick/offset_units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// The correction of one axis in a machine file: mm or rad.
struct AxisCorrection {
  double limit;
  double rate_per_s;
  double hysteresis;
  double max_speed_per_s;
};

std::string in_a_period(const std::string& setting, double value, double period_s) {
  return fmt::format("{} = {:g} every {:g} us", setting, value, 1e6 * period_s);
}

std::int32_t rate_in_ticks(double rate, bool rotary, double period_s) {
  const std::int32_t units = whole_units(rate * offset_units(rotary) * period_s);
  if (units >= 1 && units <= kMostOffsetRate) return units;
  throw UserError(fmt::format(
      "{}: {} of {} per period [{}]",
      in_a_period(rotary ? "'rate_rad_per_s'" : "'rate_mm_per_s'", rate, period_s),
      units < 1 ? "less than one unit" : fmt::format("more than {} units", kMostOffsetRate),
      rotary ? "2^-32 turn" : "1 nm", code(Reason::bad_setting)));
}

// 0: any, and what is more than the rate allows anyway.
std::int32_t acceleration_in_ticks(const OffsetAcceleration& a, bool rotary, double period_s,
                                   std::int32_t rate) {
  if (!a.stated) return 0;
  std::int32_t units = 0;
  const std::string what = in_a_period(a.origin, a.value, period_s);
  require(acceleration_in_units(rotary, a.value, period_s, units), what);
  OffsetLimits limits;
  limits.rate = rate;
  limits.acceleration = units;
  if (limits.accelerates_freely()) return 0;
  if (units <= kMostOffsetAcceleration) return units;
  throw UserError(fmt::format("{}: more than {} units of {} per period and period [{}]", what,
                              kMostOffsetAcceleration, rotary ? "2^-32 turn" : "1 nm",
                              code(Reason::bad_setting)));
}

// Offsets of a rotary axis count in 2^-32 turn, its positions in 2^-40 turn.
AxisLimits in_units(const AxisCorrection& c, const OffsetAcceleration& acceleration, bool rotary,
                    double period_s, double ramp_s) {
  const double position_units = rotary ? kUnitsPerRad : kNmPerMm;
  const auto offset = [rotary](double value) {
    return static_cast<std::int32_t>(
        std::min<std::int64_t>(to_units(value, offset_units(rotary)), INT32_MAX));
  };
  AxisLimits l;
  l.limit = offset(c.limit);
  l.rate = rate_in_ticks(c.rate_per_s, rotary, period_s);
  l.soft_rate = std::max(1, std::min(l.rate, offset(c.limit * period_s / ramp_s)));
  l.acceleration = acceleration_in_ticks(acceleration, rotary, period_s, l.rate);
  l.hysteresis = offset(c.hysteresis);
  // A jump beyond v_max·Δt·2 is implausible.
  l.max_step = to_units(2.0 * c.max_speed_per_s * period_s, position_units);
  return l;
}

}  // namespace

OrientingCompensator::Settings compensator_settings(const CorrectionFile& c,
                                                    const AxisKinds& kinds) {
  OrientingCompensator::Settings s;
  const double period = 1.0 / c.tick_hz;
  for (std::size_t a = 0; a < kinds.count; ++a) {
    const AxisCorrection values =
        kinds.rotary.at(a)
            ? AxisCorrection{c.limit_rad, c.rate_rad_per_s, c.hysteresis_rad, c.max_speed_rad_per_s}
            : AxisCorrection{c.limit_mm, c.rate_mm_per_s, c.hysteresis_mm, c.max_speed_mm_per_s};
    s.axis.at(a) = in_units(values, c.acceleration.at(a), kinds.rotary.at(a), period, c.ramp_s);
  }
  s.ramp_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(c.ramp_s * c.tick_hz)));
  return s;
}

}  // namespace volcomp::host
