#pragma once
// How the errors of the L300G are identified: which unknowns, from which readings
// (docs/papers/l300g.md, "What we do").

#include "host_sim/sim/campaign/traced_errors.hpp"

namespace volcomp::l300g {

// All 24 error functions, the places of B and A, and where the gear stands on A. Segments are a
// third to a quarter of the waves of `p8-variation`.
[[nodiscard]] sim::TracedPlan traced_plan();

}  // namespace volcomp::l300g
