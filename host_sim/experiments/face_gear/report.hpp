#pragma once
// The report of a run on the YK7280: tooth topography, error maps, pitch, and what was assumed.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::sim {

// The document of a report.
[[nodiscard]] nlohmann::json face_gear_document(const FaceGearResult& result,
                                                const RunContext& run);

}  // namespace volcomp::sim
