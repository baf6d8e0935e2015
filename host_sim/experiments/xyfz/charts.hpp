#pragma once
// Charts of the report on the XYFZ machine (host_sim/host/report/page/README.md).

#include <nlohmann/json.hpp>

#include "host_sim/experiments/xyfz/scenario.hpp"

namespace volcomp::xyfz {

// For people, as kModeNames is for programs.
inline constexpr std::array<const char*, 4> kModeTitles{
    "uncompensated", "naive model", "Abbe model as in the paper", "Abbe model, squareness closed"};

[[nodiscard]] nlohmann::json diagonal_charts(const XyfzResult& r, bool faces);
[[nodiscard]] nlohmann::json volume_chart(const XyfzResult& r);
[[nodiscard]] nlohmann::json positioning_charts(const XyfzResult& r);
[[nodiscard]] nlohmann::json error_function_charts(const XyfzResult& r);

// Lists of sections: of the noisy campaigns, empty where there was none, and of the motions.
[[nodiscard]] nlohmann::json draws_sections(const XyfzResult& r);
[[nodiscard]] nlohmann::json dynamics_sections(const XyfzResult& r);

}  // namespace volcomp::xyfz
