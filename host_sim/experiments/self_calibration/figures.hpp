#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/self_calibration/scenario.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::self_calibration {

// Chi-square over its degrees of freedom.
[[nodiscard]] double misfit(const Result& result);

// Figures under the names that docs/identification.md documents.
[[nodiscard]] nlohmann::json figures(const Result& result);

// Volume, diagonals and sphere, µm.
[[nodiscard]] std::vector<host::BeforeAfter> judged_figures(const Result& result);

// What 95 % of the volume keep is within this share of the prediction, the worst place is at a
// quarter of what it was, and the readings fit together.
inline constexpr double kOfPrediction = 1.5;
inline constexpr double kOfBefore = 0.25;
inline constexpr double kChiSquareOfDof = 1.5;
[[nodiscard]] host::Verdict verdict(const Result& result);

}  // namespace volcomp::self_calibration
