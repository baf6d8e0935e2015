#pragma once

#include "comp/machine/xyfz.hpp"
#include "comp/tick/compensator.hpp"

namespace volcomp {

// The XYFZ machine of docs/papers/xyfz.md: an example of a machine compiled in.
inline constexpr MachineDescription kXyfzMachine =
    xyfz_optimised({{-200.0, -150.0, 180.0}, {20.0, 520.0, 1130.0}, {30.0, -380.0, -300.0}});

// A loaded machine that only corrects the position of the tool point, which is what small boards
// have room for, and one whose rotary axes may hold the direction of the tool, too.
using PositionMachine = LoadedMachine<5>;
using OrientingMachine = LoadedMachine<5, kMaxOrienting>;

extern template class Compensator<PositionMachine>;
extern template class Compensator<OrientingMachine>;
extern template class Compensator<CompiledMachine<kXyfzMachine>>;

using LoadedCompensator = Compensator<PositionMachine>;
using OrientingCompensator = Compensator<OrientingMachine>;
using XyfzCompensator = Compensator<CompiledMachine<kXyfzMachine>>;

}  // namespace volcomp
