#include "host_sim/machine/machine_sections.hpp"

#include <fmt/format.h>

#include "comp/tables/plausibility.hpp"

namespace volcomp::sim {

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

SquarenessFile read_squareness(const TomlSection& s) {
  s.allow_only({"a_xy_rad", "a_xz_rad", "a_yz_rad", "at_mm", "x_mm", "y_mm", "z_mm", "points"});
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
  const std::array<std::string, 3> lines{"x_mm", "y_mm", "z_mm"};
  for (std::size_t i = 0; i < 3; ++i) {
    q.segment[i] = s.numbers<2>(lines[i]);
    if (!(q.segment[i][0] < q.segment[i][1]))
      s.complain(lines[i], fmt::format("'{}' must be [low, high]", lines[i]));
  }
  return q;
}

double read_delay_us(const TomlSection& s, const std::string& key) {
  const double us = s.number_or(key, 0.0);
  if (!(us >= 0.0 && us <= 1000.0))
    s.complain(key, fmt::format("'{}' must be from 0 to 1000", key));
  return us;
}

ProbeFile read_probe(const TomlSection& s) {
  s.allow_only({"radius_mm", "delay_us"});
  ProbeFile probe;
  probe.radius_mm = s.number("radius_mm");
  if (!(probe.radius_mm > 0.0 && probe.radius_mm <= 20.0))
    s.complain("radius_mm", "'radius_mm' must be above 0 and at most 20");
  probe.delay_us = read_delay_us(s, "delay_us");
  return probe;
}

}  // namespace volcomp::sim
