#pragma once
// The forward problem: where a wheel of a given profile touches the helical flank it generates, and
// the flank it leaves behind. Eqs. 17 and 18 of docs/papers/internal-helical.md with the screw
// parameter put in: (k × r + p k) · n = 0, for the motion of wheel and gear has no component along
// the normal at a contact.

#include "comp/metrology/gears/form_wheel.hpp"

namespace volcomp {

// A point of the profile, and the screw it is to grind.
struct WheelGeneration {
  WheelSetup setup;
  double turn_per_mm = 0.0;  // 1/p
};

// Around the wheel, rad. Beyond ±0.35 of π there is a second root of no meaning.
struct ContactWindow {
  double low = 0.0;
  double high = 0.0;
};
[[nodiscard]] ContactWindow default_contact_window();

struct GeneratedPoint {
  double phi = 0.0;
  Vec3 point;   // in the gear frame, C and stroke at 0, mm
  Vec3 normal;  // unit, out of the wheel, into the material
};

// The root in the window, by at most 60 bracketed steps. Refused: no_contact where the
// condition does not change its sign: never the last iterate.
Status generated_point(const WheelGeneration& generation, double rho,
                       const WheelProfile::At& profile, const ContactWindow& window,
                       GeneratedPoint& out);

struct RegeneratedPoint {
  double radius = 0.0;     // in the gear, mm
  double deviation = 0.0;  // from the ideal flank, along its normal, mm; positive = excess material
};

// What the wheel makes of the flank at the wheel radius rho with ideal motion.
Status regenerated_flank(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                         const WheelProfile& profile, double rho, RegeneratedPoint& out);

}  // namespace volcomp
