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
  double acceleration;  // per s²; 0: any
};

// Names the field that is too small.
std::int32_t acceleration_in_ticks(double acceleration, bool rotary, double period_s) {
  std::int32_t units = 0;
  require(acceleration_in_units(rotary, acceleration, period_s, units),
          fmt::format("'acceleration_{}' = {:g} every {:g} us", rotary ? "rad_per_s2" : "mm_per_s2",
                      acceleration, 1e6 * period_s));
  return units;
}

// Offsets of a rotary axis count in 2^-32 turn, its positions in 2^-40 turn.
AxisLimits in_units(const AxisCorrection& c, bool rotary, double period_s, double ramp_s) {
  const double position_units = rotary ? kUnitsPerRad : kNmPerMm;
  const auto offset = [rotary](double value) {
    return static_cast<std::int32_t>(
        std::min<std::int64_t>(to_units(value, offset_units(rotary)), INT32_MAX));
  };
  AxisLimits l;
  l.limit = offset(c.limit);
  l.rate = std::max(1, whole_units(c.rate_per_s * offset_units(rotary) * period_s));
  l.soft_rate = std::max(1, std::min(l.rate, offset(c.limit * period_s / ramp_s)));
  l.acceleration = acceleration_in_ticks(c.acceleration, rotary, period_s);
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
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    const OffsetAcceleration& of_offset = c.acceleration.at(a);
    const double acceleration = of_offset.stated ? of_offset.value : 0.0;
    const AxisCorrection values =
        kinds.rotary[a] ? AxisCorrection{c.limit_rad, c.rate_rad_per_s, c.hysteresis_rad,
                                         c.max_speed_rad_per_s, acceleration}
                        : AxisCorrection{c.limit_mm, c.rate_mm_per_s, c.hysteresis_mm,
                                         c.max_speed_mm_per_s, acceleration};
    s.axis[a] = in_units(values, kinds.rotary[a], period, c.ramp_s);
  }
  s.ramp_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(c.ramp_s * c.tick_hz)));
  return s;
}

}  // namespace volcomp::host
