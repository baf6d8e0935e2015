#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/l300g/scenario.hpp"

namespace volcomp::sim {

// A run as a report document (host_sim/report/README.md). `transport`: where the node was.
[[nodiscard]] nlohmann::json l300g_document(const L300gResult& result, const std::string& command,
                                            const std::string& transport);

}  // namespace volcomp::sim
