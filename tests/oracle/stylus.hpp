#pragma once
// From the centre of a probe ball to the point it touches.

#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp::test {

// `normal`: outward normal of the part at the contact, any length, not the direction of approach
// (docs/papers/l300g.md, eq. 12). mm. Refused: not_finite, zero_normal.
Status contact_point(const Vec3& centre, const Vec3& normal, double ball_radius, Vec3& out);

}  // namespace volcomp::test
