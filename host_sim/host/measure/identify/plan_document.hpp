#pragma once
// What a plan will see as a report with pictures.

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/plan_prediction.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host::identify {

[[nodiscard]] nlohmann::json plan_document(const MeasurementPlan& plan,
                                           const PlanPrediction& predicted, const RunContext& run,
                                           Origins origins);

}  // namespace volcomp::host::identify
