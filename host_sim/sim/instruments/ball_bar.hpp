#pragma once
// Ball bar: measures the squareness of three axis pairs at its own place.

#include "comp/metrology/tables/squareness.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Apparent squareness of the machine's own errors along the three lines, plus 1 σ noise on each
// angle. X, Y and Z are the NC axes `xyz`; the others stand at zero.
[[nodiscard]] XyfzSquareness measure_squareness(const TrueMachine& machine, const Vec3& tool_point,
                                                const SquarenessLines& place, double sigma_rad,
                                                Random& random,
                                                const std::array<std::size_t, 3>& xyz = {0, 1, 2});

}  // namespace volcomp::sim
