#include "firmware/canopen/heartbeat.hpp"

namespace volcomp::canopen {
namespace {

std::uint8_t node_of(std::uint32_t entry) { return static_cast<std::uint8_t>(entry >> 16U); }
std::uint64_t time_us(std::uint32_t entry) { return 1000U * std::uint64_t{entry & 0xFFFFU}; }

}  // namespace

// kHeartbeatConsumers when the node is not watched.
std::size_t HeartbeatConsumer::slot(std::uint8_t node) const {
  for (std::size_t i = 0; i < kHeartbeatConsumers; ++i) {
    const std::uint32_t entry = objects_.consumer_heartbeat[i];
    if (node != 0 && node_of(entry) == node && time_us(entry) != 0) return i;
  }
  return kHeartbeatConsumers;
}

bool HeartbeatConsumer::heard(std::uint8_t node, NmtState state, std::uint64_t now_us,
                              HeartbeatEvent& event) {
  const std::size_t i = slot(node);
  if (i == kHeartbeatConsumers) return false;
  Watch& w = watch_[i];
  const bool was_lost = w.lost;
  w = {now_us, state, node, true, false};
  next_us_ = 0;
  event = state == NmtState::boot_up ? HeartbeatEvent::booted : HeartbeatEvent::back;
  return was_lost || state == NmtState::boot_up;
}

bool HeartbeatConsumer::overdue(std::uint64_t now_us, std::uint8_t& node) {
  if (now_us < next_us_) return false;
  std::uint64_t next_us = UINT64_MAX;
  for (std::size_t i = 0; i < kHeartbeatConsumers; ++i) {
    Watch& w = watch_[i];
    if (!w.started || w.lost) continue;
    const std::uint32_t entry = objects_.consumer_heartbeat[i];
    if (now_us - w.last_us > time_us(entry)) {
      w.lost = true;
      node = node_of(entry);
      return true;
    }
    const std::uint64_t at_us = w.last_us + time_us(entry) + 1U;
    if (at_us < next_us) next_us = at_us;
  }
  next_us_ = next_us;
  return false;
}

bool HeartbeatConsumer::restart(std::uint8_t sub, std::uint8_t& lost_node) {
  Watch& w = watch_[sub - 1U];
  const bool was_lost = w.lost;
  lost_node = w.node;
  w = {};
  return was_lost;
}

NmtState HeartbeatConsumer::state(std::uint8_t node) const {
  const std::size_t i = slot(node);
  return i == kHeartbeatConsumers ? NmtState::boot_up : watch_[i].state;
}

bool HeartbeatConsumer::alive(std::uint8_t node) const {
  const std::size_t i = slot(node);
  return i != kHeartbeatConsumers && watch_[i].started && !watch_[i].lost;
}

}  // namespace volcomp::canopen
