#pragma once
// Ball bar: measures the squareness of three axis pairs at its own place.

#include "comp/metrology/tables/squareness.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/instruments/noise_classes.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Apparent squareness of the machine's own errors along the three lines, plus 1 σ noise on each
// angle. X, Y and Z are the NC axes `xyz`; the others stand at zero.
[[nodiscard]] XyfzSquareness measure_squareness(const TrueMachine& machine, const Vec3& tool_point,
                                                const SquarenessLines& place, double sigma_rad,
                                                const CampaignDraw& draw,
                                                const std::array<std::size_t, 3>& xyz = {0, 1, 2});

// In the way and at the place that the machine file states: by circles of a bar with all its noise
// unless `classes` are those of no_noise(), or along lines.
[[nodiscard]] XyfzSquareness measure_squareness(const TrueMachine& machine,
                                                const host::SquarenessFile& place,
                                                const NoiseClasses& classes,
                                                const CampaignDraw& draw,
                                                const std::array<std::size_t, 3>& xyz = {0, 1, 2});

}  // namespace volcomp::sim
