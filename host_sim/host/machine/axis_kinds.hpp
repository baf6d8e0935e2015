#pragma once
// How the NC axes of a machine count: linear ones in mm, rotary ones in rad; at run time in nm and
// 2^-40 turn (comp/core/units.hpp).

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/machine/machine_chain.hpp"
#include "comp/tick/instances.hpp"

namespace volcomp::host {

// Whatever moves a machine has room for as many axes as the compensation.
inline constexpr std::size_t kMostAxes = LoadedCompensator::kAxes;

// By NC axis, run-time units: the command of one period without any offset, and the offset.
using Targets = std::array<std::int64_t, kMostAxes>;
using Offsets = std::array<std::int64_t, kMostAxes>;

struct AxisKinds {
  std::size_t count = 0;  // 1…kMostAxes
  std::array<bool, kMostAxes> rotary{};

  // Nearest run-time units. Rotary coordinates up to a million turns; linear ones saturate at
  // ±kMaxPosition.
  [[nodiscard]] Targets targets(const Pose& q) const;
};

// Throws UserError when there are more axes than there is room for.
[[nodiscard]] AxisKinds axis_kinds(const MachineChain& chain);

// A place of a machine whose first three axes are linear; the others stand at zero.
[[nodiscard]] inline Pose pose_of(const Vec3& xyz_mm) {
  return {xyz_mm.x(), xyz_mm.y(), xyz_mm.z()};
}

}  // namespace volcomp::host
