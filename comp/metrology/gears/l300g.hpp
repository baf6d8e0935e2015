#pragma once
// The L300G gear grinder as a measuring machine (docs/papers/l300g.md): X, Y and the swing B carry
// the probe, A carries the gear. NC axes 0 = X, 1 = Y, 2 = B, 3 = A.
//
// Base frame: origin on the axis of A, +X along it, +Y towards the probe, +Z up. The arm points to
// −X at B = zero and swings about +Y.

#include "comp/machine/machine_chain.hpp"

namespace volcomp {

struct SwingArm {
  double length = 173.7135;  // L_R, pivot to ball centre, mm
  double zero = 0.0;         // Bc: encoder angle with the arm horizontal, rad
};

struct L300gDatum {
  double x = 0.0;  // X0 and Y0: readings with the ball centre at x = 0 and on the axis of A, mm
  double y = 0.0;
};

// What the ball centre moves along +X from where it is at B = zero, mm; never negative.
[[nodiscard]] double arm_foreshortening(const SwingArm& arm, double B);
// dZ/dB, mm per rad.
[[nodiscard]] double arm_lift(const SwingArm& arm, double B);
// The angle near zero at which the arm has this height. out_of_reach (value).
Status arm_angle(const SwingArm& arm, double height, double& B);

}  // namespace volcomp
