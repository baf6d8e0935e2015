#pragma once
// A simulated laser tracker that measures the targets of host/measure/axis_errors.hpp, and how far
// what was identified from it is from the truth.

#include "host_sim/host/measure/axis_errors.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

struct Identification {
  host::Identification found;
  std::vector<std::vector<ErrorMotion>> truth;  // by NC axis, at the nodes of `found`

  // Identified − true, mm or rad.
  [[nodiscard]] double max_error() const;
};

// How far its readings scatter: the same in all three directions, independent.
struct TrackerScatter {
  double sigma = 0.0;  // of a coordinate of a target, mm
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;
};

// At the equally spaced targets of the machine file. Throws UserError where an axis comes before
// one that carries it.
[[nodiscard]] Identification identify_axes(const TrueMachine& truth, const host::MachineFile& file,
                                           const TrackerScatter& scatter = {});

}  // namespace volcomp::sim
