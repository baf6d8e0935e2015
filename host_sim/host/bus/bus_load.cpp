#include "host_sim/host/bus/bus_load.hpp"

#include <array>
#include <cmath>
#include <set>
#include <string>

#include <fmt/format.h>

#include "hal/loopback/frame_bits.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kHeartbeatBytes = 1;
constexpr std::size_t kNodeStatusBytes = 8;
constexpr double kHeartbeats_hz = 10.0;
constexpr double kStatus_hz = 10.0;

constexpr std::array<double, 4> kUsualRates_hz{125.0, 250.0, 500.0, 1000.0};

template <class FrameBits>
double load(const CycleAxes& axes, double cycle_bits, double cycle_hz, FrameBits bits) {
  const double nodes = static_cast<double>(axes.size()) + 2.0;  // drives, controller, node
  double background = kHeartbeats_hz * nodes * bits(kHeartbeatBytes);
  if (!needs_status(axes)) background += kStatus_hz * bits(kNodeStatusBytes);
  return (cycle_hz * cycle_bits + background) / kBitRate;
}

const char* verdict(const CycleAxes& axes, const ComputedLoad& computed,
                    const LatencyBudget& budget) {
  if (computed.nominal >= 1.0) return "does not fit";
  if (computed.worst >= 1.0) return "fits only by luck of the contents";
  if (!forwards_targets(axes)) return "fits";
  if (budget.usual <= 0) return "no time for forwarded targets";
  return budget.after_deadline <= 0 ? "no time after a deadline" : "fits";
}

// "1 1 0", 0u: not confirmed.
std::string ways_of(const CycleAxes& axes) {
  std::string ways;
  for (const CycleAxis& axis : axes) {
    const bool unconfirmed = axis.way == node::Way::offset && !axis.confirmed;
    ways += fmt::format("{}{}{}", ways.empty() ? "" : " ", static_cast<unsigned>(axis.way),
                        unconfirmed ? "u" : "");
  }
  return ways;
}

nlohmann::json row_of(const CycleAxes& axes, double rate_hz, double largest_hz) {
  const ComputedLoad load = compute_bus_load(axes, rate_hz);
  const auto period_us = static_cast<std::uint32_t>(std::lround(1e6 / rate_hz));
  const LatencyBudget budget = latency_budget(axes, {period_us, 0, 0});
  return {axes.size(),        ways_of(axes),    rate_hz,
          load.nominal,       load.worst,       100.0 * load.nominal,
          100.0 * load.worst, largest_hz,       budget.last_target,
          budget.usual,       budget.with_edge, budget.after_deadline,
          budget.deadline,    load.worst < 1.0, verdict(axes, load, budget)};
}

nlohmann::json columns() {
  return {plain_column("axes", "axes"),
          plain_column("ways", "ways"),
          column("cycle", "Hz", 0, "cycle_hz"),
          hidden_column("computed_load"),
          hidden_column("computed_worst_load"),
          column("computed", "%", 1),
          column("worst case", "%", 1),
          hidden_column("largest_hz"),
          hidden_column("last_target_us"),
          column("L", "us", 0, "latency_us"),
          column("L, edges", "us", 0, "latency_with_edge_us"),
          column("L, late", "us", 0, "latency_after_deadline_us"),
          column("deadline", "us", 0, "deadline_us"),
          hidden_column("fits"),
          plain_column("", "verdict")};
}

}  // namespace

ComputedLoad compute_bus_load(const CycleAxes& axes, double cycle_hz) {
  const CycleBits bits = bits_of_cycle(axes, needs_status(axes));
  return {load(axes, bits.nominal, cycle_hz, hal::nominal_frame_bits),
          load(axes, bits.worst, cycle_hz, hal::worst_case_frame_bits)};
}

ComputedLoad compute_bus_load(std::size_t axes, double cycle_hz) {
  return compute_bus_load(CycleAxes(axes), cycle_hz);
}

nlohmann::json bus_load_document(const std::vector<CycleAxes>& machines) {
  nlohmann::json rows = nlohmann::json::array();
  for (const CycleAxes& axes : machines) {
    const double largest_hz = std::floor(largest_rate_hz(axes, needs_status(axes)));
    std::set<double> rates_hz(kUsualRates_hz.begin(), kUsualRates_hz.end());
    rates_hz.insert(largest_hz);
    for (const double rate_hz : rates_hz)
      rows.push_back(row_of(axes, rate_hz, largest_hz));
  }
  std::vector<std::string> largest;
  largest.reserve(machines.size());
  for (const CycleAxes& axes : machines)
    largest.push_back(fmt::format("{} axes, ways {}: at most {:.0f} Hz, with 70 % of the bus taken",
                                  axes.size(), ways_of(axes),
                                  std::floor(largest_rate_hz(axes, needs_status(axes)))));
  nlohmann::json table = table_section("", columns(), rows);
  table["name"] = "loads";
  table["note"] =
      "computed: without stuff bits; deadline: 60 % of the period after SYNC; L: how long the node "
      "may take (2620h:05), with edges of a probe, and after the deadline";
  return {{"sections",
           {text_section("", {"load of a bus with 1 Mbit/s"}), table, text_section("", largest)}}};
}

}  // namespace volcomp::host
