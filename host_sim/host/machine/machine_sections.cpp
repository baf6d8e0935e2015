#include "host_sim/host/machine/machine_sections.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/circles/circle_test.hpp"
#include "comp/metrology/tables/plausibility.hpp"
#include "comp/probe/probe_rule.hpp"
#include "comp/tick/offset_units.hpp"
#include "host_sim/host/machine/probe_class_names.hpp"

namespace volcomp::host {

void read_correction_values(const TomlSection& s, CorrectionFile& c) {
  const auto read = [&s](const char* key, double& value, double lo, double hi) {
    value = s.number_or(key, value);
    if (!(value >= lo && value <= hi))
      s.complain(s.has(key) ? key : "axes", fmt::format("'{}' must be from {} to {}", key, lo, hi));
  };
  // Offsets end at 2^22 units of 1 nm or 2^-32 turn.
  read("limit_mm", c.limit_mm, 1e-6, 4.194);
  read("rate_mm_per_s", c.rate_mm_per_s, 1e-3, 1e6);
  read("hysteresis_mm", c.hysteresis_mm, 0.0, 1.0);
  read("max_speed_mm_per_s", c.max_speed_mm_per_s, 0.0, 1e5);
  read("limit_rad", c.limit_rad, 2e-9, 6.135e-3);
  read("rate_rad_per_s", c.rate_rad_per_s, 2e-6, 1e3);
  read("hysteresis_rad", c.hysteresis_rad, 0.0, 6.135e-3);
  read("max_speed_rad_per_s", c.max_speed_rad_per_s, 0.0, 1e4);
  read("ramp_s", c.ramp_s, 1e-4, 60.0);
  read("tick_hz", c.tick_hz, 1.0, 1e5);
}

const std::vector<std::string>& axis_acceleration_fields() {
  static const std::vector<std::string> fields{
      "max_acceleration_mm_per_s2", "max_acceleration_rad_per_s2", "spare_acceleration_mm_per_s2",
      "spare_acceleration_rad_per_s2"};
  return fields;
}

namespace {

constexpr double kMostAcceleration = 1e6;

// Nothing where the field is missing.
std::optional<double> read_acceleration(const TomlSection& s, const std::string& key,
                                        double least) {
  if (!s.has(key)) return {};
  const double value = s.number(key);
  if (!(value >= least && value <= kMostAcceleration))
    s.complain(key, fmt::format("'{}' must be from {} to {}", key, least, kMostAcceleration));
  return value;
}

}  // namespace

void read_axis_acceleration(const TomlSection& s, AxisFile& axis) {
  constexpr double kLeast = 1e-3;
  const std::string unit = axis.rotary ? "rad_per_s2" : "mm_per_s2";
  for (const std::string& key : axis_acceleration_fields()) {
    const bool of_this_kind = key.find(unit) != std::string::npos;
    if (s.has(key) && !of_this_kind)
      s.complain(key,
                 fmt::format("'{}' is not for a {} axis", key, axis.rotary ? "rotary" : "linear"));
  }
  axis.max_acceleration = read_acceleration(s, "max_acceleration_" + unit, kLeast);
  axis.spare_acceleration = read_acceleration(s, "spare_acceleration_" + unit, kLeast);
}

namespace {

// `wanted`: of [correction].
OffsetAcceleration offset_acceleration(const AxisFile& axis, const std::optional<double>& wanted) {
  const char* const unit = axis.rotary ? "rad_per_s2" : "mm_per_s2";
  OffsetAcceleration a;
  a.stated = wanted || axis.max_acceleration || axis.spare_acceleration;
  if (wanted) {
    a.value = *wanted;
    a.origin = fmt::format("axis {}: 'acceleration_{}'", axis.letter, unit);
  } else if (axis.max_acceleration) {
    a.value = kSpareShare * *axis.max_acceleration;
    a.origin = fmt::format("axis {}: a tenth of 'max_acceleration_{}'", axis.letter, unit);
  } else {
    a.value = axis.rotary ? kSpareAcceleration_rad_per_s2 : kSpareAcceleration_mm_per_s2;
    a.origin = fmt::format("axis {}: 'acceleration_{}' by default", axis.letter, unit);
  }
  const bool any = wanted && !(*wanted > 0.0);
  if (axis.spare_acceleration && !any && *axis.spare_acceleration < a.value) {
    a.value = *axis.spare_acceleration;
    a.origin = fmt::format("axis {}: 'spare_acceleration_{}'", axis.letter, unit);
  }
  return a;
}

}  // namespace

void read_offset_acceleration(const TomlSection& correction, const std::vector<std::size_t>& axes,
                              MachineFile& machine) {
  const auto linear = read_acceleration(correction, "acceleration_mm_per_s2", 0.0);
  const auto rotary = read_acceleration(correction, "acceleration_rad_per_s2", 0.0);
  for (const std::size_t a : axes) {
    const AxisFile& axis = machine.axes.at(a);
    machine.correction.acceleration.at(a) =
        offset_acceleration(axis, axis.rotary ? rotary : linear);
  }
}

SquarenessFile read_squareness(const TomlSection& s) {
  s.allow_only({"a_xy_rad", "a_xz_rad", "a_yz_rad", "at_mm", "circle_radius_mm", "x_mm", "y_mm",
                "z_mm", "points"});
  SquarenessFile q;
  q.points = static_cast<std::size_t>(s.integer_or("points", 7, 2, 101));
  const std::array<std::string, 3> keys{"a_xy_rad", "a_xz_rad", "a_yz_rad"};
  std::array<double, 3> angle{};
  for (std::size_t i = 0; i < 3; ++i) {
    angle[i] = s.number(keys[i]);
    s.check(check_squareness(keys[i].c_str(), {angle[i], 0.0, 0.0}), keys[i]);
  }
  q.measured = {angle[0], angle[1], angle[2]};
  const auto at = s.numbers<3>("at_mm");
  q.at = Vec3(at[0], at[1], at[2]);
  if (s.has("circle_radius_mm")) {
    const double radius = s.number("circle_radius_mm");
    if (!(radius >= kLeastCircle && radius <= kMostCircle))
      s.complain("circle_radius_mm", fmt::format("'circle_radius_mm' must be from {:g} to {:g}",
                                                 kLeastCircle, kMostCircle));
    q.circle_radius = radius;
  }
  const std::array<std::string, 3> lines{"x_mm", "y_mm", "z_mm"};
  if (q.circle_radius && !s.has("x_mm") && !s.has("y_mm") && !s.has("z_mm")) return q;
  for (std::size_t i = 0; i < 3; ++i) {
    q.segment[i] = s.numbers<2>(lines[i]);
    if (!(q.segment[i][0] < q.segment[i][1]))
      s.complain(lines[i], fmt::format("'{}' must be [low, high]", lines[i]));
  }
  return q;
}

ErrorMotion read_error(const TomlSection& s, const std::string& key) {
  // Beyond this it is a wrong unit.
  constexpr double kMost_mm = kMaxConstantError_mm;
  constexpr double kMost_rad = kMaxConstantError_rad;
  const auto values = s.numbers<6>(key);
  ErrorMotion error;
  for (std::size_t c = 0; c < 6; ++c) {
    if (std::abs(values[c]) > (c < 3 ? kMost_mm : kMost_rad))
      s.complain(key,
                 fmt::format("'{}' is in mm and rad, up to {} and {}", key, kMost_mm, kMost_rad));
    error(static_cast<Eigen::Index>(c)) = values[c];
  }
  return error;
}

double read_delay_us(const TomlSection& s, const std::string& key) {
  const double us = s.number_or(key, 0.0);
  constexpr double kMost_us = 1e6 * kMaxProbeDelay_s;
  if (!(us >= 0.0 && us <= kMost_us))
    s.complain(key, fmt::format("'{}' must be from 0 to {}", key, kMost_us));
  return us;
}

ProbeFile read_probe(const TomlSection& s) {
  s.allow_only({"radius_mm", "delay_us", "class", "stylus"});
  ProbeFile probe;
  probe.radius_mm = s.number("radius_mm");
  constexpr double kMost_mm = kMaxBallRadius_nm / kNmPerMm;
  if (!(probe.radius_mm > 0.0 && probe.radius_mm <= kMost_mm))
    s.complain("radius_mm", fmt::format("'radius_mm' must be above 0 and at most {}", kMost_mm));
  probe.delay_us = read_delay_us(s, "delay_us");
  if (s.has("class"))
    probe.probe_class = s.choice("class", {kProbeClassNames.begin(), kProbeClassNames.end()});
  if (s.has("stylus"))
    probe.stylus = Vec3::Unit(static_cast<Eigen::Index>(s.choice("stylus", {"X", "Y", "Z"})));
  return probe;
}

namespace {

double number_within(const TomlSection& s, const std::string& key, double fallback, double lo,
                     double hi) {
  const double value = s.number_or(key, fallback);
  if (!(value >= lo && value <= hi)) {
    static_cast<void>(s.need(key));
    s.complain(key, fmt::format("'{}' must be from {} to {}", key, lo, hi));
  }
  return value;
}

}  // namespace

LaserFile read_laser(const TomlSection& s) {
  s.allow_only({"drift", "drift_um", "drift_tau_s", "dwell_s", "growth_K", "roll"});
  constexpr double kMost_um = 1000.0;
  constexpr double kLeast_s = 0.1;
  constexpr double kMost_s = 1e6;
  LaserFile laser;
  if (s.has("drift")) laser.drift = s.choice("drift", {kDriftNames.begin(), kDriftNames.end()});
  laser.drift_mm =
      number_within(s, "drift_um", kUmPerMm * laser.drift_mm, 0.0, kMost_um) / kUmPerMm;
  laser.drift_tau_s = number_within(s, "drift_tau_s", laser.drift_tau_s, kLeast_s, kMost_s);
  laser.dwell_s = number_within(s, "dwell_s", laser.dwell_s, kLeast_s, kMost_s);
  laser.growth_K = number_within(s, "growth_K", laser.growth_K, 0.0, 100.0);
  laser.roll_by_level = s.has("roll") && s.choice("roll", {"laser", "level"}) == 1;
  return laser;
}

namespace {

void read_gear(const TomlSection& s, GrindingFile& g) {
  constexpr double kMandatory = 0.0;  // outside every range
  s.allow_only({"teeth", "module_mm", "pressure_angle_deg", "helix_angle_deg", "width_mm"});
  g.gear.teeth = static_cast<int>(s.integer("teeth", 5, 1000));
  g.gear.module = s.number("module_mm");
  g.gear.pressure_angle = s.number("pressure_angle_deg") * kPi / 180.0;
  g.gear.helix_angle = s.number("helix_angle_deg") * kPi / 180.0;
  s.check(derive(g.gear), "teeth");
  g.width_mm = number_within(s, "width_mm", kMandatory, 4.0, 1000.0);
}

AxisExpansion read_expansion(const TomlSection& s, const Joint& joint) {
  s.allow_only({"per_K", "fixed_mm", "input"});
  const auto within = [&s](const char* key, double most) {
    const double absent = 2.0 * most;
    return static_cast<float>(number_within(s, key, absent, -most, most));
  };
  AxisExpansion e;
  e.per_K = within("per_K", static_cast<double>(kMaxExpansion_per_K));
  s.check(check_expansion(e, joint), "per_K");
  e.fixed_mm = within("fixed_mm", static_cast<double>(kMaxFixed_mm));
  e.input =
      static_cast<std::uint8_t>(s.integer("input", 0, static_cast<long>(kTemperatureInputs) - 1));
  return e;
}

}  // namespace

// One table per axis that grows: [thermal.X].
ThermalFile read_thermal(const TomlSection& s, const MachineFile& machine) {
  std::vector<std::string> known{"reference_C", "expires_days"};
  for (const AxisFile& axis : machine.axes)
    known.emplace_back(1, axis.letter);
  s.allow_only(known);
  ThermalFile t;
  t.reference_C =
      number_within(s, "reference_C", t.reference_C, static_cast<double>(kLeastTemperature_C),
                    static_cast<double>(kMostTemperature_C));
  t.expires_days = number_within(s, "expires_days", t.expires_days, 0.0, kMostExpiry_days);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string letter(1, machine.axes[a].letter);
    if (s.has(letter)) t.expansion.at(a) = read_expansion(s.table(letter), machine.chain.axis(a));
  }
  return t;
}

// A stroke that has not reached its feed at the gear would be watched while it accelerates.
GrindingFile read_grinding(const TomlSection& top) {
  GrindingFile g;
  read_gear(top.table("gear"), g);
  const TomlSection wheel = top.table("wheel");
  wheel.allow_only({"radius_mm"});
  g.wheel_radius_mm = wheel.number("radius_mm");
  if (!(g.wheel_radius_mm > 0.0 && g.wheel_radius_mm < g.gear.r_tip))
    wheel.complain("radius_mm", fmt::format("'radius_mm' must be above 0 and below the tip radius "
                                            "of the gear, {:.3f}",
                                            g.gear.r_tip));
  const TomlSection stroke = top.table("stroke");
  stroke.allow_only({"feed_mm_per_s", "acceleration_mm_per_s2", "overrun_mm"});
  g.feed_mm_per_s = number_within(stroke, "feed_mm_per_s", 0.0, 0.1, 60.0);
  g.acceleration_mm_per_s2 =
      number_within(stroke, "acceleration_mm_per_s2", g.acceleration_mm_per_s2, 1.0, 1e5);
  g.overrun_mm = number_within(stroke, "overrun_mm", g.overrun_mm, 0.1, 1000.0);
  const double ramp_mm = 0.5 * g.feed_mm_per_s * g.feed_mm_per_s / g.acceleration_mm_per_s2;
  if (g.overrun_mm < 2.0 * ramp_mm)
    stroke.complain(stroke.has("overrun_mm") ? "overrun_mm" : "feed_mm_per_s",
                    fmt::format("'overrun_mm' must be at least {:.3g}, twice the way that the "
                                "feed takes to build up",
                                2.0 * ramp_mm));
  return g;
}

}  // namespace volcomp::host
