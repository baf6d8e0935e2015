#pragma once
// A machine as its file describes it, with drawn errors, for trying the tools without a real one.

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

struct SimulatedMachine {
  host::MachineFile machine;
  TrueMachine truth;
};

// Error motions of the linear axes drawn at random, the same for the same seed; rotary axes turn
// without errors. Where the file states a value, the machine has it: a ball bar reads the
// [squareness], and at their references the axes have the errors stated for them. Without
// [squareness] its axes are square, and what was measured of their straightness has no slope.
[[nodiscard]] TrueMachine draw_slides(const host::MachineFile& file, std::uint64_t seed);

// The file with targets so that one of them is at the reference of each axis, as tables need it:
// more targets where that is enough, else a grid that begins and ends up to one pitch inside the
// travel.
[[nodiscard]] host::MachineFile with_targets_at_references(host::MachineFile file);

}  // namespace volcomp::sim
