// The process data of a node as it comes: what it receives from controller and drives, what it
// sends.

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/node/object_handles.hpp"

namespace volcomp::node {
namespace {

// The axis number in front of the sub-index: arrays start at sub-index 1.
constexpr std::uint8_t sub(std::size_t axis) { return static_cast<std::uint8_t>(axis + 1); }

// Bits of a received PDO that the node has no use for (CiA 301, section 7.4.7: dummy mapping).
constexpr std::uint32_t kFollowingError = canopen::mapped(0x0004, 0, 32);
constexpr std::uint32_t kProbeWord = canopen::mapped(0x0006, 0, 16);  // of a node without probe

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

constexpr std::size_t kHeardOfAxis = 5;  // PDOs

// The node listens to what controller and drives tell each other: RPDO1 of the drive, and its
// TPDO1, TPDO4, TPDO2 and TPDO3.
constexpr std::array<AxisPdo, kHeardOfAxis> kHeard{
    {{canopen::kRpdo1, 2, {at_axis(object::control), at_axis(object::target)}},
     {canopen::kTpdo1,
      3,
      {at_axis(object::actual), at_axis(object::drive_status),
       kProbes ? at_axis(object::probe_status) : kProbeWord}},
     {canopen::kTpdo1 + 0x300U, 1, {at_axis(object::held_offset)}},
     {canopen::kTpdo1 + 0x100U, 2, {at_axis(object::latched), at_axis(object::latch_time)}},
     {canopen::kTpdo1 + 0x200U, 2, {at_axis(object::edge_count), kFollowingError}}}};

// The same where targets are forwarded: the mode instead of the probe, whose status comes with its
// latch. Drives of this kind do not tell when it was.
constexpr std::array<AxisPdo, kHeardOfAxis> kHeardForwarding{
    {kHeard[0],
     {canopen::kTpdo1,
      3,
      {at_axis(object::actual), at_axis(object::drive_status), at_axis(object::drive_mode)}},
     kHeard[2],
     {canopen::kTpdo1 + 0x100U, 2, {at_axis(object::latched), at_axis(object::probe_status)}},
     {canopen::kTpdo1 + 0x200U, 1, {at_axis(object::edge_count)}}}};

constexpr AxisPdo kOffset{canopen::kRpdo1 + 0x100U, 1, {at_axis(object::offset)}};
constexpr AxisPdo kTarget{canopen::kRpdo1 + 0x100U, 1, {at_axis(object::forwarded_target)}};

canopen::PdoParameters axis_pdo(const AxisPdo& pdo, std::size_t axis, std::uint8_t drive,
                                std::uint32_t flags) {
  canopen::PdoParameters p;
  p.cob_id = flags | (pdo.function + drive);
  if (drive == 0) p.cob_id |= canopen::kPdoInvalid;
  p.count = pdo.count;
  for (std::size_t i = 0; i < pdo.count; ++i) {
    p.mapping[i] = pdo.mapping[i];
    const bool of_axis = pdo.mapping[i] != kFollowingError && pdo.mapping[i] != kProbeWord;
    if (of_axis) p.mapping[i] += canopen::mapped(0, sub(axis), 0);
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

// Offsets that the controller adds, two at a time: of `first` and the next axis of that way.
canopen::PdoParameters added_pdo(std::size_t first, const NodeObjects& objects) {
  canopen::PdoParameters p;
  std::size_t earlier = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (static_cast<Way>(objects.way[a]) != Way::controller_adds) continue;
    if (a < first) ++earlier;
    if (offset_pdo(objects, a) == first) p.mapping[p.count++] = object::offset[a].mapped();
  }
  if (p.count == 0) return p;  // carried with the one before
  const auto function = static_cast<std::uint32_t>(canopen::kRpdo1 + 0x100U * (earlier / 2));
  p.cob_id = canopen::kPdoNoRtr | (function + objects.controller);
  return p;
}

canopen::PdoParameters correction_pdo(std::size_t axis, const NodeObjects& objects) {
  const std::uint8_t drive = objects.drive[axis];
  switch (static_cast<Way>(objects.way[axis])) {
    case Way::forwarded_target:
      return axis_pdo(kTarget, axis, drive, canopen::kPdoNoRtr);
    case Way::controller_adds:
      return added_pdo(axis, objects);
    case Way::offset:
      return axis_pdo(kOffset, axis, drive, canopen::kPdoNoRtr);
    default:
      return {};
  }
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
  if constexpr (!kProbes) {
    if (number >= kFirstLatchPdo) return {};
  }
  const std::size_t axis = number % kNodeAxes;
  const auto way = static_cast<Way>(objects.way[axis]);
  const bool reports = way == Way::offset && objects.confirms[axis] != 0;
  const bool unwanted = number - kFirstHeldPdo < kNodeAxes && !reports;
  const auto& heard = way == Way::forwarded_target ? kHeardForwarding : kHeard;
  return axis_pdo(heard[number / kNodeAxes], axis, objects.drive[axis],
                  unwanted ? canopen::kPdoInvalid : 0);
}

std::size_t offset_pdo(const NodeObjects& objects, std::size_t axis) {
  constexpr auto kAdds = static_cast<std::uint8_t>(Way::controller_adds);
  if (objects.way[axis] != kAdds) return axis;
  std::size_t carrier = axis;
  std::size_t rank = 0;
  for (std::size_t a = 0; a <= axis; ++a) {
    if (objects.way[a] == kAdds && rank++ % 2 == 0) carrier = a;
  }
  return carrier;
}

// TPDO1…4 of the node itself, RPDO2 of the drives, RPDO1…3 of a controller that adds offsets.
canopen::PdoParameters default_transmit_pdo(std::size_t number, const NodeObjects& objects,
                                            std::uint8_t node_id) {
  if (number < kStatusPdo) return correction_pdo(number, objects);
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
