#pragma once
// What was identified as a report with pictures.

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/identification.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host::identify {

// Arrays: its pictures and its tables, for other reports as well.
[[nodiscard]] nlohmann::json identified_plots(const MeasurementPlan& plan, const Identified& found);
[[nodiscard]] nlohmann::json identified_details(const MeasurementPlan& plan,
                                                const Identified& found);

[[nodiscard]] nlohmann::json identified_document(const MeasurementPlan& plan,
                                                 const Identified& found, const RunContext& run,
                                                 Origins origins);

}  // namespace volcomp::host::identify
