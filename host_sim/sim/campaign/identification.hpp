#pragma once
// A simulated laser tracker that measures the targets of host/measure/axis_errors.hpp without
// noise, and how far what was identified from it is from the truth.

#include "host_sim/host/measure/axis_errors.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

struct Identification {
  host::Identification found;
  std::vector<std::vector<ErrorMotion>> truth;  // by NC axis, at the nodes of `found`

  // Identified − true, mm or rad.
  [[nodiscard]] double max_error() const;
};

// At the equally spaced targets of the machine file. Throws UserError where an axis comes before
// one that carries it.
[[nodiscard]] Identification identify_axes(const TrueMachine& truth, const host::MachineFile& file);

}  // namespace volcomp::sim
