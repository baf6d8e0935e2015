#pragma once
// Tick statistics as tables: what the compensation did on each axis, and what passed over the bus.

#include <nlohmann/json.hpp>

#include "host_sim/sim/controller/tick_statistics.hpp"

namespace volcomp::sim {

[[nodiscard]] nlohmann::json tick_tables(const TickStatistics& ticks);

}  // namespace volcomp::sim
