#pragma once
// Pictures that reports of an estimate and of a plan have in common.

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/host/measure/identify/weakest.hpp"

namespace volcomp::host::identify {

// Functions with bands of ±2 u, two charts an axis.
[[nodiscard]] nlohmann::json function_curves(const MeasurementPlan& plan,
                                             const std::vector<FoundFunction>& functions,
                                             const std::string& note);
// An array: U (k = 2) of the functional point in sections of the travels.
[[nodiscard]] nlohmann::json volume_maps(const MeasurementPlan& plan,
                                         const std::vector<VolumeSection>& sections);
[[nodiscard]] nlohmann::json weakest_table(const MeasurementPlan& plan,
                                           const std::vector<WeakValue>& weakest);

}  // namespace volcomp::host::identify
