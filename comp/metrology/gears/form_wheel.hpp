#pragma once
// The form wheel that grinds a given internal flank, from the inverse problem: its profile is where
// the normals of the flank meet the axis of the wheel. The paper (docs/papers/internal-helical.md)
// presupposes the profile.
//
// Wheel frame: Y along the axis, origin at the wheel centre; profile y(ρ), ρ the radius. The gear
// sees the centre at (−x, 0, stroke) and the axis along (0, cos A, sin A).

#include <array>

#include "comp/machine/frame.hpp"
#include "comp/metrology/gears/internal_gear.hpp"

namespace volcomp {

struct WheelSetup {
  double centre_distance = 0.0;  // x, mm: the wheel reaches the root circle
  double swivel = 0.0;           // A, rad: usually β, but any other grinds the same flank
};

// Refused: not_finite and bad_setting ("wheel_radius", "swivel": |A| > 60°), wheel_too_large
// (value) for a radius that is not below the tip radius.
Status wheel_setup(const InternalGear& gear, double wheel_radius, double swivel, WheelSetup& out);

// Wheel frame → gear frame with the wheel at stroke 0.
[[nodiscard]] Frame wheel_at_rest(const WheelSetup& setup);

// Where the wheel touches the flank of space 0 at one radius of the gear, C and stroke at 0.
struct WheelContact {
  SpaceFlankPoint flank;  // in the gear frame; z_c = flank.P.z()
  double rho = 0.0;       // wheel radius, mm
  double y = 0.0;         // along the wheel axis, mm
  double slope = 0.0;     // dy/dρ, from the normal
  double phi = 0.0;       // around the wheel, 0…2π: the point is (ρ cos φ, y, −ρ sin φ)
};

// At most 60 secant steps. Refused: no_contact (value = radius) when they do not end within
// 1e-9 mm, not_finite, inside_base_circle.
Status wheel_contact(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                     double radius, WheelContact& out);

inline constexpr std::size_t kWheelKnots = 65;

// y(ρ) of one flank of the wheel: uniform knots with exact slopes, cubic Hermite between them, the
// first and last piece continued beyond the ends.
struct WheelProfile {
  double rho0 = 0.0;
  double pitch = 0.0;
  std::size_t knots = 0;
  std::array<double, kWheelKnots> y{};
  std::array<double, kWheelKnots> slope{};

  struct At {
    double y = 0.0;
    double slope = 0.0;
  };
  [[nodiscard]] At at(double rho) const;
  [[nodiscard]] double last() const { return rho0 + pitch * static_cast<double>(knots - 1); }
};

// The profile for the flank between two radii of the gear, r_low < r_high. 17 knots regenerate the
// flank of the paper's gear within 0.1 nm. Refused: too_few_knots (< 2), too_many_knots,
// no_contact and what wheel_contact() refuses.
Status wheel_profile(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                     double r_low, double r_high, std::size_t knots, WheelProfile& out);

}  // namespace volcomp
