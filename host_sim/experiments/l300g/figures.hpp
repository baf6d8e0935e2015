#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/l300g/scenario.hpp"

namespace volcomp::l300g {

// The figures of a run under the names the README documents: probe in mm, deviations in µm.
[[nodiscard]] nlohmann::json l300g_figures(const L300gResult& result);

// Passes when the compensated machine finds the gear as it is, whatever it found before.
[[nodiscard]] host::Verdict l300g_verdict(const L300gResult& result);

// "8", or ">12".
[[nodiscard]] std::string grade_text(const std::optional<int>& grade, GearStandard standard);

}  // namespace volcomp::l300g
