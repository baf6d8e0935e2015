#pragma once
// What the monitor reports of the two signals that C has tables for, before and after
// (docs/papers/internal-helical.md, "What we do").

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/experiments/internal_helical/scenario.hpp"

namespace volcomp::internal_helical {

// Half the range on the flank, how much of it comes back, and whether it is worth a table. A node
// reports only the mean of every place: how much comes back is unknown then.
struct SignalReport {
  const char* name = "";
  double amplitude_um = 0.0;
  bool knows_repeats = false;  // else the two below are unset
  double ratio = 0.0;
  LearningVerdict verdict = LearningVerdict::too_small;
};
[[nodiscard]] std::vector<SignalReport> signal_reports(const InternalHelicalResult& run,
                                                       const MonitorView& view);

// Before and after.
[[nodiscard]] nlohmann::json signal_figures(const InternalHelicalResult& run);
// One line each.
[[nodiscard]] std::vector<std::string> signal_lines(const InternalHelicalResult& run);

}  // namespace volcomp::internal_helical
