#pragma once
// A machine as it may really be, whatever its axes are: error motions drawn at random, rotary axes
// not quite where the drawing has them.

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Exactly as drawn.
[[nodiscard]] TrueMachine ideal_machine(const host::MachineFile& file);

// Errors of a linear axis, none at its reference; `own`: the channel of positioning.
[[nodiscard]] TrueAxis draw_linear(const host::AxisFile& file, std::size_t own, Random& random);

// The same seed is the same machine on every computer. Linear axes are right at their reference;
// rotary ones have error motions and location errors (ISO 230-1, 3.6) everywhere; X, Y and Z are
// out of square where the file has [squareness].
[[nodiscard]] TrueMachine draw_machine(const host::MachineFile& file, std::uint64_t seed);

// Places a rotary axis elsewhere: `location` in the frame before its motion, tool against work, mm
// and rad. Takes the room of the ripple in the two directions across the axis.
void set_location(const Joint& joint, const ErrorMotion& location, TrueAxis& axis);

}  // namespace volcomp::sim
