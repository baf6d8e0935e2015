#pragma once
// Abbe and Bryan: the same angles, seen at another point, are other displacements
// (docs/papers/xyfz.md).

#include "comp/machine/frame.hpp"

namespace volcomp {

// Where an instrument senses, as seen from the reading head: L(q) = L0 + kappa·q·â. Vector head →
// sensed point, mm.
struct SensedPoint {
  Vec3 at_zero = Vec3::Zero();
  int kappa = 0;  // 0: rides on the moving body; +1: fixed on the other side of a
                  // workpiece-carrying axis; −1: the same of a tool-carrying axis

  [[nodiscard]] Vec3 lever(Axis axis, double q) const {
    return at_zero + kappa * q * unit_vector(axis);
  }
};

// m = δ + ε × L: what is measured at the end of the lever. Angles unchanged.
[[nodiscard]] ErrorMotion at_lever(const ErrorMotion& at_head, const Vec3& lever);

// δ = m − ε × L: back to the reading head.
[[nodiscard]] ErrorMotion at_head(const ErrorMotion& measured, const Vec3& lever);

}  // namespace volcomp
