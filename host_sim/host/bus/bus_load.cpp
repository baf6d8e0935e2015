#include "host_sim/host/bus/bus_load.hpp"

#include <array>

#include "hal/loopback/frame_bits.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

// Data bytes, as architecture and default mappings have them.
constexpr std::size_t kSyncBytes = 1;
constexpr std::array<std::size_t, 4> kAxisBytes{6, 8, 4, 4};  // RPDO1, TPDO1, TPDO4, RPDO2
constexpr std::size_t kHeartbeatBytes = 1;
constexpr std::size_t kStatusBytes = 8;
constexpr double kHeartbeats_hz = 10.0;
constexpr double kStatus_hz = 10.0;

constexpr std::array<double, 4> kRates_hz{125.0, 250.0, 500.0, 1000.0};
constexpr double kDeadline = 0.6;  // of the period: by then the node needs all of a cycle

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

const char* verdict(const ComputedLoad& computed) {
  if (computed.nominal >= 1.0) return "does not fit";
  return computed.worst >= 1.0 ? "fits only by luck of the contents" : "fits";
}

}  // namespace

ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz) {
  return {load(axes, cycle_hz, hal::nominal_frame_bits),
          load(axes, cycle_hz, hal::worst_case_frame_bits)};
}

nlohmann::json bus_load_document(const std::vector<std::size_t>& axes) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::size_t count : axes) {
    for (const double rate : kRates_hz) {
      const ComputedLoad load = compute_bus_load(count, rate);
      rows.push_back({count, rate, load.nominal, load.worst, 100.0 * load.nominal,
                      100.0 * load.worst, kDeadline * 1e6 / rate, load.worst < 1.0, verdict(load)});
    }
  }
  nlohmann::json table =
      table_section("",
                    {plain_column("axes", "axes"), column("cycle", "Hz", 0, "cycle_hz"),
                     hidden_column("computed_load"), hidden_column("computed_worst_load"),
                     column("computed", "%", 1), column("worst case", "%", 1),
                     column("deadline", "us", 0, "deadline_us"), hidden_column("fits"),
                     plain_column("", "verdict")},
                    rows);
  table["name"] = "loads";
  table["note"] = "computed: without stuff bits; deadline: 60 % of the period after SYNC";
  return {{"sections", {text_section("", {"load of a bus with 1 Mbit/s"}), table}}};
}

}  // namespace volcomp::host
