#pragma once
// What a log tool shows for objects in process data, and the words for coded values.

#include "firmware/canopen/object_access.hpp"
#include "host_sim/host/bus/device_files/bus_messages.hpp"

namespace volcomp::host {

enum class Quantity : std::uint8_t { code, count, position, speed, time, temperature };

struct SignalText {
  canopen::ObjectId object;
  const char* name;
  Quantity quantity;
  const char* comment = nullptr;  // beyond the name in the dictionary
  ValueNames values{};
};

// Name and unit of an object that node or drives map by default; throws std::logic_error for
// others.
[[nodiscard]] const SignalText& signal_text(canopen::ObjectId object);

[[nodiscard]] ValueNames nmt_states();
[[nodiscard]] ValueNames nmt_commands();
[[nodiscard]] ValueNames node_states();
[[nodiscard]] ValueNames touch_verdicts();
[[nodiscard]] ValueNames error_codes();

}  // namespace volcomp::host
