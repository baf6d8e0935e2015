#pragma once
// What a run on the grinder has found, as numbers and as text.

#include <string>

#include <nlohmann/json.hpp>

#include "comp/metrology/gears/gear_grade.hpp"
#include "host_sim/experiments/internal_helical/scenario.hpp"

namespace volcomp::internal_helical {

// Over the seeds.
struct Spread {
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
};

// A deviation of the gear before or after: found here, in an independent simulation of the same
// grinder (16 seeds), and in the paper.
struct HelicalMeasure {
  const char* name = "";  // "Fp", "fp", "Fa"
  const char* side = "";  // "left", "right"; empty for F_α
  bool after = false;
  GearDeviation kind = GearDeviation::total_pitch;
  Spread found;                                   // µm
  EvaluationRange specified;                      // its lowest and highest of 16 seeds, µm
  double paper = 0.0;                             // µm
  bool same_gear = true;                          // as theirs; else the two before do not apply
  [[nodiscard]] EvaluationRange allowed() const;  // for the median
  [[nodiscard]] bool ok() const;
};
[[nodiscard]] std::vector<HelicalMeasure> helical_measures(const InternalHelicalResult& run);

// Z and C out of step on the flank, rms, µm; largest error of Z, mm.
[[nodiscard]] Spread sync_spread(const InternalHelicalResult& run, bool after);
[[nodiscard]] Spread z_peak_spread(const InternalHelicalResult& run, bool after);
// Median over the seeds, round by round.
[[nodiscard]] std::vector<double> learning_curve(const InternalHelicalResult& run);

// What a wrong way must show to count as wrong.
struct WrongWay {
  const char* what = "";
  double threshold = 0.0;  // µm
  double found = 0.0;      // median, µm
  [[nodiscard]] bool beyond() const { return found > threshold; }
};
[[nodiscard]] WrongWay wrong_way(const InternalHelicalResult& run);

[[nodiscard]] GearGrade helical_grade(const host::GrindingFile& job, const HelicalMeasure& measure,
                                      GearStandard standard);

// Wheel and lags: those of the gear, whatever the seeds.
[[nodiscard]] nlohmann::json geometry_figures(const InternalHelicalResult& run);

[[nodiscard]] host::Verdict internal_helical_verdict(const InternalHelicalResult& run);
// `tables`: names of the files that were written.
[[nodiscard]] nlohmann::json internal_helical_figures(const InternalHelicalResult& run,
                                                      const std::vector<std::string>& tables);

}  // namespace volcomp::internal_helical
