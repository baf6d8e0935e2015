#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/l300g/scenario.hpp"
#include "host_sim/scenarios/report/document.hpp"

namespace volcomp::sim {

// A run as a report document (host_sim/report/README.md).
[[nodiscard]] nlohmann::json l300g_document(const L300gResult& result, const RunContext& run);

}  // namespace volcomp::sim
