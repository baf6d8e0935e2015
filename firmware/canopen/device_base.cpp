#include "firmware/canopen/device_base.hpp"

namespace volcomp::canopen {

DeviceBase::DeviceBase(const Parts& parts, ObjectAccess& access)
    : values_(*parts.values),
      objects_(parts.dictionary, parts.values),
      pdos_(parts.receive, parts.transmit, parts.of_cycle, objects_),
      sync_(values_),
      emergency_(values_),
      heartbeats_(values_),
      sdo_(access) {}

// --- life cycle

void DeviceBase::begin_restart() {
  state_ = NmtState::boot_up;
  offered_ = Offered::none;
  sdo_.reset();
  emergency_.reset();
  sync_.reset();
  heartbeats_.reset();
  pending_ = for_sync_ = 0;
  sync_waiting_ = sdo_waiting_ = heartbeat_due_ = false;
  latest_ = {};
  transmit_state_ = {};
}

void DeviceBase::end_restart(std::uint64_t now_us) {
  values_.emergency_cob_id = kEmergency + std::uint32_t{node_id_};
  values_.sdo_cob_id = {kSdoRequest + std::uint32_t{node_id_},
                        kSdoResponse + std::uint32_t{node_id_}};
  boot_up_due_ = true;
  last_heartbeat_us_ = now_us;
}

bool DeviceBase::change_state(NmtState state) {
  if (state == state_) return false;
  state_ = state;
  latest_ = {};
  pending_ = for_sync_ = 0;
  if (state == NmtState::operational) transmit_state_ = {};
  if (state == NmtState::stopped) fall_silent();
  return true;
}

// STOPPED knows neither SDO nor SYNC (CiA 301, section 7.3.2.2): nothing that waits may leave, and
// afterwards the SYNC counter begins anew, because nobody has followed it.
void DeviceBase::fall_silent() {
  sdo_.reset();
  sync_.reset();
  sdo_waiting_ = sync_waiting_ = false;
}

// --- in

// By the identifier and the NMT command alone, so that the answer never depends on what is just
// being changed.
DeviceBase::Work DeviceBase::work(const hal::CanFrame& frame) const {
  const std::uint16_t id = frame.id;
  if (id == kSdoRequest + node_id_) return Work::lengthy;
  if (id > kHeartbeat && id <= kHeartbeat + kMaxNodeId) return Work::service;
  if (id != kNmt) return Work::cyclic;
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  const bool resets =
      command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  return resets ? Work::lengthy : Work::service;
}

std::size_t DeviceBase::heard(HeardIds& ids) const {
  std::size_t count = 0;
  const auto add = [&](std::uint32_t id) { ids[count++] = static_cast<std::uint16_t>(id); };
  add(kNmt);
  add(sync_.id());
  add(kTime);
  add(kSdoRequest + std::uint32_t{node_id_});
  for (const Pdo& pdo : pdos_.receive()) {
    if (pdo.valid()) add(pdo.id());
  }
  for (const std::uint32_t watched : values_.consumer_heartbeat) {
    const std::uint32_t node = watched >> 16U;
    if ((watched & 0xFFFFU) != 0 && node > 0 && node <= kMaxNodeId) add(kHeartbeat + node);
  }
  return count;
}

bool DeviceBase::enter_call(std::uint64_t now_us) {
  if (state_ == NmtState::boot_up) return false;
  now_us_ = now_us;
  return true;
}

bool DeviceBase::commanded(const hal::CanFrame& frame) const {
  return frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == node_id_);
}

bool DeviceBase::accept(std::size_t receive_pdo, const hal::CanFrame& frame, std::uint64_t now_us) {
  const Pdo& pdo = pdos_.receive()[receive_pdo];
  const auto source = static_cast<std::uint8_t>(receive_pdo + 1);
  if (frame.size < pdo.bytes()) {
    emergency_.raise(ErrorCode::rpdo_length, source, {frame.size, pdo.bytes()});
    return false;
  }
  emergency_.clear(ErrorCode::rpdo_length, source);
  if (!pdo.synchronous()) return true;
  if (values_.sync_window_us == 0 || now_us - last_sync_us_ <= values_.sync_window_us)
    latest_[receive_pdo] = {frame, true};
  return false;
}

// --- time

void DeviceBase::run_own_timers(std::uint64_t now_us) {
  const std::uint64_t period_us = 1000U * std::uint64_t{values_.producer_heartbeat_ms};
  if (period_us != 0 && now_us - last_heartbeat_us_ >= period_us) {
    heartbeat_due_ = !heartbeat_held_;
    last_heartbeat_us_ = now_us;
  }
}

// CiA 301, section 7.5.2.31.
NmtState DeviceBase::state_after_error() const {
  const auto behaviour = static_cast<ErrorBehaviour>(values_.error_behaviour);
  if (behaviour == ErrorBehaviour::to_stopped) return NmtState::stopped;
  const bool leaves =
      behaviour == ErrorBehaviour::to_pre_operational && state_ == NmtState::operational;
  return leaves ? NmtState::pre_operational : state_;
}

void DeviceBase::run_event_timers(std::uint64_t now_us) {
  const Span<Pdo> pdos = pdos_.transmit();
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    const PdoParameters& p = pdos[i].parameters();
    const TransmitState& sent = transmit_state_[i];
    if (p.event_timer_ms == 0 || p.type < kEventType || !pdos[i].valid()) continue;
    const bool due =
        !sent.sent_any || now_us - sent.last_us >= 1000U * std::uint64_t{p.event_timer_ms};
    if (due) pending_ |= 1U << i;
  }
}

void DeviceBase::withdraw(std::size_t transmit_pdo) {
  pending_ &= ~(1U << transmit_pdo);
  for_sync_ &= ~(1U << transmit_pdo);
}

// What was under way through a PDO that has become invalid goes nowhere.
void DeviceBase::forget_invalid_pdos() {
  for (std::size_t i = 0; i < pdos_.receive().size(); ++i) {
    if (!pdos_.receive()[i].valid()) latest_[i] = {};
  }
  for (std::size_t i = 0; i < pdos_.transmit().size(); ++i) {
    if (pdos_.transmit()[i].valid()) continue;
    withdraw(i);
    transmit_state_[i] = {};
  }
}

void DeviceBase::trigger(std::size_t transmit_pdo) {
  if (state_ != NmtState::operational || !pdos_.transmit()[transmit_pdo].valid()) return;
  const std::uint8_t type = pdos_.transmit()[transmit_pdo].parameters().type;
  if (type >= kEventType) pending_ |= 1U << transmit_pdo;
  if (type == 0) for_sync_ |= 1U << transmit_pdo;
}

void DeviceBase::trigger_belated(std::size_t transmit_pdo) {
  trigger(transmit_pdo);
  pending_ |= for_sync_ & (1U << transmit_pdo);
  for_sync_ &= ~(1U << transmit_pdo);
}

void DeviceBase::trigger_synchronous() {
  const Span<Pdo> pdos = pdos_.transmit();
  pending_ |= for_sync_;
  for_sync_ = 0;
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    const std::uint8_t type = pdos[i].parameters().type;
    if (type == 0 || type > kMostCyclicType || !pdos[i].valid()) continue;
    std::uint8_t& syncs = transmit_state_[i].syncs;
    if (++syncs < type) continue;
    syncs = 0;
    pending_ |= 1U << i;
  }
}

bool DeviceBase::inhibited(std::size_t pdo, std::uint64_t now_us) const {
  const PdoParameters& p = pdos_.transmit()[pdo].parameters();
  const TransmitState& sent = transmit_state_[pdo];
  return p.type >= kEventType && sent.sent_any &&
         now_us - sent.last_us < 100U * std::uint64_t{p.inhibit_100us};
}

bool DeviceBase::offer_pdo(hal::CanFrame& frame, std::uint64_t now_us) {
  const Span<Pdo> pdos = pdos_.transmit();
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    if ((pending_ & (1U << i)) == 0 || inhibited(i, now_us)) continue;
    pdos[i].gather(frame);
    offered_pdo_ = i;
    return true;
  }
  return false;
}

// The most urgent first.
bool DeviceBase::offer(hal::CanFrame& frame, std::uint64_t now_us) {
  frame = {};
  if (state_ == NmtState::boot_up) return false;
  if (boot_up_due_) {
    frame.id = static_cast<std::uint16_t>(kHeartbeat + node_id_);
    frame.size = 1;
    offered_ = Offered::boot_up;
  } else if (sync_waiting_) {
    frame = sync_frame_;
    offered_ = Offered::sync;
  } else if (state_ != NmtState::stopped && emergency_.offer(now_us, frame)) {
    offered_ = Offered::emergency;
  } else if (pending_ != 0 && state_ == NmtState::operational && offer_pdo(frame, now_us)) {
    offered_ = Offered::pdo;
  } else if (sdo_waiting_ || (sdo_waiting_ = sdo_.response(sdo_response_))) {
    frame = {static_cast<std::uint16_t>(kSdoResponse + node_id_), 8, sdo_response_};
    offered_ = Offered::sdo;
  } else if (heartbeat_due_) {
    frame.id = static_cast<std::uint16_t>(kHeartbeat + node_id_);
    frame.size = 1;
    frame.data[0] = static_cast<std::uint8_t>(state_);
    offered_ = Offered::heartbeat;
  } else {
    offered_ = Offered::none;
  }
  return offered_ != Offered::none;
}

}  // namespace volcomp::canopen
