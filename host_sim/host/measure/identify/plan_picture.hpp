#pragma once
// A measurement plan in three dimensions: where its tips and instruments stand in the work frame.

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

// A chart of type `places`: a series for each set-up, one of stations and sockets, one of spheres
// that nothing touches; the travel of the functional point as box.
[[nodiscard]] nlohmann::json plan_picture(const MeasurementPlan& plan);

}  // namespace volcomp::host::identify
