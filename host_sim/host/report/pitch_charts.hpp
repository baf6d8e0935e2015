#pragma once
// Pitch of all slots of a gear, of one side of its teeth.

#include <string>
#include <vector>

#include "host_sim/host/report/charts.hpp"

namespace volcomp::host {

struct PitchCurve {
  const char* name;              // "before"
  std::vector<double> position;  // of every slot, µm along the pitch circle
  bool dashed = false;
};

// Single pitches as bars, and the positions as curves: F_p is the height of one. `side`: "left".
[[nodiscard]] nlohmann::json single_pitch_chart(const char* side,
                                                const std::vector<PitchCurve>& curves,
                                                const std::string& note);
[[nodiscard]] nlohmann::json cumulative_pitch_chart(const char* side,
                                                    const std::vector<PitchCurve>& curves);

}  // namespace volcomp::host
