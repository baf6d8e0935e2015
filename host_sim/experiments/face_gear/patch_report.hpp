#pragma once
// What the patch and the searches of the paper do against the closed flank, as text, report and
// figures.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/experiments/face_gear/patch_comparison.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::face_gear {

[[nodiscard]] std::string patch_summary(const PatchComparison& comparison);
// The document of a report, with maps of the patch's error and the course of the searches.
[[nodiscard]] nlohmann::json patch_document(const PatchComparison& comparison,
                                            const host::RunContext& run);
[[nodiscard]] nlohmann::json patch_figures(const PatchComparison& comparison);

}  // namespace volcomp::face_gear
