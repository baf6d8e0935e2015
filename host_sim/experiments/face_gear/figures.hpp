#pragma once
// What a run on the YK7280 has found, as numbers and as text.

#include <string>

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

// The worst profile of an inspection as a grade, or why there is none.
[[nodiscard]] std::string grade_text(const FaceInspection& inspection);

[[nodiscard]] host::Verdict face_gear_verdict(const FaceGearResult& run);
[[nodiscard]] nlohmann::json face_gear_figures(const FaceGearResult& run);

}  // namespace volcomp::face_gear
