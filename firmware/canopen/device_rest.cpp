// What a loop that serves many devices asks, to leave out those that have nothing to do. Every
// condition here is one of receive(), poll() or offer(). No firmware links it.

#include <algorithm>

#include "firmware/canopen/device_base.hpp"

namespace volcomp::canopen {

bool DeviceBase::heeds(const hal::CanFrame& frame) const {
  const std::uint16_t id = frame.id;
  if (state_ == NmtState::boot_up) return false;
  if (id == kNmt || id == sync_.id() || id == kTime || id == kSdoRequest + node_id_) return true;
  if (id > kHeartbeat && id <= kHeartbeat + kMaxNodeId) return true;
  if (state_ != NmtState::operational) return false;
  const Span<Pdo> pdos = pdos_.receive();
  return std::any_of(pdos.begin(), pdos.end(), [id](const Pdo& pdo) { return pdo.answers_to(id); });
}

// Inhibit times hold back emergencies and TPDOs.
std::uint64_t DeviceBase::sends_at_us() const {
  if (boot_up_due_ || sync_waiting_ || sdo_waiting_ || heartbeat_due_ || sdo_.busy()) return 0;
  std::uint64_t at_us = emergency_.sends_at_us();
  for (std::size_t i = 0; pending_ >> i != 0; ++i) {
    if ((pending_ >> i & 1U) == 0) continue;
    const PdoParameters& p = pdos_.transmit()[i].parameters();
    const TransmitState& sent = transmit_state_[i];
    if (p.type < kEventType || !sent.sent_any) return 0;
    at_us = std::min(at_us, sent.last_us + 100U * std::uint64_t{p.inhibit_100us});
  }
  return at_us;
}

std::uint64_t DeviceBase::rests_until_us() const {
  if (state_ == NmtState::boot_up) return UINT64_MAX;
  if (sync_.producing()) return 0;
  std::uint64_t until_us = std::min(sends_at_us(), sdo_.silent_at_us());
  if (until_us == 0) return 0;
  until_us = std::min(until_us, heartbeats_.next_overdue_us());
  if (values_.producer_heartbeat_ms != 0) {
    const std::uint64_t period_us = 1000U * std::uint64_t{values_.producer_heartbeat_ms};
    until_us = std::min(until_us, last_heartbeat_us_ + period_us);
  }
  if (state_ != NmtState::operational) return until_us;
  const Span<Pdo> pdos = pdos_.transmit();
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    const PdoParameters& p = pdos[i].parameters();
    if (p.event_timer_ms == 0 || p.type < kEventType || !pdos[i].valid()) continue;
    const TransmitState& sent = transmit_state_[i];
    if (!sent.sent_any) return 0;
    until_us = std::min(until_us, sent.last_us + 1000U * std::uint64_t{p.event_timer_ms});
  }
  return until_us;
}

}  // namespace volcomp::canopen
