#pragma once
// The report of a run on the YK7280: tooth topography, error maps, pitch, and what was assumed.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::face_gear {

// The document of a report.
[[nodiscard]] nlohmann::json face_gear_document(const FaceGearResult& result,
                                                const host::RunContext& run);
// The same for a terminal.
[[nodiscard]] std::string face_gear_summary(const FaceGearResult& result);

}  // namespace volcomp::face_gear
