#pragma once
// Measuring a machine of any axes: six error motions of each, where its rotary axes are, and its
// squareness.

#include "host_sim/sim/campaign/campaign.hpp"

namespace volcomp::sim {

// Value of an axis as its machine file means it: the inverse of to_internal().
[[nodiscard]] ErrorMotion in_file_terms(const ErrorMotion& internal, const host::MachineFile& file,
                                        std::size_t axis, double q);

// `runs` bidirectional runs per axis at the equally spaced targets of the machine file, with the
// convention, on the side and at the sensed points it states. The machine file that comes back has
// its squareness as measured, its references at targets, and the errors there.
[[nodiscard]] Campaign measure_any_machine(const TrueMachine& truth, const host::MachineFile& file,
                                           const NoiseClasses& classes, std::size_t runs,
                                           Random& random);

}  // namespace volcomp::sim
