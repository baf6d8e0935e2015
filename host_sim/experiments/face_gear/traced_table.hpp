#pragma once
// How the errors of the YK7280 are identified: which unknowns, from which readings
// (docs/papers/face-gear.md, "With a probe that scatters").

#include "host_sim/sim/campaign/traced_errors.hpp"

namespace volcomp::face_gear {

// All 24 error functions, the place of C, and where the gear stands on it. `slide_step_mm`: of the
// scales, a reading of which lies anywhere in a step.
[[nodiscard]] sim::TracedPlan traced_plan(double slide_step_mm);

}  // namespace volcomp::face_gear
