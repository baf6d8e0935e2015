#pragma once
// How much of a 1 Mbit/s bus the compensation takes: computed from the frames of a cycle, and
// measured on the simulated machine.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace volcomp::host {

inline constexpr double kBitRate = 1e6;
inline constexpr std::array<double, 4> kBusLoadRates_hz{125.0, 250.0, 500.0, 1000.0};

// Shares of the bus, 1 = all of it.
struct ComputedLoad {
  double nominal = 0.0;  // without stuff bits
  double worst = 0.0;    // the most stuff bits frames of these sizes can have
};

// Per cycle SYNC and, for each axis, RPDO1, TPDO1 and TPDO4 of the drive and its RPDO2; per second
// ten heartbeats of every node and ten status PDOs of the compensation node.
[[nodiscard]] ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz);

struct MeasuredLoad {
  double average = 0.0;          // share of the bus, with the stuff bits there were
  double worst_offset_us = 0.0;  // from the end of SYNC to the end of the last offset
  std::uint64_t cycles = 0;
  std::uint64_t deadline_missed = 0;  // cycles in which the node lacked something at 60 %

  [[nodiscard]] bool in_time() const { return deadline_missed == 0; }
};

// Loads at these rates.
using MeasureLoads = std::function<std::vector<MeasuredLoad>(const std::vector<double>& cycle_hz)>;

struct BusLoadRow {
  std::size_t axes = 0;
  double cycle_hz = 0.0;
  ComputedLoad computed;
  std::optional<MeasuredLoad> measured;

  // Even without stuff bits there must be room.
  [[nodiscard]] bool fits() const { return computed.nominal < 1.0; }
  // Whatever the frames hold.
  [[nodiscard]] bool always_fits() const { return computed.worst < 1.0; }
};

// Every rate for these numbers of axes; measured for three axes where there is always room.
[[nodiscard]] std::vector<BusLoadRow> bus_load_table(const std::vector<std::size_t>& axes,
                                                     const MeasureLoads& measure);

[[nodiscard]] std::string describe(const std::vector<BusLoadRow>& table);
[[nodiscard]] nlohmann::json to_json(const std::vector<BusLoadRow>& table);

}  // namespace volcomp::host
