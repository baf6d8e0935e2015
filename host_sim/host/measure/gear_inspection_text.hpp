#pragma once
// An inspected gear for people, as CSV and as JSON: each deviation with its grade in both editions
// of ISO 1328-1.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/gear_inspection.hpp"

namespace volcomp::host {

[[nodiscard]] std::string inspection_text(const InvoluteGear& gear, const InspectedGear& inspected);

// trace,flank,tooth,figure,1995 [um],1995 grade,2013 [um],2013 class; worse than the last: ">12".
[[nodiscard]] std::string inspection_csv(const InspectedGear& inspected);

// A grade is null where the deviation is worse than the last one or the edition does not cover a
// gear of this size.
[[nodiscard]] nlohmann::json inspection_json(const InvoluteGear& gear,
                                             const InspectedGear& inspected);

}  // namespace volcomp::host
