#pragma once
// The uncertainty of a task drawn: along its places, and by what it comes from.

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/whole_way/whole_way_report.hpp"

namespace volcomp::host {

// A chart of the errors with their limits, and one of both standard uncertainties.
[[nodiscard]] nlohmann::json task_charts(const WholeWayQuestion& q, const TaskUncertainty& u);
[[nodiscard]] nlohmann::json share_bars(const TaskUncertainty& u);

}  // namespace volcomp::host
