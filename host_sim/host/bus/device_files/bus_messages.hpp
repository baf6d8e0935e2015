#pragma once
// All messages on the bus of one machine, frame by frame: identifiers and layouts come from the
// tables of node and drives, names and units from here.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/can_port.hpp"
#include "host_sim/host/bus/bus_settings.hpp"

namespace volcomp::host {

using ValueNames = std::vector<std::pair<unsigned, std::string>>;

struct BusSignal {
  std::string name;
  std::size_t first_bit = 0;  // little-endian, bit 0 of byte 0 is 0
  std::size_t bits = 0;
  bool is_signed = false;
  double factor = 1.0;  // physical value per unit on the wire
  std::string unit;
  std::string comment;
  ValueNames values{};
};

struct BusMessage {
  std::uint16_t id = 0;
  std::string name;
  std::size_t size = 0;  // bytes
  std::string sender;
  std::vector<std::string> receivers;
  std::string comment;
  std::vector<BusSignal> signals;
};

// "Controller", "Node", then a drive per axis, "X_Drive" for instance.
[[nodiscard]] std::vector<std::string> bus_stations(const BusSettings& bus);

// By identifier, the most urgent first. Throws UserError when the stations cannot share a bus: a
// node id outside 1…127 or given twice, more axes than a node has, a letter given twice.
[[nodiscard]] std::vector<BusMessage> bus_messages(const BusSettings& bus);

// A signal of the message in its own unit; nothing where the message has no such signal or the
// frame is too short for it.
[[nodiscard]] std::optional<double> signal_value(const BusMessage& message, const char* name,
                                                 const hal::CanFrame& frame);

}  // namespace volcomp::host
