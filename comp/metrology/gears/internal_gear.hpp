#pragma once
// Internal involute gear, spur or helical, in its own frame: Z along its axis, angles from +X to
// +Y. The tooth SPACE has the outline of an external tooth; space 0 is centred on −X at z = 0,
// where a wheel inside the bore stands (comp/metrology/gears/internal_grinder.hpp). Lengths mm,
// angles rad.
//
// Flank side: left = +1 is the flank of a space at the larger angle, right = −1 the other. Seen
// from +Z with the tip of a tooth upwards these are the left and right flank of a TOOTH.

#include "comp/metrology/gears/involute_gear.hpp"

namespace volcomp {

struct InternalGear {
  int teeth = 0;                // 5…1000
  double module = 0.0;          // normal, > 0
  double pressure_angle = 0.0;  // normal, 0…45°, ends excluded
  double helix_angle = 0.0;     // |β| ≤ 45°; 0: spur; positive: right hand
  double profile_shift = 0.0;   // x_n in modules; positive makes the space thicker
  double addendum = 1.0;        // reference circle → tip circle, inwards, in modules
  double dedendum = 1.25;       // reference circle → root circle, outwards, in modules

  // Derived.
  double alpha_t = 0.0;  // transverse pressure angle
  double r = 0.0;        // reference radius
  double r_b = 0.0;      // base radius
  double r_tip = 0.0;    // smaller than r
  double r_root = 0.0;   // larger than r
  double psi_b = 0.0;    // half the angle of a space at the base circle
  double beta_b = 0.0;   // base helix angle, signed
  double turn_per_mm =
      0.0;  // 1/p, signed: turn of the helix per mm of z, rad/mm; 0 for a spur gear

  [[nodiscard]] bool spur() const;
  // p, mm/rad, signed: what a point of a flank advances along Z per radian; infinite for a spur
  // gear.
  [[nodiscard]] double screw_parameter() const;
  // What dn of a flank of side +1 is per rad of C: r_b cos β_b, mm/rad.
  [[nodiscard]] double normal_lever() const;
};

// Fills in what follows from the given values. Refused: not_finite and bad_setting with the field,
// no_involute_at_tip (value = tip radius), pointed_space (value = half angle of the space at the
// root circle).
Status derive(InternalGear& gear);

[[nodiscard]] constexpr double side_sign(FlankSide side) {
  return side == FlankSide::left ? 1.0 : -1.0;
}

// Roll angle tan α_r and roll length r_b tan α_r (mm) at a radius ≥ r_b. In an internal gear the
// roll length grows from the tip to the root.
[[nodiscard]] double roll_angle(const InternalGear& gear, double radius);
[[nodiscard]] double roll_length(const InternalGear& gear, double radius);
// Half the angle of a space at a radius ≥ r_b, rad.
[[nodiscard]] double space_half_angle(const InternalGear& gear, double radius);

struct SpaceFlankPoint {
  Vec3 P;
  Vec3 n;  // unit, out of the material, into the space
};

// The flank of space 0 at a radius ≥ r_b and a height z.
[[nodiscard]] SpaceFlankPoint space_flank_at(const InternalGear& gear, FlankSide side,
                                             double radius, double z);

// How far a point lies off the flank of a space (0…teeth − 1, towards +angle), along the normal and
// exactly: positive for excess material, mm. Refused: not_finite, inside_base_circle (value =
// radius).
Status space_flank_deviation(const InternalGear& gear, FlankSide side, int space, const Vec3& point,
                             double& deviation);

// --- projections of a deviation dn along the normal

// In the transverse plane, where profile and helix deviations are read.
[[nodiscard]] double transverse_of(const InternalGear& gear, double dn);
// Along the reference circle, where pitch is read; positive for excess material.
[[nodiscard]] double pitch_arc_of(const InternalGear& gear, double dn);
// The same, positive towards +angle.
[[nodiscard]] double pitch_arc_towards_plus(const InternalGear& gear, FlankSide side, double dn);

}  // namespace volcomp
