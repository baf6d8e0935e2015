#include "host_sim/host/bus/bus_monitor.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/emergency.hpp"
#include "hal/loopback/frame_bits.hpp"
#include "host_sim/host/bus/bus_load.hpp"
#include "host_sim/host/bus/device_files/signal_names.hpp"
#include "host_sim/host/bus/diagnosis.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMostEmergencies = 20;
// A heartbeat is late when it takes so much longer than the longest so far.
constexpr double kLate = 2.5;
constexpr std::uint64_t kFirstPatience_us = 2'000'000;

template <class T>
void take_whole(const BusMessage& message, const char* name, const hal::CanFrame& frame,
                std::optional<T>& out) {
  if (const std::optional<double> value = signal_value(message, name, frame))
    out = static_cast<T>(*value);
}

void take_value(const BusMessage& message, const char* name, const hal::CanFrame& frame,
                std::optional<double>& out) {
  if (const std::optional<double> value = signal_value(message, name, frame)) out = value;
}

std::string name_of(const ValueNames& names, unsigned value) {
  for (const auto& [number, name] : names) {
    if (number == value) return name;
  }
  return fmt::format("{}", value);
}

}  // namespace

BusMonitor::BusMonitor(const BusSettings& settings) : settings_(settings) {
  for (BusMessage& m : bus_messages(settings))
    message_.emplace(m.id, std::move(m));
  for (const BusAxis& a : settings.axes) {
    Axis axis;
    axis.seen.letter = a.letter;
    axis.seen.drive = a.drive;
    axis.seen.unit = a.rotary ? "deg" : "nm";
    axis_.push_back(axis);
  }
}

void BusMonitor::take(std::uint64_t time_us, const hal::CanFrame& frame) {
  if (!first_us_) first_us_ = period_begin_us_ = time_us;
  ++period_.frames;
  bits_ += hal::exact_frame_bits(frame);
  const auto id = static_cast<std::uint8_t>(frame.id & canopen::kMaxNodeId);
  const unsigned function = frame.id & ~unsigned{canopen::kMaxNodeId};
  if (frame.id == canopen::kSync) {
    take_sync(time_us, frame);
  } else if (function == canopen::kHeartbeat) {
    take_heartbeat(id, time_us, frame);
  } else if (function == canopen::kEmergency) {
    take_emergency(id, time_us, frame);
  }
  const auto found = message_.find(frame.id);
  if (found == message_.end()) return;
  const BusMessage& message = found->second;
  if (message.name == "Node_Status" && frame.size >= message.size) {
    const auto state =
        static_cast<unsigned>(signal_value(message, "NodeState", frame).value_or(0.0));
    node_ = NodeSeen{
        name_of(node_states(), state),
        static_cast<std::uint32_t>(signal_value(message, "ActiveCrc", frame).value_or(0.0)),
        static_cast<std::uint16_t>(signal_value(message, "AxisStatusBits", frame).value_or(0.0))};
  }
  for (Axis& axis : axis_) {
    if (message.name[0] == axis.seen.letter && message.name[1] == '_')
      take_axis(axis, message, frame);
  }
  if (message.sender == "Node") ++frames_of_[settings_.node];
  if (message.sender == "Controller") ++frames_of_[settings_.controller];
  for (const Axis& axis : axis_) {
    if (message.sender == fmt::format("{}_Drive", axis.seen.letter)) ++frames_of_[axis.seen.drive];
  }
}

void BusMonitor::take_axis(Axis& axis, const BusMessage& message, const hal::CanFrame& frame) {
  const std::string what = message.name.substr(2);
  if (what == "Command") {
    take_value(message, "TargetPosition", frame, axis.seen.target);
    axis.cyclic[0].seen = true;
  } else if (what == "Actual") {
    take_value(message, "ActualPosition", frame, axis.seen.actual);
    take_whole(message, "Statusword", frame, axis.seen.status_word);
    axis.cyclic[1].seen = true;
  } else if (what == "Offset") {
    take_value(message, "PositionOffset", frame, axis.seen.offset);
    axis.cyclic[2].seen = true;
  } else if (what == "ProbeCounter") {
    take_whole(message, "EdgeCounter", frame, axis.seen.edges);
  }
}

void BusMonitor::take_sync(std::uint64_t time_us, const hal::CanFrame& frame) {
  SyncSeen& s = period_.sync;
  double distance = 0.0;
  if (last_sync_us_) {
    distance = static_cast<double>(time_us - std::min(time_us, *last_sync_us_));
    const bool first = s.count == 0;
    s.least_us = first ? distance : std::min(s.least_us, distance);
    s.most_us = first ? distance : std::max(s.most_us, distance);
    ++s.count;
    s.mean_us += (distance - s.mean_us) / static_cast<double>(s.count);
  }
  last_sync_us_ = time_us;
  if (frame.size == 1) {
    const int counter = frame.data[0];
    // 1019h is learned: 1 comes after the last number, in the time of one cycle.
    if (counter == 1 && last_counter_ > 1 && distance < 1.5 * s.mean_us)
      most_counter_ = last_counter_;
    most_counter_ = std::max(most_counter_, std::min(counter, kMostCounter));
    const int expected = last_counter_ >= most_counter_ ? 1 : last_counter_ + 1;
    if (last_counter_ != 0 && counter != expected && counter >= 1 && counter <= most_counter_)
      s.lost += static_cast<std::uint64_t>((counter - expected + most_counter_) % most_counter_);
    last_counter_ = counter;
  }
  // A cycle ends: marks what an earlier one had and this one lacks.
  for (Axis& axis : axis_) {
    bool lost = false;
    for (Cyclic& c : axis.cyclic) {
      lost = lost || (c.known && !c.seen);
      c.known = c.known || c.seen;
      c.seen = false;
    }
    if (lost) ++axis.seen.lost;
  }
}

void BusMonitor::take_heartbeat(std::uint8_t id, std::uint64_t time_us,
                                const hal::CanFrame& frame) {
  if (id == 0 || frame.size != 1) return;
  const auto state = static_cast<canopen::NmtState>(frame.data[0] & 0x7FU);
  const auto [it, first] = heartbeat_.try_emplace(id, Heartbeat{state, time_us, 0});
  Heartbeat& h = it->second;
  // Boot-up comes whenever it comes.
  if (!first && state != canopen::NmtState::boot_up)
    h.longest_us = std::max(h.longest_us, time_us - std::min(time_us, h.heard_us));
  if (state == canopen::NmtState::boot_up) h.longest_us = 0;
  h.state = state;
  h.heard_us = time_us;
}

void BusMonitor::take_emergency(std::uint8_t id, std::uint64_t time_us,
                                const hal::CanFrame& frame) {
  if (id == 0 || frame.size != 8) return;
  const auto code = static_cast<unsigned>(load_le(frame.data.data(), 2));
  std::string text;
  if (code == 0 && id == settings_.node) {
    const auto gone = static_cast<unsigned>(load_le(&frame.data[4], 2));
    text = "gone: " + describe_error(gone | std::uint32_t{frame.data[3]} << 16U);
  } else if (code == 0) {
    text = "an error is gone";
  } else if (id == settings_.node) {
    text = describe_error(code | std::uint32_t{frame.data[3]} << 16U);
  } else {
    text = fmt::format("{} [{:04X}h]", name_of(error_codes(), code), code);
  }
  ++period_.emergency_count;
  auto& list = period_.emergencies;
  if (list.size() == kMostEmergencies) list.erase(list.begin());
  list.push_back({1e-6 * static_cast<double>(time_us - std::min(time_us, *first_us_)),
                  station("", id, time_us).name, text});
}

StationSeen BusMonitor::station(const std::string& name, std::uint8_t id,
                                std::uint64_t now_us) const {
  StationSeen s;
  s.id = id;
  s.name = name;
  if (s.name.empty()) {
    s.name = id == settings_.node ? "node" : id == settings_.controller ? "controller" : "station";
    for (const Axis& axis : axis_) {
      if (axis.seen.drive == id) s.name = fmt::format("drive {}", axis.seen.letter);
    }
  }
  if (const auto f = frames_of_.find(id); f != frames_of_.end()) s.frames = f->second;
  const auto found = heartbeat_.find(id);
  if (found == heartbeat_.end()) return s;
  const Heartbeat& h = found->second;
  s.state = h.state;
  s.heard_us = h.heard_us;
  const double patience_us = h.longest_us == 0 ? static_cast<double>(kFirstPatience_us)
                                               : kLate * static_cast<double>(h.longest_us);
  s.silent = static_cast<double>(now_us - std::min(now_us, h.heard_us)) > patience_us;
  return s;
}

BusSnapshot BusMonitor::snapshot(std::uint64_t now_us) {
  if (!first_us_) period_begin_us_ = now_us;
  BusSnapshot s = std::move(period_);
  period_ = {};
  const std::uint64_t begin_us = first_us_.value_or(now_us);
  s.time_s = 1e-6 * static_cast<double>(now_us - std::min(now_us, begin_us));
  s.period_s = 1e-6 * static_cast<double>(now_us - std::min(now_us, period_begin_us_));
  if (s.period_s > 0.0) s.load = static_cast<double>(bits_) / (kBitRate * s.period_s);
  s.node = node_;
  for (const auto& [id, heartbeat] : heartbeat_)
    s.stations.push_back(station("", id, now_us));
  for (Axis& axis : axis_) {
    const AxisSeen& a = axis.seen;
    if (a.target || a.actual || a.offset) s.axes.push_back(a);
    axis.seen.lost = 0;
  }
  frames_of_.clear();
  bits_ = 0;
  period_begin_us_ = now_us;
  return s;
}

}  // namespace volcomp::host
