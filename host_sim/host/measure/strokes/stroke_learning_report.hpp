#pragma once
// What was learned from a log, as text, as JSON and as a page.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/strokes/stroke_learning.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host {

[[nodiscard]] std::string learned_text(const StrokesLearned& learned);
[[nodiscard]] nlohmann::json learned_json(const StrokesLearned& learned);
[[nodiscard]] nlohmann::json learned_document(const StrokesLearned& learned, const RunContext& run,
                                              Origins origins);

}  // namespace volcomp::host
