#include "comp/metrology/gears/form_wheel.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

constexpr int kMostSteps = 60;
constexpr double kOnTheAxis_mm = 1e-9;

// By how much the normal of the flank at (radius, z) misses the wheel axis, mm.
double axis_distance(const InternalGear& gear, const Frame& wheel, FlankSide side, double radius,
                     double z) {
  const SpaceFlankPoint at = space_flank_at(gear, side, radius, z);
  return wheel.R.col(1).dot(added(at.P, -1.0, wheel.t).cross(at.n));
}

// The z at which the normal meets the axis. Secant steps to round-off.
bool solve_contact_height(const InternalGear& gear, const Frame& wheel, FlankSide side,
                          double radius, double& z) {
  double before = 1e-3 * gear.r;
  double f_before = axis_distance(gear, wheel, side, radius, before);
  z = 0.0;
  double f = axis_distance(gear, wheel, side, radius, z);
  for (int i = 0; i < kMostSteps; ++i) {
    const double rise = f - f_before;
    if (!(std::abs(rise) > 0.0)) break;
    const double step = -f * (z - before) / rise;
    before = z;
    f_before = f;
    z += step;
    f = axis_distance(gear, wheel, side, radius, z);
    if (!(std::abs(step) > 1e-15 * gear.r)) break;
  }
  // Far up or down the helix there are other normals that meet the axis; the wheel is not there.
  return std::abs(f) < kOnTheAxis_mm && std::abs(z) < gear.r;
}

}  // namespace

Status wheel_setup(const InternalGear& gear, double wheel_radius, double swivel, WheelSetup& out) {
  if (!std::isfinite(wheel_radius))
    return refuse_value(Reason::not_finite, "wheel_radius", wheel_radius);
  if (!std::isfinite(swivel)) return refuse_value(Reason::not_finite, "swivel", swivel);
  if (!(wheel_radius > 0.0)) return refuse_value(Reason::bad_setting, "wheel_radius", wheel_radius);
  if (std::abs(swivel) > kPi / 3.0) return refuse_value(Reason::bad_setting, "swivel", swivel);
  if (!(wheel_radius < gear.r_tip))
    return refuse_value(Reason::wheel_too_large, "wheel_radius", wheel_radius);
  out = {gear.r_root - wheel_radius, swivel};
  return {};
}

Frame wheel_at_rest(const WheelSetup& setup) {
  return {axis_rotation(Axis::x, setup.swivel), {-setup.centre_distance, 0.0, 0.0}};
}

Status wheel_contact(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                     double radius, WheelContact& out) {
  if (!std::isfinite(radius)) return refuse_value(Reason::not_finite, "radius", radius);
  if (!(radius >= gear.r_b)) return refuse_value(Reason::inside_base_circle, "radius", radius);
  const Frame wheel = wheel_at_rest(setup);
  double z = 0.0;
  if (!solve_contact_height(gear, wheel, side, radius, z))
    return refuse_value(Reason::no_contact, "radius", radius);
  WheelContact c;
  c.flank = space_flank_at(gear, side, radius, z);
  const Vec3 q = wheel.apply_inverse(c.flank.P);
  const Vec3 m = turned_back(wheel.R, c.flank.n);
  c.rho = std::hypot(q.x(), q.z());
  c.y = q.y();
  c.slope = -(q.x() * m.x() + q.z() * m.z()) / (c.rho * m.y());
  c.phi = std::atan2(-q.z(), q.x());
  if (c.phi < 0.0) c.phi += 2.0 * kPi;
  out = c;
  return {};
}

WheelProfile::At WheelProfile::at(double rho) const {
  const double place = (rho - rho0) / pitch;
  const auto most = static_cast<double>(knots - 2);
  const double below = std::min(std::max(std::floor(place), 0.0), most);
  const auto i = static_cast<std::size_t>(below);
  const double t = place - below;
  const double d0 = slope[i] * pitch;
  const double d1 = slope[i + 1] * pitch;
  const double rise = y[i + 1] - y[i];
  const double square = 3.0 * rise - 2.0 * d0 - d1;
  const double cube = d0 + d1 - 2.0 * rise;
  return {y[i] + t * (d0 + t * (square + t * cube)),
          (d0 + t * (2.0 * square + 3.0 * t * cube)) / pitch};
}

Status wheel_profile(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                     double r_low, double r_high, std::size_t knots, WheelProfile& out) {
  Where where;
  where.count = static_cast<int>(knots);
  if (knots < 2) return refuse(Reason::too_few_knots, where);
  if (knots > kWheelKnots) return refuse(Reason::too_many_knots, where);
  if (!(r_low < r_high)) return refuse_value(Reason::bad_setting, "r_high", r_high);
  WheelContact low;
  WheelContact high;
  if (const Status s = wheel_contact(gear, setup, side, r_low, low); !s.ok()) return s;
  if (const Status s = wheel_contact(gear, setup, side, r_high, high); !s.ok()) return s;

  WheelProfile profile;
  profile.knots = knots;
  profile.rho0 = low.rho;
  profile.pitch = (high.rho - low.rho) / static_cast<double>(knots - 1);
  const double r_per_rho = (r_high - r_low) / (high.rho - low.rho);
  WheelContact at = low;
  double radius = r_low;
  for (std::size_t k = 0; k < knots; ++k) {
    const double rho = profile.rho0 + profile.pitch * static_cast<double>(k);
    // ρ(r) is so nearly a line that the slope of its chord halves the digits every step.
    for (int i = 0; i < kMostSteps && std::abs(rho - at.rho) > 1e-13 * rho; ++i) {
      radius += (rho - at.rho) * r_per_rho;
      if (const Status s = wheel_contact(gear, setup, side, radius, at); !s.ok()) return s;
    }
    // What is left of the distance to the knot goes by the slope.
    profile.y[k] = at.y + at.slope * (rho - at.rho);
    profile.slope[k] = at.slope;
  }
  out = profile;
  return {};
}

}  // namespace volcomp
