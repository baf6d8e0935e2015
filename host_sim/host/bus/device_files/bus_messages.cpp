#include "host_sim/host/bus/device_files/bus_messages.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/device_files/signal_names.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using canopen::NamedEntry;
using canopen::ObjectId;
using canopen::PdoParameters;

const std::string kController = "Controller";
const std::string kNode = "Node";

std::string drive_name(const BusAxis& axis) { return fmt::format("{}_Drive", axis.letter); }

std::vector<std::string> drive_names(const BusSettings& bus) {
  std::vector<std::string> names;
  for (const BusAxis& axis : bus.axes)
    names.push_back(drive_name(axis));
  return names;
}

// --- process data

const NamedEntry& row_of(Span<const NamedEntry> dictionary, ObjectId object) {
  return *std::find_if(dictionary.begin(), dictionary.end(), [object](const NamedEntry& row) {
    return row.index == object.index && row.first_sub <= object.sub && object.sub <= row.last_sub;
  });
}

// Positions of linear axes are in nm, those of rotary axes in 2^-31 turn.
void set_unit(BusSignal& signal, Quantity quantity, bool rotary) {
  switch (quantity) {
    case Quantity::position:
      signal.unit = rotary ? "deg" : "nm";
      signal.factor = rotary ? 360.0 / 2147483648.0 : 1.0;
      break;
    case Quantity::speed:
      signal.unit = "nm/s";
      break;
    case Quantity::time:
      signal.unit = "ns";
      break;
    case Quantity::temperature:
      signal.unit = "degC";
      signal.factor = 0.01;
      break;
    case Quantity::count:
      signal.unit = "1";
      break;
    case Quantity::code:
      break;
  }
}

std::vector<BusSignal> mapped_signals(const PdoParameters& pdo, Span<const NamedEntry> dictionary,
                                      bool rotary) {
  std::vector<BusSignal> signals;
  std::size_t at = 0;
  for (std::size_t i = 0; i < pdo.count; ++i) {
    const ObjectId object = canopen::object_of(pdo.mapping.at(i));
    const NamedEntry& row = row_of(dictionary, object);
    const SignalText& text = signal_text(object);
    BusSignal s;
    s.name = text.name;
    s.first_bit = at;
    s.bits = pdo.mapping.at(i) & 0xFFU;
    s.is_signed = canopen::is_signed(row.type);
    s.comment = object.sub == 0
                    ? fmt::format("{:04X}h {}", object.index, row.name)
                    : fmt::format("{:04X}h:{:02X} {}", object.index, object.sub, row.name);
    if (text.comment != nullptr) s.comment += fmt::format(". {}", text.comment);
    s.values = text.values;
    set_unit(s, text.quantity, rotary);
    at += s.bits;
    signals.push_back(s);
  }
  return signals;
}

struct Wire {
  std::string name;
  std::string sender;
  std::vector<std::string> receivers;
  std::string comment;
};

BusMessage process_data(const PdoParameters& pdo, Span<const NamedEntry> dictionary, bool rotary,
                        const Wire& wire) {
  BusMessage m{static_cast<std::uint16_t>(pdo.cob_id & hal::kMaxCanId),
               wire.name,
               0,
               wire.sender,
               wire.receivers,
               wire.comment,
               mapped_signals(pdo, dictionary, rotary)};
  for (const BusSignal& s : m.signals)
    m.size += s.bits / 8;
  return m;
}

void add_axis(const BusAxis& axis, std::vector<BusMessage>& messages) {
  const auto receive = cia402_receive_pdos(axis.drive);
  const auto transmit = cia402_transmit_pdos(axis.drive);
  const std::string drive = drive_name(axis);
  const auto add = [&](const PdoParameters& pdo, const char* name, const std::string& sender,
                       const std::vector<std::string>& receivers, const char* comment) {
    const Wire wire{fmt::format("{}_{}", axis.letter, name), sender, receivers, comment};
    messages.push_back(process_data(pdo, named_cia402_dictionary(), axis.rotary, wire));
  };
  add(receive[0], "Command", kController, {drive, kNode},
      "Takes effect at the next SYNC; the node listens");
  add(receive[1], "Offset", kNode, {drive},
      "Compensation, takes effect with the command at the next SYNC");
  add(transmit[0], "Actual", drive, {kController, kNode},
      "As of the last SYNC; the position contains the offset");
  add(transmit[1], "Probe", drive, {kController, kNode},
      "Position latched by touch probe 1, and when");
  add(transmit[2], "ProbeCounter", drive, {kController, kNode}, "Edges of touch probe 1 so far");
  add(transmit[3], "HeldOffset", drive, {kNode}, "The offset the drive adds since the last SYNC");
}

BusMessage node_status(const BusSettings& bus) {
  const PdoParameters pdo =
      node::default_transmit_pdo(node::kStatusPdo, node::NodeObjects{}, bus.node);
  return process_data(pdo, node::named_node_dictionary(), false,
                      {"Node_Status", kNode, {kController}, "State of the compensation"});
}

BusMessage told_by_controller(const BusSettings& bus, std::size_t receive_pdo, const char* name,
                              const char* comment) {
  node::NodeObjects objects;
  objects.controller = bus.controller;
  const PdoParameters pdo = node::default_receive_pdo(receive_pdo, objects);
  return process_data(pdo, node::named_node_dictionary(), false,
                      {fmt::format("{}_{}", kController, name), kController, {kNode}, comment});
}

void add_points(const BusSettings& bus, std::vector<BusMessage>& messages) {
  const auto add = [&](std::size_t part, const char* name, const char* comment) {
    const PdoParameters pdo =
        node::default_transmit_pdo(node::kFirstPointPdo + part, node::NodeObjects{}, bus.node);
    const Wire wire{name, kNode, {kController}, comment};
    messages.push_back(process_data(pdo, node::named_node_dictionary(), false, wire));
  };
  add(0, "Point", "What became of the latest touch");
  add(1, "Point_XY", "Workpiece coordinates of the latest point");
  add(2, "Point_Z", "Workpiece coordinate of the latest point, and how sure it is");
}

// --- services

std::vector<std::string> everybody_but(const BusSettings& bus, const std::string& sender) {
  std::vector<std::string> names = bus_stations(bus);
  names.erase(std::remove(names.begin(), names.end(), sender), names.end());
  return names;
}

BusMessage nmt_command(const BusSettings& bus) {
  return {canopen::kNmt,
          "NMT_Command",
          2,
          kController,
          everybody_but(bus, kController),
          "Network management",
          {{"Command", 0, 8, false, 1.0, "", "What to do", nmt_commands()},
           {"NodeId", 8, 8, false, 1.0, "", "Who; 0: everybody"}}};
}

BusMessage sync(const BusSettings& bus) {
  return {canopen::kSync,
          "SYNC",
          1,
          kController,
          everybody_but(bus, kController),
          "Begins a cycle",
          {{"SyncCounter", 0, 8, false, 1.0, "1", "1 to 240 (1019h), then 1 again"}}};
}

// The upper four bits of the first 32 are reserved.
BusMessage time_of_day(const BusSettings& bus) {
  return {canopen::kTime,
          "TIME",
          6,
          kController,
          everybody_but(bus, kController),
          "The date, for tables that expire",
          {{"Milliseconds", 0, 28, false, 1.0, "ms", "After midnight"},
           {"Days", 32, 16, false, 1.0, "d", "Since 1 January 1984"}}};
}

std::uint16_t id_of(std::uint16_t function, std::uint8_t node) {
  return static_cast<std::uint16_t>(function + node);
}

BusMessage heartbeat(const BusSettings& bus, std::uint8_t id, const std::string& station,
                     const std::string& prefix) {
  return {id_of(canopen::kHeartbeat, id),
          prefix + "_Heartbeat",
          1,
          station,
          everybody_but(bus, station),
          "Boot-up and heartbeat",
          {{"NmtState", 0, 8, false, 1.0, "", "State of network management", nmt_states()}}};
}

BusMessage emergency(std::uint8_t id, const std::string& station, const std::string& prefix) {
  const char* const source =
      station == kNode ? "Axis from 1, or node id, or RPDO: who it is about" : "0: the drive";
  return {id_of(canopen::kEmergency, id),
          prefix + "_Emergency",
          8,
          station,
          {kController},
          "Sent when an error appears, and with code 0 when it has gone",
          {{"ErrorCode", 0, 16, false, 1.0, "", "CiA 301, table 26", error_codes()},
           {"ErrorRegister", 16, 8, false, 1.0, "", "1001h: bits of the errors still there"},
           {"Source", 24, 8, false, 1.0, "", source},
           {"Detail", 32, 32, false, 1.0, "",
            "Depends on the error: the status word of the axis, the code that has gone"}}};
}

BusMessage sdo(std::uint16_t id, const std::string& name, const std::string& sender,
               const std::string& receiver) {
  return {id,
          name,
          8,
          sender,
          {receiver},
          "Access to the object dictionary. Segments carry data from the second byte on",
          {{"SdoCommand", 0, 8, false, 1.0, "", "Command specifier and flags"},
           {"Index", 8, 16, false, 1.0, "", "Of the object"},
           {"SubIndex", 24, 8, false, 1.0, "", "Of the object"},
           {"Data", 32, 32, false, 1.0, "", "Value, length or abort code"}}};
}

void add_services(const BusSettings& bus, std::uint8_t id, const std::string& station,
                  const std::string& prefix, std::vector<BusMessage>& messages) {
  messages.push_back(emergency(id, station, prefix));
  messages.push_back(
      sdo(id_of(canopen::kSdoRequest, id), prefix + "_SdoRequest", kController, station));
  messages.push_back(
      sdo(id_of(canopen::kSdoResponse, id), prefix + "_SdoResponse", station, kController));
  messages.push_back(heartbeat(bus, id, station, prefix));
}

// --- what cannot be

void check(const BusSettings& bus) {
  if (bus.axes.size() > node::kNodeAxes) {
    throw UserError(fmt::format("a node on the bus has room for {} axes, {} are given",
                                node::kNodeAxes, bus.axes.size()));
  }
  std::set<unsigned> ids;
  std::set<char> letters;
  const auto take = [&ids](unsigned id) {
    if (id < 1 || id > canopen::kMaxNodeId)
      throw UserError(fmt::format("node id {} is not from 1 to {}", id, canopen::kMaxNodeId));
    if (!ids.insert(id).second) throw UserError(fmt::format("two stations have node id {}", id));
  };
  take(bus.controller);
  take(bus.node);
  for (const BusAxis& axis : bus.axes) {
    take(axis.drive);
    if (axis.letter < 'A' || axis.letter > 'Z')
      throw UserError(fmt::format("\"{}\" is not an axis letter from A to Z", axis.letter));
    if (!letters.insert(axis.letter).second)
      throw UserError(fmt::format("two axes are called {}", axis.letter));
  }
}

// The number on the wire; nothing when the frame is too short.
std::optional<std::int64_t> raw_of(const BusSignal& s, const hal::CanFrame& frame) {
  if (s.first_bit + s.bits > std::size_t{frame.size} * 8) return std::nullopt;
  const std::uint64_t value = load_le(frame.data.data(), frame.size) >> s.first_bit;
  const std::uint64_t mask = s.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.bits) - 1;
  const std::uint64_t cut = value & mask;
  const bool negative = s.is_signed && (cut >> (s.bits - 1) & 1U) != 0;
  return static_cast<std::int64_t>(negative ? cut | ~mask : cut);
}

const BusSignal* signal_of(const BusMessage& message, const char* name) {
  const auto found = std::find_if(message.signals.begin(), message.signals.end(),
                                  [name](const BusSignal& s) { return s.name == name; });
  return found == message.signals.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> bus_stations(const BusSettings& bus) {
  std::vector<std::string> names = drive_names(bus);
  names.insert(names.begin(), {kController, kNode});
  return names;
}

std::vector<BusMessage> bus_messages(const BusSettings& bus) {
  check(bus);
  std::vector<BusMessage> messages{
      nmt_command(bus),
      sync(bus),
      node_status(bus),
      told_by_controller(bus, node::kProcessStatePdo, "ProcessState",
                         "What a grinder does at the targets of the same cycle"),
      told_by_controller(bus, node::kTemperaturePdo, "Temperatures",
                         "How warm the axes are; -327.68: no sensor"),
      time_of_day(bus),
      heartbeat(bus, bus.controller, kController, kController)};
  add_points(bus, messages);
  add_services(bus, bus.node, kNode, kNode, messages);
  for (const BusAxis& axis : bus.axes) {
    add_axis(axis, messages);
    add_services(bus, axis.drive, drive_name(axis), std::string(1, axis.letter), messages);
  }
  std::sort(messages.begin(), messages.end(),
            [](const BusMessage& a, const BusMessage& b) { return a.id < b.id; });
  return messages;
}

std::optional<double> signal_value(const BusMessage& message, const char* name,
                                   const hal::CanFrame& frame) {
  const BusSignal* const signal = signal_of(message, name);
  if (signal == nullptr) return std::nullopt;
  const std::optional<std::int64_t> raw = raw_of(*signal, frame);
  if (!raw) return std::nullopt;
  return signal->factor * static_cast<double>(*raw);
}

}  // namespace volcomp::host
