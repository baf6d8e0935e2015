#pragma once
// Refusals in words, with what a user needs to find the fault.

#include <string>

#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

// Place, reason, and what is not seen.
[[nodiscard]] std::string described(const Refusal& refusal);

// Both throw UserError where there is a refusal. Of a solution: with the reading that fits least
// where nothing converges, with the set-ups that the others do not predict where readings
// contradict each other.
void require_good(const MeasurementPlan& plan, const Refusal& refusal);
void require_good(const MeasurementPlan& plan, const Equations& equations,
                  const Solution& solution);

}  // namespace volcomp::host::identify
