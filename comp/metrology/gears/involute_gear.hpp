#pragma once
// External involute gear in its own frame: axis along X, angles from +Y to +Z, tooth 0 centred on
// +Y at x = 0. Lengths mm, angles rad.
//
// Everything is closed: the distance of a point from a flank needs no iteration.

#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp {

struct InvoluteGear {
  int teeth = 0;
  double module = 0.0;          // normal
  double pressure_angle = 0.0;  // normal, at the reference cylinder
  double helix_angle = 0.0;     // 0: spur; positive: right hand
  double tip_diameter = 0.0;
  double width = 0.0;

  // Derived.
  double r = 0.0;           // reference radius
  double r_b = 0.0;         // base radius
  double eta_b = 0.0;       // half the tooth thickness angle at the base circle
  double beta_b = 0.0;      // base helix angle
  double roll_begin = 0.0;  // roll length where a rack of addendum one module begins to touch
  double roll_end = 0.0;    // at the tip
};

// Fills in what follows from the given values. Refused: not_finite, bad_setting with the field.
Status derive(InvoluteGear& gear);

enum class FlankSide : signed char { left = 1, right = -1 };  // seen along −X: left faces +φ

struct Flank {
  FlankSide side = FlankSide::left;
  int tooth = 0;  // 0…teeth − 1, towards +φ
};

// Transverse plane coordinates, or a direction in it.
struct Transverse {
  double y = 0.0;
  double z = 0.0;
};

struct FlankPoint {
  Transverse point;
  Transverse normal;  // unit, out of the material, transverse
};

// The flank at a roll length (mm, ≥ 0) in the transverse plane at x.
[[nodiscard]] FlankPoint flank_at(const InvoluteGear& gear, const Flank& flank, double roll_length,
                                  double x);

// Centre of a ball of radius `r_c` that touches the flank there. Spur gears.
[[nodiscard]] Transverse ball_centre_at(const InvoluteGear& gear, const Flank& flank,
                                        double roll_length, double r_c);

struct FlankDistance {
  double distance = 0.0;     // transverse, positive outside the material
  double roll_length = 0.0;  // of the foot
  Transverse foot;
  Transverse normal;  // at the foot
};

// Distance of a point at x from the flank. inside_base_circle: no involute passes through it.
Status distance_from_flank(const InvoluteGear& gear, const Flank& flank, const Transverse& point,
                           double x, FlankDistance& out);

// Deviation of a touched point from the flank it is meant to be on, normal to it: positive for
// excess material. inside_base_circle, wrong_flank (deviation): more than 0.5 mm.
Status deviation_from_flank(const InvoluteGear& gear, const Flank& flank, const Vec3& point,
                            double& deviation, double& roll_length);

// How far a ball of radius `r_c` stands off the flank by more than its radius, normal to the flank:
// positive for excess material.
[[nodiscard]] double deviation_of(const InvoluteGear& gear, double distance, double r_c);

}  // namespace volcomp
