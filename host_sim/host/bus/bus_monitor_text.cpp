// The state of a bus as text for people and for programs.

#include <fmt/format.h>

#include "host_sim/host/bus/bus_monitor.hpp"
#include "host_sim/host/bus/device_files/signal_names.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr double kNmPerUm = 1e3;

std::string state_words(const StationSeen& s) {
  if (!s.state) return "no heartbeat";
  std::string text;
  for (const auto& [number, name] : nmt_states()) {
    if (number == static_cast<unsigned>(*s.state)) text = name;
  }
  if (text.empty()) text = fmt::format("state {}", static_cast<unsigned>(*s.state));
  return s.silent ? "SILENT, was " + text : text;
}

std::string offset_words(const AxisSeen& a) {
  if (!a.offset) return "no offset";
  return a.unit == "nm" ? fmt::format("offset {:+.3f} µm", *a.offset / kNmPerUm)
                        : fmt::format("offset {:+.7f} deg", *a.offset);
}

// Positions in mm or deg, offsets in um or deg.
json axis_row(const AxisSeen& a) {
  const bool linear = a.unit == "nm";
  const auto scaled = [&](const std::optional<double>& value, double factor) {
    return value ? json(linear ? factor * *value : *value) : json();
  };
  return {std::string(1, a.letter),
          scaled(a.target, 1e-6),
          scaled(a.actual, 1e-6),
          linear ? "mm" : "deg",
          offset_words(a),
          a.status_word ? json(describe_drive(*a.status_word)) : json(),
          a.edges ? json(*a.edges) : json(),
          a.lost,
          a.drive,
          linear ? "um" : "deg",
          scaled(a.offset, 1e-3),
          a.status_word ? json(*a.status_word) : json()};
}

json axis_table(const BusSnapshot& s) {
  json rows = json::array();
  for (const AxisSeen& axis : s.axes)
    rows.push_back(axis_row(axis));
  return table_section(
      "",
      {plain_column("axis", "axis"), column("target", "", 6, "target"),
       column("actual", "", 6, "actual"), plain_column("", "unit"), plain_column(""),
       plain_column("drive", "status"), plain_column("probe edges", "probe_edges"),
       plain_column("cycles incomplete", "cycles_incomplete"), hidden_column("drive"),
       hidden_column("offset_unit"), hidden_column("offset"), hidden_column("status_word")},
      rows);
}

}  // namespace

std::string describe(const BusSnapshot& s) {
  std::string text = fmt::format("{:.1f} s: {} frames in {:.2f} s, bus load {:.1f} %", s.time_s,
                                 s.frames, s.period_s, 100.0 * s.load);
  if (s.sync.count != 0) {
    text += fmt::format(", SYNC every {:.3f} ms ({:.3f} to {:.3f}), {} lost", 1e-3 * s.sync.mean_us,
                        1e-3 * s.sync.least_us, 1e-3 * s.sync.most_us, s.sync.lost);
  } else {
    text += ", no SYNC";
  }
  text += "\n";
  if (s.stations.empty()) text += "  nobody sends a heartbeat\n";
  for (const StationSeen& station : s.stations)
    text += fmt::format("  {} (id {}): {}\n", station.name, station.id, state_words(station));
  if (s.node) {
    text += s.node->active_crc == 0
                ? fmt::format("  compensation: {}\n", s.node->state)
                : fmt::format("  compensation: {}, tables CRC-32 {:08X}; {}\n", s.node->state,
                              s.node->active_crc, describe_status(s.node->status));
  }
  text += text_of_section(axis_table(s));
  if (s.emergency_count > s.emergencies.size())
    text += fmt::format("  {} emergencies, the last:\n", s.emergency_count);
  for (const EmergencySeen& e : s.emergencies)
    text += fmt::format("  EMCY at {:.3f} s, {}: {}\n", e.time_s, e.who, e.text);
  return text;
}

json to_json(const BusSnapshot& s) {
  json stations = json::array();
  for (const StationSeen& station : s.stations) {
    stations.push_back({{"name", station.name},
                        {"id", station.id},
                        {"state", state_words(station)},
                        {"silent", station.silent},
                        {"frames", station.frames}});
  }
  json emergencies = json::array();
  for (const EmergencySeen& e : s.emergencies)
    emergencies.push_back({{"time_s", e.time_s}, {"who", e.who}, {"text", e.text}});
  json node;
  if (s.node) {
    node = {{"state", s.node->state},
            {"active_crc", fmt::format("{:08X}", s.node->active_crc)},
            {"status", s.node->status},
            {"status_text", describe_status(s.node->status)}};
  }
  const bool synced = s.sync.count != 0;
  return {{"time_s", s.time_s},
          {"period_s", s.period_s},
          {"frames", s.frames},
          {"load_percent", 100.0 * s.load},
          {"sync",
           {{"count", s.sync.count},
            {"lost", s.sync.lost},
            {"mean_us", synced ? json(s.sync.mean_us) : json()},
            {"least_us", synced ? json(s.sync.least_us) : json()},
            {"most_us", synced ? json(s.sync.most_us) : json()}}},
          {"stations", stations},
          {"node", node},
          {"axes", figures_of_table(axis_table(s))},
          {"emergencies", emergencies},
          {"emergency_count", s.emergency_count}};
}

}  // namespace volcomp::host
