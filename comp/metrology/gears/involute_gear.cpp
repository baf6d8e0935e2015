#include "comp/metrology/gears/involute_gear.hpp"

#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

double sign_of(const Flank& flank) { return flank.side == FlankSide::left ? 1.0 : -1.0; }

// Polar angle of the tooth centre.
double tooth_angle(const InvoluteGear& gear, const Flank& flank, double x) {
  const double turned = std::tan(gear.helix_angle) * x / gear.r;
  return 2.0 * kPi * flank.tooth / gear.teeth + turned;
}

double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

Status refuse_field(const char* field, double value) {
  return refuse_value(std::isfinite(value) ? Reason::bad_setting : Reason::not_finite, field,
                      value);
}

// Involute of a base circle, `shift` further out along the roll, as the locus of a ball centre is.
FlankPoint involute_point(double r_b, double angle, double sigma, double eta, double roll) {
  const double alpha = std::atan2(roll, r_b);
  const double rho = std::hypot(r_b, roll);
  const double phi = angle + sigma * (eta - (roll / r_b - alpha));
  const double radial = std::sin(alpha);
  const double around = sigma * std::cos(alpha);
  const double c = std::cos(phi);
  const double s = std::sin(phi);
  return {{rho * c, rho * s}, {radial * c - around * s, radial * s + around * c}};
}

}  // namespace

Status derive(InvoluteGear& gear) {
  InvoluteGear g = gear;
  if (g.teeth < 5 || g.teeth > 1000) return refuse_field("teeth", g.teeth);
  if (!(g.module > 0.0) || !std::isfinite(g.module)) return refuse_field("module", g.module);
  if (!(g.pressure_angle > 0.0 && g.pressure_angle < 0.25 * kPi))
    return refuse_field("pressure_angle", g.pressure_angle);
  if (!(std::abs(g.helix_angle) < 0.25 * kPi)) return refuse_field("helix_angle", g.helix_angle);
  if (!(g.width > 0.0) || !std::isfinite(g.width)) return refuse_field("width", g.width);
  const double cos_beta = std::cos(g.helix_angle);
  const double alpha_t = std::atan(std::tan(g.pressure_angle) / cos_beta);
  g.r = 0.5 * g.module * g.teeth / cos_beta;
  g.r_b = g.r * std::cos(alpha_t);
  g.eta_b = kPi / (2.0 * g.teeth) + std::tan(alpha_t) - alpha_t;
  g.beta_b = std::asin(std::sin(g.helix_angle) * std::cos(g.pressure_angle));
  if (!(0.5 * g.tip_diameter > g.r_b) || !std::isfinite(g.tip_diameter))
    return refuse_field("tip_diameter", g.tip_diameter);
  g.roll_begin = g.r * std::sin(alpha_t) - g.module / std::sin(alpha_t);
  g.roll_end = std::sqrt(0.25 * g.tip_diameter * g.tip_diameter - g.r_b * g.r_b);
  gear = g;
  return {};
}

FlankPoint flank_at(const InvoluteGear& gear, const Flank& flank, double roll_length, double x) {
  return involute_point(gear.r_b, tooth_angle(gear, flank, x), sign_of(flank), gear.eta_b,
                        roll_length);
}

Transverse ball_centre_at(const InvoluteGear& gear, const Flank& flank, double roll_length,
                          double r_c) {
  return involute_point(gear.r_b, tooth_angle(gear, flank, 0.0), sign_of(flank),
                        gear.eta_b + r_c / gear.r_b, roll_length + r_c)
      .point;
}

Status distance_from_flank(const InvoluteGear& gear, const Flank& flank, const Transverse& point,
                           double x, FlankDistance& out) {
  const double rho = std::hypot(point.y, point.z);
  if (!std::isfinite(rho) || !std::isfinite(x)) return refuse(Reason::not_finite);
  if (rho < gear.r_b) {
    Where where;
    where.value = rho;
    where.has_value = true;
    return refuse(Reason::inside_base_circle, where);
  }
  const double sigma = sign_of(flank);
  const double tangent = std::sqrt((rho - gear.r_b) * (rho + gear.r_b));
  const double alpha = std::atan2(tangent, gear.r_b);
  const double angle = std::atan2(point.z, point.y) - tooth_angle(gear, flank, x);
  FlankDistance d;
  d.distance = gear.r_b * (sigma * wrapped(angle) + tangent / gear.r_b - alpha - gear.eta_b);
  d.roll_length = tangent - d.distance;
  const FlankPoint at = flank_at(gear, flank, d.roll_length, x);
  d.foot = at.point;
  d.normal = at.normal;
  out = d;
  return {};
}

double deviation_of(const InvoluteGear& gear, double distance, double r_c) {
  const double c = std::cos(gear.beta_b);
  return (distance - r_c / c) * c;
}

Status deviation_from_flank(const InvoluteGear& gear, const Flank& flank, const Vec3& point,
                            double& deviation, double& roll_length) {
  constexpr double kOtherFlank_mm = 0.5;
  FlankDistance d;
  if (const Status s = distance_from_flank(gear, flank, {point.y(), point.z()}, point.x(), d);
      !s.ok())
    return s;
  const double off = deviation_of(gear, d.distance, 0.0);
  Where where;
  where.has_deviation = true;
  where.deviation = off;
  if (std::abs(off) > kOtherFlank_mm) return refuse(Reason::wrong_flank, where);
  deviation = off;
  roll_length = d.roll_length;
  return {};
}

}  // namespace volcomp
