#pragma once
// A machine as it may really be, whatever its axes are: error motions drawn at random, rotary axes
// not quite where the drawing has them.

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::any_machine {

// Exactly as drawn.
[[nodiscard]] sim::TrueMachine ideal_machine(const host::MachineFile& file);

// The same seed is the same machine on every computer. Linear axes are right at their reference;
// rotary ones have error motions and location errors (ISO 230-1, 3.6) everywhere; X, Y and Z are
// out of square where the file has [squareness].
[[nodiscard]] sim::TrueMachine draw_machine(const host::MachineFile& file, std::uint64_t seed);

// Places a rotary axis elsewhere: `location` in the frame before its motion, tool against work, mm
// and rad. Takes the room of the ripple in the two directions across the axis.
void set_location(const Joint& joint, const ErrorMotion& location, sim::TrueAxis& axis);

}  // namespace volcomp::any_machine
