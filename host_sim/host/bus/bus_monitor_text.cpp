// The state of a bus as text for people and for programs.

#include <fmt/format.h>

#include "host_sim/host/bus/bus_monitor.hpp"
#include "host_sim/host/bus/device_files/signal_names.hpp"
#include "host_sim/host/bus/diagnosis.hpp"

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

// Millimetres or degrees.
std::string position(const std::optional<double>& value, const std::string& unit) {
  if (!value) return fmt::format("{:>13}", "?");
  return unit == "nm" ? fmt::format("{:10.6f} mm", 1e-6 * *value)
                      : fmt::format("{:9.6f} deg", *value);
}

std::string offset_words(const AxisSeen& a) {
  if (!a.offset) return "no offset";
  return a.unit == "nm" ? fmt::format("offset {:+.3f} µm", *a.offset / kNmPerUm)
                        : fmt::format("offset {:+.7f} deg", *a.offset);
}

std::string axis_line(const AxisSeen& a) {
  std::string text =
      fmt::format("  {}  target {}  actual {}  {}", a.letter, position(a.target, a.unit),
                  position(a.actual, a.unit), offset_words(a));
  if (a.status_word) text += fmt::format("  {}", describe_drive(*a.status_word));
  if (a.edges) text += fmt::format("  {} probe edges", *a.edges);
  if (a.lost != 0) text += fmt::format("  {} cycles incomplete", a.lost);
  return text + "\n";
}

// Positions in mm or deg, offsets in um or deg.
json axis_json(const AxisSeen& a) {
  const bool linear = a.unit == "nm";
  const auto scaled = [&](const std::optional<double>& value, double factor) {
    return value ? json(linear ? factor * *value : *value) : json();
  };
  json j{{"axis", std::string(1, a.letter)},
         {"drive", a.drive},
         {"unit", linear ? "mm" : "deg"},
         {"target", scaled(a.target, 1e-6)},
         {"actual", scaled(a.actual, 1e-6)},
         {"offset_unit", linear ? "um" : "deg"},
         {"offset", scaled(a.offset, 1e-3)},
         {"status_word", a.status_word ? json(*a.status_word) : json()},
         {"cycles_incomplete", a.lost}};
  j["status"] = a.status_word ? json(describe_drive(*a.status_word)) : json();
  j["probe_edges"] = a.edges ? json(*a.edges) : json();
  return j;
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
  for (const AxisSeen& axis : s.axes)
    text += axis_line(axis);
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
  json axes = json::array();
  for (const AxisSeen& axis : s.axes)
    axes.push_back(axis_json(axis));
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
          {"axes", axes},
          {"emergencies", emergencies},
          {"emergency_count", s.emergency_count}};
}

}  // namespace volcomp::host
