#pragma once
// The report document of a run on the grinder (host_sim/report/README.md).

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/internal_helical/scenario.hpp"
#include "host_sim/scenarios/report/document.hpp"

namespace volcomp::sim {

[[nodiscard]] nlohmann::json internal_helical_document(const InternalHelicalResult& result,
                                                       const RunContext& run);

}  // namespace volcomp::sim
