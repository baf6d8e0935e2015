#pragma once
// What the monitor says of the two signals that C has tables for, before and after. Seed 003
// section 8.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/scenarios/internal_helical/scenario.hpp"

namespace volcomp::sim {

// Half the range on the flank, how much of it comes back, and whether it is worth a table.
struct SignalReport {
  const char* name = "";
  double amplitude_um = 0.0;
  double ratio = 0.0;
  LearningVerdict verdict = LearningVerdict::too_small;
};
[[nodiscard]] std::vector<SignalReport> signal_reports(const InternalHelicalResult& run,
                                                       const MonitorView& view);

[[nodiscard]] nlohmann::json signal_figures(const InternalHelicalResult& run,
                                            const MonitorView& view);
// One line each.
[[nodiscard]] std::string signal_lines(const InternalHelicalResult& run);

}  // namespace volcomp::sim
