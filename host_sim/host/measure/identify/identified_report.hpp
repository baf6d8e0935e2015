#pragma once
// What was identified, as text for people and as JSON.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/identification.hpp"

namespace volcomp::host::identify {

// Tables and sentences, in the order of the text.
[[nodiscard]] nlohmann::json identified_sections(const MeasurementPlan& plan,
                                                 const Identified& found);
[[nodiscard]] std::string identified_text(const MeasurementPlan& plan, const Identified& found);
[[nodiscard]] nlohmann::json identified_json(const MeasurementPlan& plan, const Identified& found);

}  // namespace volcomp::host::identify
