#pragma once

#include "comp/geometry/xyfz.hpp"
#include "comp/realtime/compensator.hpp"

namespace volcomp {

// The machine of seed 001 as its addendum gives it: an example of a machine compiled in.
inline constexpr MachineDescription kXyfzMachine =
    xyfz_optimised({{-200.0, -150.0, 180.0}, {20.0, 520.0, 1130.0}, {30.0, -380.0, -300.0}});

extern template class Compensator<LoadedMachine<5>>;
extern template class Compensator<CompiledMachine<kXyfzMachine>>;

using LoadedCompensator = Compensator<LoadedMachine<5>>;
using XyfzCompensator = Compensator<CompiledMachine<kXyfzMachine>>;

}  // namespace volcomp
