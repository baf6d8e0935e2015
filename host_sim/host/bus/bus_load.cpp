#include "host_sim/host/bus/bus_load.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "hal/loopback/frame_bits.hpp"

namespace volcomp::host {
namespace {

// Data bytes, as architecture and default mappings have them.
constexpr std::size_t kSyncBytes = 1;
constexpr std::array<std::size_t, 4> kAxisBytes{6, 8, 4, 4};  // RPDO1, TPDO1, TPDO4, RPDO2
constexpr std::size_t kHeartbeatBytes = 1;
constexpr std::size_t kStatusBytes = 8;
constexpr double kHeartbeats_hz = 10.0;
constexpr double kStatus_hz = 10.0;

template <class FrameBits>
double load(std::size_t axes, double cycle_hz, FrameBits bits) {
  std::uint32_t per_axis = 0;
  for (const std::size_t bytes : kAxisBytes)
    per_axis += bits(bytes);
  const auto count = static_cast<double>(axes);
  const double cycle = bits(kSyncBytes) + count * per_axis;
  const double nodes = count + 2.0;  // drives, controller, compensation node
  const double background =
      kHeartbeats_hz * nodes * bits(kHeartbeatBytes) + kStatus_hz * bits(kStatusBytes);
  return (cycle_hz * cycle + background) / kBitRate;
}

std::string verdict(const BusLoadRow& row) {
  if (!row.fits()) return "does not fit";
  if (!row.always_fits()) return "fits only by luck of the contents";
  if (!row.measured) return "fits";
  return row.measured->in_time() ? "fits, every cycle in time"
                                 : fmt::format("{} of {} cycles late",
                                               row.measured->deadline_missed, row.measured->cycles);
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

}  // namespace

ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz) {
  return {load(axes, cycle_hz, hal::nominal_frame_bits),
          load(axes, cycle_hz, hal::worst_case_frame_bits)};
}

std::vector<BusLoadRow> bus_load_table(const std::vector<std::size_t>& axes,
                                       const MeasureLoads& measure) {
  constexpr std::size_t kMeasuredAxes = 3;
  std::vector<BusLoadRow> table;
  std::vector<double> rates;
  for (const std::size_t count : axes) {
    for (const double rate : kBusLoadRates_hz) {
      table.push_back({count, rate, compute_bus_load(count, rate), {}});
      if (count == kMeasuredAxes && table.back().always_fits()) rates.push_back(rate);
    }
  }
  const std::vector<MeasuredLoad> measured = measure(rates);
  auto next = measured.begin();
  for (BusLoadRow& row : table) {
    if (row.axes == kMeasuredAxes && row.always_fits()) row.measured = *next++;
  }
  return table;
}

std::string describe(const std::vector<BusLoadRow>& table) {
  std::string text = fmt::format(
      "load of a bus with 1 Mbit/s; offsets: from SYNC to the last offset of the cycle, worst\n\n"
      "{:>4} {:>8} {:>9} {:>11} {:>10} {:>11} {:>11}\n",
      "axes", "cycle", "computed", "worst case", "measured", "offsets", "deadline");
  for (const BusLoadRow& row : table) {
    text +=
        fmt::format("{:>4} {:>5.0f} Hz {:>9} {:>11} {:>10} {:>11} {:>11}  {}\n", row.axes,
                    row.cycle_hz, percent(row.computed.nominal), percent(row.computed.worst),
                    row.measured ? percent(row.measured->average) : "-",
                    row.measured ? fmt::format("{:.0f} us", row.measured->worst_offset_us) : "-",
                    fmt::format("{:.0f} us", 0.6e6 / row.cycle_hz), verdict(row));
  }
  return text +
         "\ncomputed: without stuff bits; measured: with those the simulated machine needs\n"
         "in time: the node had all of a cycle before the deadline, 60 % of the period after "
         "SYNC\n";
}

nlohmann::json to_json(const std::vector<BusLoadRow>& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (const BusLoadRow& row : table) {
    nlohmann::json j{{"axes", row.axes},
                     {"cycle_hz", row.cycle_hz},
                     {"computed_load", row.computed.nominal},
                     {"computed_worst_load", row.computed.worst},
                     {"deadline_us", 0.6e6 / row.cycle_hz},
                     {"fits", row.always_fits()},
                     {"verdict", verdict(row)}};
    if (row.measured) {
      j["measured_load"] = row.measured->average;
      j["measured_worst_offset_us"] = row.measured->worst_offset_us;
      j["measured_cycles"] = row.measured->cycles;
      j["measured_deadline_missed"] = row.measured->deadline_missed;
    }
    rows.push_back(j);
  }
  return rows;
}

}  // namespace volcomp::host
