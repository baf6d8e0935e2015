#pragma once
// What is written into the objects of a new compensation node, in the order of writing. `volcomp
// setup` carries the plan out, and the simulated controller follows it at every start.

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "firmware/node/object_handles.hpp"
#include "host_sim/host/bus/bus_settings.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::host {

struct PlannedValue {
  canopen::ObjectId object;
  canopen::DataType type = canopen::DataType::unsigned8;
  std::uint64_t bits = 0;  // as on the bus: two's complement, or IEEE 754 of a REAL64
  std::string name;
  std::string unit;          // empty: none
  bool hexadecimal = false;  // to people

  [[nodiscard]] SdoChannel::Bytes bytes() const;
};

using SetupPlan = std::vector<PlannedValue>;

// Appends a value of type T. `name` and `unit` are for people.
template <class T>
void plan_value(SetupPlan& plan, canopen::ObjectId object, T value, std::string name,
                std::string unit = {}) {
  constexpr std::uint64_t kBits = UINT64_MAX >> (64 - 8 * sizeof(T));
  plan.push_back({object, canopen::object_lines::type_of<T>(), bits_of(value) & kBits,
                  std::move(name), std::move(unit), false});
}

// The same under the name that it has in the dictionary.
template <class T>
void plan_value(SetupPlan& plan, const canopen::object_lines::Handle<T>& object,
                std::common_type_t<T> value, std::string unit = {}) {
  plan_value<T>(plan, object.id(), value, object.name, std::move(unit));
}

// Values of an object from its first sub-index on.
template <class T, class Values>
void plan_values(SetupPlan& plan, const canopen::object_lines::Handle<T>& object,
                 const Values& values) {
  std::size_t next = 0;
  for (const auto& value : values)
    plan_value(plan, object[next++], static_cast<T>(value));
}

// Bits and identifiers: shown in hexadecimal.
template <class T>
void plan_bits(SetupPlan& plan, canopen::ObjectId object, T value, std::string name) {
  plan_value<T>(plan, object, value, std::move(name));
  plan.back().hexadecimal = true;
}

// Heartbeats both ways and the SYNC that all devices share: of the node and of every drive.
[[nodiscard]] SetupPlan common_plan(const BusSettings& settings);

// The same and what else a node needs to know of drives, units, limits and times. Throws UserError
// when the machine has more axes than a node, or strokes but not the axes they need.
[[nodiscard]] SetupPlan node_plan(const BusSettings& settings);

struct NodeProbe;

// Everything that a machine file determines, for a node that may have held other settings before.
// `probe` replaces that of the file. Throws as node_plan().
[[nodiscard]] SetupPlan setup_plan(const MachineFile& machine, const BusSettings& settings,
                                   const NodeProbe* probe = nullptr);

// Queues the whole plan. The name of a value names its transfer in messages.
void queue_plan(SdoChannel& channel, const SetupPlan& plan);

}  // namespace volcomp::host
