#pragma once
// What a run on the YK7280 has found, as numbers and as text.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/host/report/progress.hpp"

namespace volcomp::face_gear {

// A statement of the paper about its Tables 5 to 8, beside what the tables show
// (docs/papers/face-gear.md, "How to reproduce"); µm.
struct PaperStatement {
  const char* key;
  const char* what;
  double stated;
  double found;
};
[[nodiscard]] std::vector<PaperStatement> paper_statements();

// Of all inspections.
[[nodiscard]] NodeAgreement agreement_of(const FaceGearResult& run);

// The worst profile of an inspection, µm; none: cells of a map are missing.
[[nodiscard]] std::optional<double> worst_profile(const FaceInspection& inspection);

// Instruments of a run and how far they scatter, in a sentence or two.
[[nodiscard]] std::string scatter_text(const FaceGearOptions& options);
inline constexpr const char* kChosenText =
    "chain and strokes of the machine, its positioning and angles; straightness, run-out and "
    "directions of its axes are within the limits published";

// What an agreement with the gear has to reach, µm: what frame, scales and tables leave without
// scatter, and what the scatter of the touches adds.
struct FaceLimits {
  double scatter = 0.0;  // of a map, rms: what is added quadratically to what may be left else
  double map = 0.0;      // rms
  double pitch = 0.0;    // of F_p
};
[[nodiscard]] FaceLimits limits_of(const FaceGearResult& run);

// The worst profile of an inspection as a grade, or why there is none.
[[nodiscard]] std::string grade_text(const FaceInspection& inspection);

// Good: the node judges as this computer does, and maps and F_p of the compensated machine are
// within limits_of(); the maps no further from the gear than before.
[[nodiscard]] host::Verdict face_gear_verdict(const FaceGearResult& run);
[[nodiscard]] nlohmann::json face_gear_figures(const FaceGearResult& run);

}  // namespace volcomp::face_gear
