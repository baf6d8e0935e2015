// Settings of volcomp.h: their defaults, and from seconds to ticks.

#include "comp/tick/offset_units.hpp"
#include "firmware/embed/c/compensator.hpp"

namespace {

using volcomp::AxisLimits;
using volcomp::Reason;
using volcomp::Status;
using volcomp::c_interface::from;
using volcomp::c_interface::refused;

using Settings = volcomp::OrientingCompensator::Settings;

constexpr std::uint32_t kMostRampTicks = 1U << 24;

static_assert(VOLCOMP_ACCELERATION_TOO_SMALL == static_cast<int>(Reason::acceleration_too_small));

}  // namespace

void volcomp_default_settings(volcomp_settings* out) {
  const Settings s;
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    const AxisLimits& l = s.axis[a];
    out->axis[a] = {l.limit, l.rate, l.soft_rate, l.hysteresis, l.max_step, l.acceleration};
  }
  out->positions = VOLCOMP_TARGET;
  out->machine_id = s.machine_id;
  out->ramp_ticks = s.ramp_ticks;
  out->stale_drop_ticks = s.stale_drop_ticks;
}

volcomp_status volcomp_set_acceleration(volcomp_axis_limits* limits, bool rotary,
                                        double acceleration, double period_s) {
  if (limits == nullptr) return refused(VOLCOMP_NULL_POINTER, "limits");
  const double stated = rotary ? acceleration : 1e3 * acceleration;
  std::int32_t units = 0;
  const Status status = volcomp::acceleration_in_units(rotary, stated, period_s, units);
  if (status.ok()) limits->acceleration = units;
  return from(status);
}

volcomp_status volcomp_set_rate(volcomp_axis_limits* limits, bool rotary, double rate,
                                double soft_rate, double period_s) {
  if (limits == nullptr) return refused(VOLCOMP_NULL_POINTER, "limits");
  std::int32_t units = 0;
  std::int32_t soft_units = 0;
  Status status = volcomp::rate_in_units("rate", rotary, rate, period_s, units);
  if (status.ok())
    status = volcomp::rate_in_units("soft_rate", rotary, soft_rate, period_s, soft_units);
  if (!status.ok()) return from(status);
  if (soft_units > units) return refused(VOLCOMP_BAD_SETTING, "soft_rate");
  limits->rate = units;
  limits->soft_rate = soft_units;
  return from(status);
}

std::int32_t volcomp_effective_rate(const volcomp_axis_limits* limits) {
  if (limits == nullptr) return 0;
  const volcomp::OffsetLimits stated{limits->limit, limits->rate, limits->soft_rate,
                                     limits->acceleration};
  return refused_field(stated) == nullptr ? volcomp::OffsetBounds(stated).rate : 0;
}

volcomp_status volcomp_set_max_speed(volcomp_axis_limits* limits, bool rotary, double max_speed,
                                     double period_s) {
  if (limits == nullptr) return refused(VOLCOMP_NULL_POINTER, "limits");
  std::int64_t units = 0;
  const Status status = volcomp::step_in_units(rotary, 2.0 * max_speed, period_s, units);
  if (status.ok()) limits->max_step = units;
  return from(status);
}

volcomp_status volcomp_set_times(volcomp_settings* settings, double ramp_s, double stale_drop_s,
                                 double period_s) {
  if (settings == nullptr) return refused(VOLCOMP_NULL_POINTER, "settings");
  std::uint32_t ramp = 0;
  std::uint32_t stale = 0;
  Status status = volcomp::ticks_in("ramp", ramp_s, period_s, kMostRampTicks, ramp);
  if (status.ok())
    status = volcomp::ticks_in("stale_drop", stale_drop_s, period_s, UINT16_MAX, stale);
  if (!status.ok()) return from(status);
  settings->ramp_ticks = ramp == 0 ? 1 : ramp;
  settings->stale_drop_ticks = static_cast<std::uint16_t>(stale);
  return from(status);
}
