#pragma once
// How much of a 1 Mbit/s bus the compensation takes, computed from the frames of a cycle, and how
// long the node may take in it.

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/bus_cycle.hpp"

namespace volcomp::host {

// Shares of the bus, 1 = all of it.
struct ComputedLoad {
  double nominal = 0.0;  // without stuff bits
  double worst = 0.0;    // the most stuff bits frames of these sizes can have
};

// Per cycle the frames of bits_of_cycle(); per second ten heartbeats of every node and, where it is
// not in every cycle, ten status PDOs of the compensation node.
[[nodiscard]] ComputedLoad compute_bus_load(const CycleAxes& axes, double cycle_hz);
// Of so many axes that take confirmed offsets: SYNC and, for each, RPDO1, TPDO1 and TPDO4 of the
// drive and its RPDO2.
[[nodiscard]] ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz);

// The usual rates and the largest one for each of these machines; a document of
// host_sim/host/report with the figures "loads".
[[nodiscard]] nlohmann::json bus_load_document(const std::vector<CycleAxes>& machines);

}  // namespace volcomp::host
