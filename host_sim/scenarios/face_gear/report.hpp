#pragma once
// The report of a run on the YK7280: tooth topography, error maps, pitch, and what was assumed.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/face_gear/scenario.hpp"

namespace volcomp::sim {

// A document for write_report.
[[nodiscard]] nlohmann::json face_gear_document(const FaceGearResult& run,
                                                const std::string& command,
                                                const std::string& transport);

}  // namespace volcomp::sim
