// The process data of a node as it comes: what it receives from controller and drives, what it
// sends.

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/node/object_handles.hpp"

namespace volcomp::node {
namespace {

// The axis number in front of the sub-index: arrays start at sub-index 1.
constexpr std::uint8_t sub(std::size_t axis) { return static_cast<std::uint8_t>(axis + 1); }

// 32 bits of a received PDO that the node has no use for (CiA 301, section 7.4.7: dummy mapping).
constexpr std::uint32_t kFollowingError = canopen::mapped(0x0004, 0, 32);

// A PDO of one axis: the sub-index of what is mapped is the number of the axis.
struct AxisPdo {
  std::uint32_t function;
  std::uint8_t count;
  std::array<std::uint32_t, 3> mapping;
};

template <class T>
constexpr std::uint32_t at_axis(const canopen::object_lines::Handle<T>& object) {
  return canopen::mapped(object.index, 0, 8 * sizeof(T));
}

// The node listens to what controller and drives tell each other: RPDO1 of the drive, and its
// TPDO1, TPDO4, TPDO2 and TPDO3.
constexpr std::array<AxisPdo, 5> kHeard{
    {{canopen::kRpdo1, 2, {at_axis(object::control), at_axis(object::target)}},
     {canopen::kTpdo1,
      3,
      {at_axis(object::actual), at_axis(object::drive_status), at_axis(object::probe_status)}},
     {canopen::kTpdo1 + 0x300U, 1, {at_axis(object::held_offset)}},
     {canopen::kTpdo1 + 0x100U, 2, {at_axis(object::latched), at_axis(object::latch_time)}},
     {canopen::kTpdo1 + 0x200U, 2, {at_axis(object::edge_count), kFollowingError}}}};

constexpr AxisPdo kOffset{canopen::kRpdo1 + 0x100U, 1, {at_axis(object::offset)}};

canopen::PdoParameters axis_pdo(const AxisPdo& pdo, std::size_t axis, std::uint8_t drive,
                                std::uint32_t flags) {
  canopen::PdoParameters p;
  p.cob_id = flags | (pdo.function + drive);
  if (drive == 0) p.cob_id |= canopen::kPdoInvalid;
  p.count = pdo.count;
  for (std::size_t i = 0; i < pdo.count; ++i) {
    p.mapping[i] = pdo.mapping[i];
    if (pdo.mapping[i] != kFollowingError) p.mapping[i] += canopen::mapped(0, sub(axis), 0);
  }
  return p;
}

// TPDO1 of the controller, with what it does at the target positions of the same cycle.
[[maybe_unused]] canopen::PdoParameters process_state_pdo(std::uint8_t controller) {
  canopen::PdoParameters p;
  p.cob_id = std::uint32_t{canopen::kTpdo1} + controller;
  p.count = 3;
  p.mapping[0] = object::stroke::slot.mapped();
  p.mapping[1] = object::stroke::flags.mapped();
  p.mapping[2] = object::stroke::feed_nm_per_s.mapped();
  return p;
}

// TPDO2 of the controller, in whatever rhythm it likes.
[[maybe_unused]] canopen::PdoParameters temperature_pdo(std::uint8_t controller) {
  canopen::PdoParameters p;
  p.cob_id = std::uint32_t{canopen::kTpdo2} + controller;
  p.count = kTemperatureInputs;
  for (std::size_t i = 0; i < kTemperatureInputs; ++i)
    p.mapping[i] = object::thermal::reading[i].mapped();
  return p;
}

// Of the node itself: state, then the three of a point.
constexpr std::array<std::array<std::uint32_t, 4>, 1 + kPointPdos> kOwnMapping{
    {{object::active_crc.mapped(), object::state.mapped(), object::sync_counter.mapped(),
      object::any_status.mapped()},
     {object::probe::sequence.mapped(), object::probe::verdict.mapped(),
      object::probe::axis.mapped(), object::probe::feature_low.mapped()},
     {object::probe::workpiece_nm[0].mapped(), object::probe::workpiece_nm[1].mapped()},
     {object::probe::workpiece_nm[2].mapped(), object::probe::uncertainty_nm.mapped()}}};

}  // namespace

canopen::PdoParameters default_receive_pdo(std::size_t number, const NodeObjects& objects) {
  if constexpr (kWatchesStrokes) {
    if (number == kProcessStatePdo) return process_state_pdo(objects.controller);
  }
  if constexpr (kFollowsTemperature) {
    if (number == kTemperaturePdo) return temperature_pdo(objects.controller);
    if (number == kProcessStatePdo) return {};  // of nodes without strokes: off
  }
  const std::size_t axis = number % kNodeAxes;
  const bool unwanted = number - kFirstHeldPdo < kNodeAxes && objects.confirms[axis] == 0;
  return axis_pdo(kHeard[number / kNodeAxes], axis, objects.drive[axis],
                  unwanted ? canopen::kPdoInvalid : 0);
}

// TPDO1…4 of the node itself, RPDO2 of the drives.
canopen::PdoParameters default_transmit_pdo(std::size_t number, const PerAxis<std::uint8_t>& drives,
                                            std::uint8_t node_id) {
  if (number < kStatusPdo) return axis_pdo(kOffset, number, drives[number], canopen::kPdoNoRtr);
  canopen::PdoParameters p;
  const std::size_t own = number - kStatusPdo;
  const auto function = static_cast<std::uint32_t>(canopen::kTpdo1 + 0x100U * own);
  p.cob_id = canopen::kPdoNoRtr | (function + node_id);
  if (own == 0) p.event_timer_ms = p.inhibit_100us = 1000;
  p.count = own < 2 ? 4 : 2;
  for (std::size_t i = 0; i < p.count; ++i)
    p.mapping[i] = kOwnMapping[own][i];
  return p;
}

}  // namespace volcomp::node
