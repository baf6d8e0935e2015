#include "comp/metrology/gears/internal_gear.hpp"

#include <cmath>
#include <limits>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

Status check_setting(const char* field, double value, bool allowed) {
  if (!std::isfinite(value)) return refuse_value(Reason::not_finite, field, value);
  return allowed ? Status{} : refuse_value(Reason::bad_setting, field, value);
}

Status check_given(const InternalGear& g) {
  constexpr double kMostAngle = 0.25 * kPi;
  constexpr double kRounding = 1e-12;  // of 45° given in degrees
  if (const Status s = check_setting("teeth", g.teeth, g.teeth >= 5 && g.teeth <= 1000); !s.ok())
    return s;
  if (const Status s = check_setting("module", g.module, g.module > 0.0); !s.ok()) return s;
  if (const Status s = check_setting("pressure_angle", g.pressure_angle,
                                     g.pressure_angle > 0.0 && g.pressure_angle < kMostAngle);
      !s.ok())
    return s;
  if (const Status s = check_setting("helix_angle", g.helix_angle,
                                     std::abs(g.helix_angle) <= kMostAngle + kRounding);
      !s.ok())
    return s;
  if (const Status s = check_setting("profile_shift", g.profile_shift, true); !s.ok()) return s;
  if (const Status s = check_setting("addendum", g.addendum, g.addendum > 0.0); !s.ok()) return s;
  return check_setting("dedendum", g.dedendum, g.dedendum > 0.0);
}

double involute(double angle) { return std::tan(angle) - angle; }

}  // namespace

bool InternalGear::spur() const { return !(std::abs(turn_per_mm) > 0.0); }

double InternalGear::screw_parameter() const {
  return spur() ? std::numeric_limits<double>::infinity() : r / std::tan(helix_angle);
}

double InternalGear::normal_lever() const { return r_b * std::cos(beta_b); }

Status derive(InternalGear& gear) {
  if (const Status s = check_given(gear); !s.ok()) return s;
  InternalGear g = gear;
  const double cos_beta = std::cos(g.helix_angle);
  g.alpha_t = std::atan(std::tan(g.pressure_angle) / cos_beta);
  g.r = 0.5 * g.module * g.teeth / cos_beta;
  g.r_b = g.r * std::cos(g.alpha_t);
  g.r_tip = g.r - g.addendum * g.module;
  g.r_root = g.r + g.dedendum * g.module;
  g.turn_per_mm = std::tan(g.helix_angle) / g.r;
  g.beta_b = std::atan(std::tan(g.helix_angle) * std::cos(g.alpha_t));
  g.psi_b = (0.5 * kPi + 2.0 * g.profile_shift * std::tan(g.pressure_angle)) / g.teeth +
            involute(g.alpha_t);
  if (!(g.r_tip > g.r_b)) return refuse_value(Reason::no_involute_at_tip, "addendum", g.r_tip);
  const double at_root = space_half_angle(g, g.r_root);
  if (!(at_root > 0.0)) return refuse_value(Reason::pointed_space, "dedendum", at_root);
  gear = g;
  return {};
}

double roll_angle(const InternalGear& gear, double radius) {
  return roll_length(gear, radius) / gear.r_b;
}

double roll_length(const InternalGear& gear, double radius) {
  return std::sqrt((radius - gear.r_b) * (radius + gear.r_b));
}

double space_half_angle(const InternalGear& gear, double radius) {
  const double u = roll_angle(gear, radius);
  return gear.psi_b - (u - std::atan(u));
}

SpaceFlankPoint space_flank_at(const InternalGear& gear, FlankSide side, double radius, double z) {
  const double s = side_sign(side);
  const double u = roll_angle(gear, radius);
  const double T = kPi + s * (gear.psi_b - u) + z * gear.turn_per_mm;
  const double c = std::cos(T);
  const double n = std::sin(T);
  const double cos_bb = std::cos(gear.beta_b);
  const double tangent = s * gear.r_b * u;
  return {{gear.r_b * c - tangent * n, gear.r_b * n + tangent * c, z},
          {s * cos_bb * n, -s * cos_bb * c, s * std::sin(gear.beta_b)}};
}

Status space_flank_deviation(const InternalGear& gear, FlankSide side, int space, const Vec3& point,
                             double& deviation) {
  if (!point.allFinite()) return refuse(Reason::not_finite);
  const double radius = std::hypot(point.x(), point.y());
  if (!(radius >= gear.r_b)) return refuse_value(Reason::inside_base_circle, nullptr, radius);
  const double s = side_sign(side);
  const double nominal = kPi + s * space_half_angle(gear, radius) + point.z() * gear.turn_per_mm +
                         2.0 * kPi * space / gear.teeth;
  const double off = std::remainder(std::atan2(point.y(), point.x()) - nominal, 2.0 * kPi);
  deviation = -s * gear.normal_lever() * off;
  return {};
}

double transverse_of(const InternalGear& gear, double dn) { return dn / std::cos(gear.beta_b); }

double pitch_arc_of(const InternalGear& gear, double dn) {
  return dn / (std::cos(gear.beta_b) * std::cos(gear.alpha_t));
}

double pitch_arc_towards_plus(const InternalGear& gear, FlankSide side, double dn) {
  return -side_sign(side) * pitch_arc_of(gear, dn);
}

}  // namespace volcomp
