#pragma once
// What the parts of a node share: the objects, the CANopen device, the compensator, the gates of
// the offsets, and the cycle as far as others look at it.

#include "firmware/canopen/device.hpp"
#include "firmware/node/arrivals.hpp"
#include "firmware/node/object_handles.hpp"
#include "firmware/node/offset_gate.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/tables/node_compensator.hpp"

namespace volcomp::node {

class Node;
using NodeDevice = canopen::Device<Node>;

struct NodeCore {
  // `allowed` may be nullptr: there is one context.
  NodeCore(Node& node, std::uint8_t node_id, Preemption* allowed);

  NodeObjects objects = default_objects();
  std::array<canopen::Pdo, kReceivePdos> receive{};
  std::array<canopen::Pdo, kTransmitPdos> transmit{};
  Preemption* preemption;
  NodeDevice device;
  PerAxis<OffsetGate> gate{};  // with the scale of the axis

  TickInput<kNodeAxes> input{};
  std::uint32_t arrived = 0;      // in this cycle, see Arrival
  std::uint32_t correcting = 0;   // axes that take offsets of any kind, a bit each
  std::uint8_t open_counter = 0;  // of the SYNC that opened the cycle
  bool running = false;           // the compensator ticks
  bool overdue = false;           // the background
  NodeCompensator compensator{};  // last: what lies behind so many bytes takes long instructions

  [[nodiscard]] canopen::Emergency& emergency() { return device.emergency(); }
  [[nodiscard]] bool booting() const { return device.state() == canopen::NmtState::boot_up; }
  [[nodiscard]] bool operational() const {
    return device.state() == canopen::NmtState::operational;
  }
  [[nodiscard]] bool has(unsigned kind, std::size_t axis) const {
    return (arrived & bit(kind + axis)) != 0;
  }
  [[nodiscard]] bool corrects(std::size_t axis) const { return (correcting & bit(axis)) != 0; }
  // Those of 2010h.
  [[nodiscard]] std::uint32_t used_axes() const;
  [[nodiscard]] Way way(std::size_t axis) const { return static_cast<Way>(objects.way[axis]); }
  // Those whose drives report the offsets they hold.
  [[nodiscard]] std::uint32_t confirming_axes() const;
  // The compensator has another machine.
  void note_machine();

  // --- node_settings.cpp

  Status configure();
  // Of the offset of an axis, per cycle.
  [[nodiscard]] OffsetLimits limits(std::size_t a) const;
  void set_default_pdos();
  void set_default_receive_pdos(std::size_t first, std::size_t end);
  // 2034h: those of one axis, and all that carry offsets.
  void set_default_axis_pdos(std::size_t axis);
  // Refuses no_way: the machine corrects an axis whose drive takes nothing.
  [[nodiscard]] Status check_way_of(const RuntimeChain& chain) const;
  // Refuses bad_setting and no_way, with the axis.
  [[nodiscard]] Status check_ways() const;

 private:
  void configure_gate(std::size_t a, const OffsetLimits& limits);
  [[nodiscard]] bool hears(canopen::ObjectId object) const;
  void set_default_transmit_pdos(std::size_t end);
  [[nodiscard]] bool can_forward(std::size_t axis) const;
};

// Writes a refusal (or its absence) to 2112h:02…06.
void report(const Status& status, NodeObjects& objects);

}  // namespace volcomp::node
