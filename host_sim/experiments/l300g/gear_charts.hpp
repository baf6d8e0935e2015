#pragma once
// The master gear in the layout of gear inspection: left and right flank side by side, traces
// upright, values below each.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/l300g/scenario.hpp"

namespace volcomp::l300g {

// Groups of charts for profile, lead and pitch.
[[nodiscard]] nlohmann::json profile_charts(const L300gResult& result);
[[nodiscard]] nlohmann::json lead_charts(const L300gResult& result);
[[nodiscard]] nlohmann::json pitch_charts(const L300gResult& result);

// All values with the grades of both editions.
[[nodiscard]] nlohmann::json gear_table(const L300gResult& result);

}  // namespace volcomp::l300g
