#pragma once
// What reports of an estimate and of a plan have in common.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

inline constexpr double kCover = 2.0;  // of the uncertainties that are shown
inline constexpr double kUradPerRad = 1e6;

// A value as reports show it: µm or µrad.
[[nodiscard]] double shown(const Quantity& quantity, double value);
[[nodiscard]] const char* shown_unit(const Quantity& quantity);

// Sections of a report; `measured`: of an estimate, with its values.
[[nodiscard]] nlohmann::json function_section(const std::vector<FoundFunction>& functions,
                                              bool measured);
// Squareness, reversals, places of rotary axes; null where there are none.
[[nodiscard]] nlohmann::json value_section(const std::vector<FoundValue>& values,
                                           const std::optional<FoundSquareness>& squareness,
                                           bool measured);
[[nodiscard]] std::string volume_line(const FoundVolume& v);

[[nodiscard]] nlohmann::json volume_json(const FoundVolume& v);
[[nodiscard]] nlohmann::json functions_json(const MeasurementPlan& plan,
                                            const std::vector<FoundFunction>& functions);
[[nodiscard]] nlohmann::json values_json(const std::vector<FoundValue>& values);
[[nodiscard]] nlohmann::json plan_json(const MeasurementPlan& plan);

// function,position,unit of position,value,u,unit
[[nodiscard]] std::string functions_csv(const MeasurementPlan& plan,
                                        const std::vector<FoundFunction>& functions);

}  // namespace volcomp::host::identify
