#pragma once
// The same gear on a gear measuring centre, as Fig. 10 of the paper has it (a Gleason 350GMS): a
// second instrument, with an error of its own.

#include <cstdint>

#include "host_sim/experiments/l300g/inspection.hpp"

namespace volcomp::l300g {

// What the centre adds: each point scatters, each trace is inclined as a whole. Standard
// deviations, µm, of the usual class, from memory.
struct CentreErrors {
  double point_um = 0.05;
  double slope_um = 0.25;  // over the evaluation range
};

// Profile and lead of tooth 0, filtered as ISO 1328-1:2013 asks, and pitch. `draw`: of the random
// numbers.
[[nodiscard]] GearInspection gear_on_centre(const InvoluteGear& gear, const CentreErrors& errors,
                                            std::uint64_t seed, std::uint32_t draw);

}  // namespace volcomp::l300g
