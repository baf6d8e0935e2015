#pragma once
// What plans of a tracing interferometer have in common that are made for any machine.

#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::sim {

// Standard uncertainties, figures of makers, from memory.
inline constexpr double kTracer_mm = 0.1e-3;    // of a reading
inline constexpr double kWavelength = 0.15e-6;  // of all lengths of a set-up

[[nodiscard]] host::identify::Machine machine_of(const host::MachineFile& file);

// Four corners of a cube about all places of the tool, work frame, no three of them in a plane with
// the fourth.
[[nodiscard]] std::vector<Vec3> stations_about(const host::identify::Machine& machine);

}  // namespace volcomp::sim
