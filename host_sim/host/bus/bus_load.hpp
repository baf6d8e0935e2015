#pragma once
// How much of a 1 Mbit/s bus the compensation takes, computed from the frames of a cycle.

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

namespace volcomp::host {

inline constexpr double kBitRate = 1e6;

// Shares of the bus, 1 = all of it.
struct ComputedLoad {
  double nominal = 0.0;  // without stuff bits
  double worst = 0.0;    // the most stuff bits frames of these sizes can have
};

// Per cycle SYNC and, for each axis, RPDO1, TPDO1 and TPDO4 of the drive and its RPDO2; per second
// ten heartbeats of every node and ten status PDOs of the compensation node.
[[nodiscard]] ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz);

// The usual rates for each of these numbers of axes; a document of host_sim/host/report with the
// figures "loads".
[[nodiscard]] nlohmann::json bus_load_document(const std::vector<std::size_t>& axes);

}  // namespace volcomp::host
