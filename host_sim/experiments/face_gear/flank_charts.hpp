#pragma once
// Charts of face-gear flanks for reports: topography, error maps, pitch.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/face_gear/scenario.hpp"

namespace volcomp::face_gear {

// Both flanks of the first slot that was mapped, side by side: the grid as it lies on the flank,
// its rows displaced by their deviations.
[[nodiscard]] nlohmann::json topography(const FaceGearResult& run, FaceStage stage);
// Heat maps of the same flanks.
[[nodiscard]] nlohmann::json flank_maps(const FaceGearResult& run, FaceStage stage);
// Single pitches as bars, one chart for each side, and the cumulative curves of all stages.
[[nodiscard]] nlohmann::json single_pitch_bars(const FaceGearResult& run, std::size_t side);
[[nodiscard]] nlohmann::json pitch_curves(const FaceGearResult& run);

}  // namespace volcomp::face_gear
