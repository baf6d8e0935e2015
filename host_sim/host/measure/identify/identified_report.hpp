#pragma once
// What was identified, or what a plan will see: as text for people, as JSON, and the functions as
// CSV.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/foresight.hpp"
#include "host_sim/host/measure/identify/identification.hpp"

namespace volcomp::host::identify {

[[nodiscard]] std::string identified_text(const MeasurementPlan& plan, const Identified& found);
[[nodiscard]] nlohmann::json identified_json(const MeasurementPlan& plan, const Identified& found);
// function,position [mm or deg],value [um or urad],u [um or urad]
[[nodiscard]] std::string functions_csv(const MeasurementPlan& plan,
                                        const std::vector<FoundFunction>& functions);

[[nodiscard]] std::string foreseen_text(const MeasurementPlan& plan, const Foreseen& foreseen);
[[nodiscard]] nlohmann::json foreseen_json(const MeasurementPlan& plan, const Foreseen& foreseen);

}  // namespace volcomp::host::identify
