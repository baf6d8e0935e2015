#pragma once
// Measuring a machine of any axes: six error motions of each, and its squareness.

#include "host_sim/sim/campaign/campaign.hpp"

namespace volcomp::sim {

// Value of an axis as its machine file means it: the inverse of to_internal().
[[nodiscard]] ErrorMotion in_file_terms(const ErrorMotion& internal, const host::MachineFile& file,
                                        std::size_t axis, double q);

// `runs` bidirectional runs per axis at the equally spaced targets of the machine file, with the
// convention, on the side and at the sensed points it states. The machine file that comes back has
// its squareness as measured and its references at targets. What is constant there stays as the
// file states it: no run shows it. Of a linear axis that is where the machine counts from; of a
// rotary one it is found by other means (rotary_locations.hpp).
[[nodiscard]] Campaign measure_any_machine(const TrueMachine& truth, const host::MachineFile& file,
                                           const NoiseClasses& classes, std::size_t runs,
                                           const CampaignDraw& draw);

}  // namespace volcomp::sim
