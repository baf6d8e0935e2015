#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/machine/scenario.hpp"
#include "host_sim/scenarios/report/document.hpp"

namespace volcomp::sim {

// A run as a report document (host_sim/report/README.md).
[[nodiscard]] nlohmann::json machine_document(const MachineResult& result, const RunContext& run);

}  // namespace volcomp::sim
