// Cyclic process data between motion controller, drives and compensation node.

#include <cmath>

#include "comp/tick/temperature_input.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"
#include "firmware/node/ways.hpp"
#include "host_sim/sim/controller/bus_controller.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint8_t kCounterOverflow = 240;
constexpr int kServedCycles = 2;  // before a drive is enabled

std::uint64_t le(const hal::CanFrame& frame, std::size_t at, std::size_t count) {
  return load_le(&frame.data.at(at), count);
}

}  // namespace

void BusController::take_process_data(const hal::CanFrame& frame) {
  if (frame.id == canopen::kTpdo1 + settings_.node && frame.size == 8) {
    report_ = {static_cast<std::uint32_t>(le(frame, 0, 4)), frame.data[4], frame.data[5],
               static_cast<std::uint16_t>(le(frame, 6, 2)), report_.count + 1};
    served_ = (report_.any_status & node::kForwardingIncomplete) != 0 ? 0 : served_ + 1;
    return;
  }
  take_offsets_to_add(frame);
  constexpr std::array<std::uint16_t, 3> kPoint{canopen::kTpdo2, canopen::kTpdo3, canopen::kTpdo4};
  for (std::size_t part = 0; part < kPoint.size(); ++part) {
    if (frame.id == kPoint[part] + settings_.node) points_.take(part, frame);
  }
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    if ((frame.id & canopen::kMaxNodeId) == settings_.axes[a].drive) take_drive_pdo(a, frame);
  }
}

// 200h, 300h, 400h + the controller's own id: 2020h of two axes each, in the order of the axes.
void BusController::take_offsets_to_add(const hal::CanFrame& frame) {
  std::size_t rank = 0;
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    if (settings_.axes[a].way != host::Way::controller_adds) continue;
    const std::size_t pdo = rank / 2;
    const std::size_t at = 4 * (rank % 2);
    ++rank;
    const bool here = frame.id == canopen::kRpdo1 + 0x100U * pdo + settings_.controller;
    if (here && frame.size >= at + 4) added_[a] = static_cast<std::int32_t>(le(frame, at, 4));
  }
}

// The first layer that acts when the node dies: an axis whose targets it forwards stops, so all do.
void BusController::watch_node() {
  if (report_.count != reports_at_sync_) return;
  served_ = 0;
  bool follows = false;
  for (std::size_t a = 0; a < axis_.size(); ++a)
    follows =
        follows || (settings_.axes[a].way == host::Way::forwarded_target && axis_[a].following());
  for (AxisCommander& axis : axis_) {
    if (follows) axis.stop_quickly();
  }
}

// The mapping of host_sim/host/bus/drive_plan.hpp: a drive says less where it has less to say.
void BusController::take_drive_pdo(std::size_t a, const hal::CanFrame& frame) {
  ProbeReport& probe = probe_[a];
  const auto first = static_cast<std::int32_t>(le(frame, 0, 4));
  switch (frame.id & ~unsigned{canopen::kMaxNodeId}) {
    case canopen::kTpdo1:
      if (frame.size < 6) return;
      axis_[a].actual(first, static_cast<std::uint16_t>(le(frame, 4, 2)));
      if (frame.size == 8) probe.status = static_cast<std::uint16_t>(le(frame, 6, 2));
      return;
    case canopen::kTpdo2:
      if (frame.size < 4) return;
      probe.position = first;
      probe.time_ns = frame.size == 8 ? static_cast<std::uint32_t>(le(frame, 4, 4)) : 0;
      ++probe.latches;
      return;
    case canopen::kTpdo3:
      if (frame.size == 6) probe.edges = static_cast<std::uint16_t>(le(frame, 0, 2));
      return;
    case canopen::kTpdo4:
      if (frame.size == 4) axis_[a].held(first);
      return;
    default:
      return;
  }
}

void BusController::send_sync() {
  node_requests_ = 0;
  if (host::forwards_targets(settings_)) watch_node();
  reports_at_sync_ = report_.count;
  if (host::sync_counter_overflow(settings_) == 0) {
    send_latest({canopen::kSync, 0, {}});
    return;
  }
  counter_ = static_cast<std::uint8_t>(counter_ % kCounterOverflow + 1);
  send_latest({canopen::kSync, 1, {counter_}});
}

// 201Ah:01…03 as the node maps them by default.
void BusController::send_process_state(const host::ProcessState& state) {
  unsigned flags = 0;
  if (state.in_face) flags |= node::kInFace;
  if (state.stroke_end) flags |= node::kStrokeEnd;
  if (state.stroke == Direction::forward) flags |= node::kStrokeForward;
  if (state.stroke == Direction::backward) flags |= node::kStrokeBackward;
  hal::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(canopen::kTpdo1 + settings_.controller);
  frame.size = 8;
  store_le(frame.data.data(), 2, state.slot);
  store_le(&frame.data[2], 2, flags);
  store_le(&frame.data[4], 4, static_cast<std::uint32_t>(state.feed_nm_per_s));
  send_latest(frame);
}

// 2700h as the node maps it by default.
void BusController::send_temperatures(const Temperatures& temperatures) {
  hal::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(canopen::kTpdo2 + settings_.controller);
  frame.size = 8;
  for (std::size_t i = 0; i < temperatures.size(); ++i) {
    const bool known = std::isfinite(temperatures[i]);
    const auto hundredths = known ? static_cast<std::int16_t>(std::lround(100.0F * temperatures[i]))
                                  : TemperatureInput::kNone;
    store_le(&frame.data.at(2 * i), 2, static_cast<std::uint16_t>(hundredths));
  }
  send_latest(frame);
}

// CiA 301, section 7.2.6: milliseconds after midnight, days since 1 January 1984.
void BusController::send_time(std::int64_t unix_s) {
  constexpr std::int64_t kDay_s = 86'400;
  constexpr std::int64_t kDaysTo1984 = 5113;
  hal::CanFrame frame;
  frame.id = canopen::kTime;
  frame.size = 6;
  store_le(frame.data.data(), 4, static_cast<std::uint32_t>(unix_s % kDay_s * 1000));
  store_le(&frame.data[4], 2, static_cast<std::uint16_t>(unix_s / kDay_s - kDaysTo1984));
  send_latest(frame);
}

void BusController::send_targets(const std::vector<std::int32_t>& path) {
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    if (stations_[a].phase != Station::Phase::running) continue;
    if (settings_.axes[a].way == host::Way::forwarded_target)
      axis_[a].may_enable(served_ >= kServedCycles);
    axis_[a].step(path.at(a));
    hal::CanFrame frame;
    frame.id = static_cast<std::uint16_t>(canopen::kRpdo1 + settings_.axes[a].drive);
    frame.size = 6;
    store_le(frame.data.data(), 2, axis_[a].control_word());
    const bool adds = settings_.axes[a].way == host::Way::controller_adds;
    const auto added = static_cast<std::uint32_t>(adds ? added_[a] : 0);
    store_le(&frame.data[2], 4, static_cast<std::uint32_t>(axis_[a].target()) + added);
    if (adds) axis_[a].held(added_[a]);
    send_latest(frame);
  }
  set_modes();
  arm_again();
}

}  // namespace volcomp::sim
