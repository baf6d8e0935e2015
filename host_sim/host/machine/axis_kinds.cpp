#include "host_sim/host/machine/axis_kinds.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

Targets AxisKinds::targets(const Pose& q) const {
  Targets units{};
  for (std::size_t a = 0; a < count; ++a)
    units[a] = rotary[a] ? std::llround(q[a] * kUnitsPerRad) : to_nm(q[a]);
  return units;
}

AxisKinds axis_kinds(const MachineChain& chain) {
  if (chain.axis_count() > kMostAxes) {
    throw UserError(fmt::format("the machine has {} axes, there is room for {}", chain.axis_count(),
                                kMostAxes));
  }
  AxisKinds kinds;
  kinds.count = chain.axis_count();
  for (std::size_t a = 0; a < kinds.count; ++a)
    kinds.rotary[a] = chain.axis(a).kind == JointKind::rotary;
  return kinds;
}

}  // namespace volcomp::host
