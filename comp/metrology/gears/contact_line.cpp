#include "comp/metrology/gears/contact_line.hpp"

#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

constexpr int kMostSteps = 60;
// Tolerance of the condition divided by p; in mm, for the leads of gears, below 1e-9.
constexpr double kOnContact = 1e-12;

// The wheel point at φ in the gear frame, with its normal.
class WheelSurface {
 public:
  WheelSurface(const WheelGeneration& generation, double rho, const WheelProfile::At& profile)
      : wheel_(wheel_at_rest(generation.setup)),
        turn_per_mm_(generation.turn_per_mm),
        rho_(rho),
        profile_(profile) {}

  [[nodiscard]] GeneratedPoint at(double phi) const {
    const double c = std::cos(phi);
    const double s = std::sin(phi);
    const double out = (profile_.y < 0.0 ? -1.0 : 1.0) / std::hypot(1.0, profile_.slope);
    const Vec3 r(rho_ * c, profile_.y, -rho_ * s);
    const Vec3 n(-out * profile_.slope * c, out, out * profile_.slope * s);
    return {phi, wheel_.apply(r), turned(wheel_.R, n)};
  }

  // (k × r / p + k) · n
  [[nodiscard]] double condition(const GeneratedPoint& g) const {
    return turn_per_mm_ * (g.point.x() * g.normal.y() - g.point.y() * g.normal.x()) + g.normal.z();
  }

 private:
  Frame wheel_;
  double turn_per_mm_;
  double rho_;
  WheelProfile::At profile_;
};

}  // namespace

ContactWindow default_contact_window() { return {kPi - 0.35, kPi + 0.35}; }

// Illinois rule: false position, which keeps the bracket, with the weight of an end that stays
// halved.
Status generated_point(const WheelGeneration& generation, double rho,
                       const WheelProfile::At& profile, const ContactWindow& window,
                       GeneratedPoint& out) {
  const WheelSurface surface(generation, rho, profile);
  double a = window.low;
  double b = window.high;
  double f_a = surface.condition(surface.at(a));
  double f_b = surface.condition(surface.at(b));
  if (!(f_a * f_b < 0.0)) return refuse(Reason::no_contact);
  GeneratedPoint g;
  double f = f_a;
  for (int i = 0; i < kMostSteps; ++i) {
    g = surface.at(b - f_b * (b - a) / (f_b - f_a));
    f = surface.condition(g);
    if (f * f_b < 0.0) {
      a = b;
      f_a = f_b;
    } else {
      f_a *= 0.5;
    }
    const double step = std::abs(g.phi - b);
    b = g.phi;
    f_b = f;
    if (step < 1e-15 || !(std::abs(f) > 0.0)) break;
  }
  if (!(std::abs(f) < kOnContact)) return refuse(Reason::no_contact);
  out = g;
  return {};
}

Status regenerated_flank(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                         const WheelProfile& profile, double rho, RegeneratedPoint& out) {
  GeneratedPoint g;
  if (const Status s = generated_point({setup, gear.turn_per_mm}, rho, profile.at(rho),
                                       default_contact_window(), g);
      !s.ok())
    return s;
  double deviation = 0.0;
  if (const Status s = space_flank_deviation(gear, side, 0, g.point, deviation); !s.ok()) return s;
  out = {std::hypot(g.point.x(), g.point.y()), deviation};
  return {};
}

}  // namespace volcomp
