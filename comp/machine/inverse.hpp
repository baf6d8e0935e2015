#pragma once
// From a position error to offsets of the correcting axes: Δq = −J⁺ E, J = ∂p/∂q of the ideal
// chain.

#include "comp/machine/machine_chain.hpp"

namespace volcomp {

// Below this |det| of the (column-normalised) Jacobian the correcting axes have no authority
// (conventions, section 4).
inline constexpr double kMinAuthority = 0.1;

struct MotionOffset {
  Pose offset{};                  // by NC axis, mm or rad; 0 for axes that do not correct
  Vec3 remainder = Vec3::Zero();  // position error left over, base, mm
  double authority = 0.0;         // |det| of the unit columns, or the sine of the angle between two
};

// Column of ∂p/∂q for one NC axis, tool relative to work, base frame: mm/mm or mm/rad.
[[nodiscard]] Vec3 jacobian_column(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                                   std::size_t nc_axis);

// Refuses no_authority (where.value = authority); `out` is then unchanged.
Status motion_offset(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                     const Vec3& error_base, MotionOffset& out);

}  // namespace volcomp
