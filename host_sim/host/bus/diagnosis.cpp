#include "host_sim/host/bus/diagnosis.hpp"

#include <fmt/format.h>

#include "comp/tick/status_text.hpp"
#include "firmware/node/store/storage.hpp"
#include "firmware/node/wire_scale.hpp"
#include "host_sim/host/bus/latency_diagnosis.hpp"
#include "host_sim/host/bus/stroke_diagnosis.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/bus/thermal_diagnosis.hpp"
#include "host_sim/host/report/json_format.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;
using canopen::NmtState;
using nlohmann::json;
using node::StoreResult;

// 2^40 (positions) and 2^32 (offsets, limits) units per turn of a rotary axis.
constexpr double kMicroradPerTurn = 2e6 * 3.14159265358979323846;
constexpr double kPositionUnitsPerTurn = 1099511627776.0;
constexpr double kOffsetUnitsPerTurn = 4294967296.0;
constexpr double kUmPerNm = 1e-3;

// By NodeState.
constexpr std::array kNodeStates{
#define NODE_STATE(number, name, title, words) words,
#include "firmware/node/states.def"
};

// By TableState.
constexpr std::array kTableStates{
#define TABLE_STATE(number, name, words) words,
#include "firmware/node/states.def"
};

constexpr std::array kBegan{object::began_0, object::began_1, object::began_2, object::began_3,
                            object::began_4};

const char* words(NmtState state) {
  switch (state) {
#define NMT_STATE(number, name, title, words) \
  case NmtState::name:                        \
    return words;
#include "firmware/canopen/codes.def"
  }
  return "unknown";
}

// Names of the bits, in their order.
std::string name_of_bit(std::size_t bit) { return code(static_cast<StatusBit>(1U << bit)); }

json axis_facts(NodeClient& client, std::size_t axis, const std::string& letters) {
  json facts{{"axis", axis + 1}, {"letter", letters.substr(std::min(axis, letters.size()), 1)}};
  read_facts(client, facts, object::drive[axis], object::drive_status[axis], object::status[axis]);
  const bool rotary = client.read(object::rotary[axis]) != 0;
  const node::WireScale scale{client.read(object::scale_numerator[axis]),
                              client.read(object::scale_denominator[axis]), rotary,
                              client.read(object::units_per_turn[axis])};
  const std::int32_t offset = client.read(object::offset[axis]);
  const double unit = rotary ? kMicroradPerTurn / kOffsetUnitsPerTurn : kUmPerNm;
  const auto in_user_units = [unit](std::int32_t value) { return value * unit; };
  facts["offset"] = static_cast<double>(offset) * node::units_per_wire(scale) *
                    (rotary ? kMicroradPerTurn / kPositionUnitsPerTurn : kUmPerNm);
  facts["largest_offset"] = in_user_units(client.read(object::largest[axis]));
  facts["largest_lag"] = in_user_units(client.read(object::largest_lag[axis]));
  facts["unit"] = rotary ? "µrad" : "µm";
  add_way_facts(client, axis, facts);
  facts["status_text"] = describe_status(facts["status"]);
  for (std::size_t bit = 0; bit < kStatusBits; ++bit)
    facts["began"][name_of_bit(bit)] = client.read(kBegan.at(axis)[bit]);
  return facts;
}

json axes_facts(NodeClient& client, bool tables) {
  const std::string letters = tables ? client.read(object::axis_letters) : std::string();
  json axes = json::array();
  for (std::size_t axis = 0; axis < node::kNodeAxes; ++axis) {
    if (client.read(object::drive[axis]) != 0) axes.push_back(axis_facts(client, axis, letters));
  }
  return axes;
}

json error_facts(NodeClient& client) {
  json errors = json::array();
  const unsigned count = client.read(object::error_count);
  for (unsigned i = 0; i < count; ++i) {
    const std::uint32_t field = client.read(object::error_history[i]);
    errors.push_back({{"field", field}, {"text", describe_error(field)}});
  }
  return errors;
}

std::string describe_axis(const json& a) {
  const std::string letter = a["letter"];
  std::string text = fmt::format(
      "axis {}: {}\n  drive: node {}, {}\n  offset {:.3f} {}, largest so far {:.3f} {}, lag {:.3f} "
      "{}\n",
      letter.empty() ? a["axis"] : json(letter), a["status_text"], a["drive"],
      describe_drive(a["drive_status"]), a["offset"], a["unit"], a["largest_offset"], a["unit"],
      a["largest_lag"], a["unit"]);
  text += describe_way(a);
  for (std::size_t bit = 1; bit < kStatusBits; ++bit) {
    const json& times = a["began"][name_of_bit(bit)];
    if (times != 0)
      text += fmt::format("  {} x {}\n", times, volcomp::words(static_cast<StatusBit>(1U << bit)));
  }
  return text;
}

std::string tables_line(const json& d) {
  if (d["active_crc"] == "00000000") return "none";
  return fmt::format("CRC-32 {}, sequence number {}", d["active_crc"], d["active_sequence"]);
}

std::string machine_line(const json& d) {
  return d["machine_id"] == 0 ? "takes tables of any machine"
                              : fmt::format("takes tables of machine {} only", d["machine_id"]);
}

}  // namespace

json diagnose(NodeClient& client) {
  constexpr std::uint64_t kHeartbeatPatience_us = 1'000'000;
  json d{{"node_id", client.node_id()}, {"name", client.read(object::device_name)}};
  const auto nmt = client.await_heartbeat(kHeartbeatPatience_us);
  d["network_state"] = nmt ? json(words(*nmt)) : json();
  read_facts(client, d, object::hardware_version, object::software_version, object::error_register,
             object::machine_id, object::active_sequence, object::cycles, object::deadline_missed,
             object::cycles_skipped, object::sync_missed, object::sync_foreign, object::activations,
             object::rejections, object::frames_lost);
  const std::uint32_t crc = client.read(object::active_crc);
  const auto saved = client.read<StoreResult>(object::store_result);
  d["active_crc"] = fmt::format("{:08X}", crc);
  d["refusal"] = refusal(client);
  d["errors"] = error_facts(client);
  d["state"] = word_of(kNodeStates, client.read(object::state));
  d["table_state"] = word_of(kTableStates, client.read(object::table_state));
  d["stored"] = sentence(client.read<StoreResult>(object::stored));
  d["saved"] = saved == StoreResult::nothing_stored ? "There was none." : sentence(saved);
  d["start"] = words(client.read<hal::ResetCause>(object::reset_cause));
  d["axes"] = axes_facts(client, crc != 0);
  d["latency"] = diagnose_latency(client, d["axes"]);
  d["forwarding"] = diagnose_forwarding(client, d["axes"]);
  d["strokes"] = diagnose_strokes(client);
  d["thermal"] = diagnose_thermal(client);
  return d;
}

std::string describe(const json& d) {
  std::vector<std::pair<std::string, std::string>> lines;
  const auto line = [&lines](const char* what, const std::string& value) {
    lines.emplace_back(what, value);
  };
  const bool silent = d["network_state"].is_null();
  line("network state:", silent ? "unknown, no heartbeat within 1 s" : d["network_state"]);
  line("state:", d["state"]);
  line("active tables:", tables_line(d));
  line("image last sent:", d["table_state"]);
  if (const std::string last = d["refusal"]; !last.empty()) line("last refusal:", last);
  line("machine:", machine_line(d));
  line("last start:", d["start"]);
  line("store at the start:", d["stored"]);
  line("last save or restore:", d["saved"]);
  line("cycles:", fmt::format("{}, {} of them incomplete at the deadline, {} cut short by SYNC",
                              d["cycles"], d["deadline_missed"], d["cycles_skipped"]));
  line("SYNC:",
       fmt::format("{} missed, {} of another producer", d["sync_missed"], d["sync_foreign"]));
  line("frames lost:", fmt::format("{}", d["frames_lost"]));
  line("latency:", describe_latency(d["latency"]));
  if (!d["forwarding"].is_null()) line("forwarding:", describe_forwarding(d["forwarding"]));
  line("tables:",
       fmt::format("{} times activated, {} times refused", d["activations"], d["rejections"]));
  if (!d["thermal"].is_null()) add_thermal_lines(d["thermal"], lines);
  line("errors now:", d["error_register"] == 0
                          ? "none"
                          : fmt::format("error register {:02X}h", d["error_register"]));
  line("error history:", d["errors"].empty() ? "empty" : "newest first");
  std::string text = fmt::format("node {}: {}, hardware {}, software {}\n", d["node_id"], d["name"],
                                 d["hardware_version"], d["software_version"]) +
                     text_of_section(list_section("", lines));
  for (const json& error : d["errors"])
    text += fmt::format("  {}\n", error["text"]);
  if (d["axes"].empty()) text += "no axis has a drive\n";
  for (const json& axis : d["axes"])
    text += describe_axis(axis);
  if (!d["strokes"].is_null()) text += describe_strokes(d["strokes"]);
  return text;
}

}  // namespace volcomp::host
