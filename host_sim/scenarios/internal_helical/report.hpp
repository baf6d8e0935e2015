#pragma once
// The report document of a run on the grinder (host_sim/report/README.md).

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/internal_helical/scenario.hpp"

namespace volcomp::sim {

[[nodiscard]] nlohmann::json internal_helical_document(const InternalHelicalResult& run,
                                                       const std::string& command,
                                                       const std::string& transport);

}  // namespace volcomp::sim
