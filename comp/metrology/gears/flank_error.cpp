#include "comp/metrology/gears/flank_error.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/gears/flank_envelope.hpp"

namespace volcomp {

Status contact_instant(const InternalGear& gear, const WheelSetup& setup, const FlankPlace& place,
                       ContactInstant& out) {
  WheelContact contact;
  if (const Status s = wheel_contact(gear, setup, place.side, place.radius, contact); !s.ok())
    return s;
  const SpaceFlankPoint at = space_flank_at(gear, place.side, place.radius, place.z);
  const double stroke = place.z - contact.flank.P.z();
  out = {at.P, at.n, stroke, -stroke * gear.turn_per_mm};
  return {};
}

Pose grinding_pose(const InternalGear& gear, const WheelSetup& setup, double stroke) {
  return grinder_pose(setup.centre_distance, stroke, -stroke * gear.turn_per_mm, setup.swivel);
}

double flank_deviation(const ContactInstant& instant, const LeftError& error) {
  return instant.n.dot(error.at(instant.P));
}

Status flank_sensitivity(const MachineChain& chain, const InternalGear& gear,
                         const WheelSetup& setup, const FlankPlace& place, SensitivityRows& rows) {
  ContactInstant at;
  if (const Status s = contact_instant(gear, setup, place, at); !s.ok()) return s;
  rows = left_error_sensitivity(chain, grinding_pose(gear, setup, at.stroke), at.P, at.n);
  return {};
}

double synchronisation_error(const InternalGear& gear, double e_z, double e_c) {
  return e_c + e_z * gear.turn_per_mm;
}

double synchronisation_on_flank(const InternalGear& gear, double e_s) {
  return gear.normal_lever() * e_s;
}

Status contact_curvature(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                         double radius, double& kappa) {
  constexpr double kReach = 0.2;   // of radius: the piece of profile that is evaluated, mm
  constexpr double kAside = 0.01;  // along the stroke, mm
  constexpr std::size_t kKnots = 9;
  const double low = std::max(radius - kReach, 0.5 * (radius + gear.r_b));
  WheelProfile profile;
  if (const Status s = wheel_profile(gear, setup, side, low, radius + kReach, kKnots, profile);
      !s.ok())
    return s;
  WheelContact contact;
  if (const Status s = wheel_contact(gear, setup, side, radius, contact); !s.ok()) return s;
  double sum = 0.0;
  for (const double dz : {-kAside, kAside}) {
    double gap = 0.0;
    if (const Status s = wheel_gap(profile, generating_frame(gear, setup, dz), contact.flank, gap);
        !s.ok())
      return s;
    sum += gap;
  }
  kappa = sum / (kAside * kAside);
  return {};
}

double first_order_limit(double kappa, double wavelength) {
  return kappa * wavelength * wavelength / (4.0 * kPi * kPi);
}

double most_waviness(double kappa, double wavelength) {
  return kappa * wavelength * wavelength / 8.0;
}

LowerEnvelope lower_envelope(double kappa, Span<const double> first_order_dn, double spacing,
                             std::size_t centre, double tolerance) {
  LowerEnvelope e{first_order_dn[centre], true};
  for (std::size_t k = 0; k < first_order_dn.size(); ++k) {
    const double dz = (static_cast<double>(k) - static_cast<double>(centre)) * spacing;
    e.dn = std::min(e.dn, 0.5 * kappa * dz * dz + first_order_dn[k]);
  }
  e.first_order = first_order_dn[centre] - e.dn <= tolerance;
  return e;
}

}  // namespace volcomp
