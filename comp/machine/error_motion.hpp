#pragma once
// Six error motions of one joint, and the rotation models that turn three small angles into a
// matrix.
//
// Internal convention, used everywhere behind the loaders: BODY values (motion of the body itself,
// for a workpiece-carrying axis the negative of the ISO 230-1 value) on the MOVING side (in the
// frame after the ideal motion of the joint). Order EX EY EZ EA EB EC, mm and rad.

#include <cstdint>

#include <Eigen/Core>

#include "comp/machine/joint.hpp"

namespace volcomp {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using ErrorMotion = Eigen::Matrix<double, 6, 1>;

inline Vec3 translation(const ErrorMotion& e) { return e.head<3>(); }
inline Vec3 rotation(const ErrorMotion& e) { return e.tail<3>(); }

enum class RotationModel : std::uint8_t {
  rxryrz,        // Rx(EA) Ry(EB) Rz(EC): the product's model
  exponential,   // exp([e]x)
  second_order,  // I + [e]x + N, Rx Ry Rz to second order: the run-time recursion
  linear,        // I + [e]x, not a rotation: only to reproduce printed equations
};

// R − I without cancellation, accurate to round-off of its own largest entry.
[[nodiscard]] Mat3 rotation_minus_identity(RotationModel model, const Vec3& angles);

// R⁻¹ − I without cancellation (the transpose, except for the linear model).
[[nodiscard]] Mat3 inverse_minus_identity(RotationModel model, const Vec3& angles);

enum class Convention : std::uint8_t {
  relative,  // tool with respect to workpiece (ISO 230-1; docs/papers/xyfz.md)
  body,      // motion of the body itself (docs/papers/l300g.md and internal-helical.md)
};

enum class Side : std::uint8_t {
  moving,  // in the frame after the motion
  fixed,   // rotary axis: in the fixed axis frame (ISO 230-7)
  base,    // linear axis: about the frame before the motion
};

// Converts measured or stored values at NC coordinate q (mm or rad) to the internal convention. No
// matrix is inverted: the convention changes six signs, the side turns or shifts. `fixed` applies
// to rotary joints and `base` to prismatic ones; for the other kind the two coincide with `moving`.
[[nodiscard]] ErrorMotion to_internal(const ErrorMotion& value, const Joint& joint, double q,
                                      Convention convention, Side side);

}  // namespace volcomp
