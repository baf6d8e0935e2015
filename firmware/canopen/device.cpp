#include "firmware/canopen/device.hpp"

#include <algorithm>

#include "firmware/canopen/bytes.hpp"

namespace volcomp::canopen {

Device::Device(const Parts& parts, Application& application)
    : values_(*parts.values),
      application_(application),
      objects_(parts.dictionary, parts.values),
      pdos_(parts.receive, parts.transmit, parts.timed, objects_),
      sync_(values_),
      emergency_(values_),
      heartbeats_(values_),
      sdo_(*this) {}

// --- life cycle

void Device::power_on(std::uint64_t now_us) {
  now_us_ = now_us;
  restart(true, now_us);
}

void Device::restart(bool application_too, std::uint64_t now_us) {
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
  if (application_too) application_.reset_application();
  application_.reset_communication();
  values_.emergency_cob_id = kEmergency + std::uint32_t{node_id_};
  values_.sdo_cob_id = {kSdoRequest + std::uint32_t{node_id_},
                        kSdoResponse + std::uint32_t{node_id_}};
  boot_up_due_ = true;
  last_heartbeat_us_ = now_us;
  enter(NmtState::pre_operational, now_us);
}

void Device::enter(NmtState state, std::uint64_t now_us) {
  if (state == state_) return;
  state_ = state;
  latest_ = {};
  pending_ = for_sync_ = 0;
  if (state == NmtState::operational) transmit_state_ = {};
  if (state == NmtState::stopped) fall_silent();
  application_.state_changed(state, now_us);
}

// STOPPED knows neither SDO nor SYNC (CiA 301, section 7.3.2.2): nothing that waits may leave, and
// afterwards the SYNC counter begins anew, because nobody has followed it.
void Device::fall_silent() {
  sdo_.reset();
  sync_.reset();
  sdo_waiting_ = sync_waiting_ = false;
}

// --- in

// By the identifier and the NMT command alone, so that the answer never depends on what is just
// being changed.
Device::Work Device::work(const hal::CanFrame& frame) const {
  const std::uint16_t id = frame.id;
  if (id == kSdoRequest + node_id_) return Work::lengthy;
  if (id > kHeartbeat && id <= kHeartbeat + kMaxNodeId) return Work::service;
  if (id != kNmt) return Work::cyclic;
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  const bool resets =
      command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  return resets ? Work::lengthy : Work::service;
}

void Device::receive(const hal::CanFrame& frame, std::uint64_t now_us) {
  switch (work(frame)) {
    case Work::cyclic:
      return receive_cyclic(frame, now_us);
    case Work::service:
      return receive_service(frame, now_us);
    case Work::lengthy:
      return receive_lengthy(frame, now_us);
  }
}

bool Device::hears(std::uint64_t now_us) {
  if (state_ == NmtState::boot_up) return false;
  now_us_ = now_us;
  return true;
}

bool Device::commanded(const hal::CanFrame& frame) const {
  return frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == node_id_);
}

void Device::receive_cyclic(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!hears(now_us)) return;
  if (frame.id == sync_.id()) return take_sync(frame, now_us);
  if (frame.id == kTime) return take_time(frame);
  if (state_ == NmtState::operational) take_process_data(frame, now_us);
}

void Device::receive_service(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!hears(now_us)) return;
  if (frame.id != kNmt) return take_heartbeat(frame, now_us);
  if (!commanded(frame)) return;
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  if (command == NmtCommand::start) enter(NmtState::operational, now_us);
  if (command == NmtCommand::stop) enter(NmtState::stopped, now_us);
  if (command == NmtCommand::enter_pre_operational) enter(NmtState::pre_operational, now_us);
}

void Device::receive_lengthy(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!hears(now_us)) return;
  if (frame.id != kNmt) {
    if (state_ != NmtState::stopped && frame.size == 8) sdo_.request(frame.data, now_us);
  } else if (commanded(frame)) {
    restart(static_cast<NmtCommand>(frame.data[0]) == NmtCommand::reset_node, now_us);
  }
}

void Device::take_sync(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (state_ == NmtState::stopped) return;
  // Nobody else may produce it beside us: step back rather than drive the axes at twice the rate.
  if (sync_.producing()) {
    sync_.stop_producing();
    sync_waiting_ = false;
    application_.bad_sync(SyncVerdict::foreign, now_us);
    return;
  }
  const SyncVerdict verdict = sync_.received(frame);
  if (verdict != SyncVerdict::good) {
    application_.bad_sync(verdict, now_us);
    return;
  }
  if (state_ == NmtState::operational) run_cycle(now_us);
}

// The upper four of its first 32 bits are reserved.
void Device::take_time(const hal::CanFrame& frame) {
  if (state_ == NmtState::stopped || frame.size != 6) return;
  const auto midnight_ms = static_cast<std::uint32_t>(load_le(frame.data.data(), 4) & 0x0FFF'FFFFU);
  application_.time_of_day(midnight_ms,
                           static_cast<std::uint16_t>(load_le(frame.data.data() + 4, 2)));
}

void Device::run_cycle(std::uint64_t now_us) {
  last_sync_us_ = now_us;
  const Span<Pdo> pdos = pdos_.receive();
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    if (!latest_[i].waiting) continue;
    latest_[i].waiting = false;
    apply(pdos[i], latest_[i].frame, now_us);
  }
  application_.sync(sync_.counter(), now_us);
  trigger_synchronous();
}

void Device::take_process_data(const hal::CanFrame& frame, std::uint64_t now_us) {
  const Span<Pdo> pdos = pdos_.receive();
  const auto wanted = [id = frame.id](const Pdo& pdo) { return pdo.answers_to(id); };
  Pdo* pdo = std::find_if(pdos.begin(), pdos.end(), wanted);
  while (pdo != pdos.end()) {
    take_process_data(static_cast<std::size_t>(pdo - pdos.begin()), frame, now_us);
    pdo = std::find_if(pdo + 1, pdos.end(), wanted);
  }
}

void Device::take_process_data(std::size_t receive_pdo, const hal::CanFrame& frame,
                               std::uint64_t now_us) {
  const Pdo& pdo = pdos_.receive()[receive_pdo];
  const auto source = static_cast<std::uint8_t>(receive_pdo + 1);
  if (frame.size < pdo.bytes()) {
    emergency_.raise(ErrorCode::rpdo_length, source, {frame.size, pdo.bytes()});
    return;
  }
  emergency_.clear(ErrorCode::rpdo_length, source);
  if (!pdo.synchronous()) {
    apply(pdo, frame, now_us);
  } else if (values_.sync_window_us == 0 || now_us - last_sync_us_ <= values_.sync_window_us) {
    latest_[receive_pdo] = {frame, true};
  }
}

void Device::apply(const Pdo& pdo, const hal::CanFrame& frame, std::uint64_t now_us) {
  pdo.scatter(frame);
  application_.received(pdo, now_us);
}

void Device::take_heartbeat(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (frame.size != 1) return;
  const auto node = static_cast<std::uint8_t>(frame.id - kHeartbeat);
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7FU);
  HeartbeatEvent event{};
  if (!heartbeats_.heard(node, state, now_us, event)) return;
  emergency_.clear(ErrorCode::heartbeat, node);
  application_.heartbeat(node, event, now_us);
}

// --- time

void Device::poll_services(std::uint64_t now_us) {
  if (!hears(now_us)) return;
  sdo_.poll(now_us);
  watch_heartbeats(now_us);
}

void Device::poll_cycle(std::uint64_t now_us) {
  if (!hears(now_us)) return;
  const std::uint64_t period_us = 1000U * std::uint64_t{values_.producer_heartbeat_ms};
  if (period_us != 0 && now_us - last_heartbeat_us_ >= period_us) {
    heartbeat_due_ = true;
    last_heartbeat_us_ = now_us;
  }
  if (state_ != NmtState::stopped && sync_.due(now_us, sync_frame_)) {
    sync_waiting_ = true;
    if (state_ == NmtState::operational) run_cycle(now_us);
  }
  if (state_ == NmtState::operational) run_event_timers(now_us);
}

void Device::watch_heartbeats(std::uint64_t now_us) {
  std::uint8_t node = 0;
  for (std::size_t i = 0; i < kHeartbeatConsumers && heartbeats_.overdue(now_us, node); ++i) {
    emergency_.raise(ErrorCode::heartbeat, node);
    if (application_.heartbeat(node, HeartbeatEvent::lost, now_us)) communication_error(now_us);
  }
}

// 1029h (CiA 301, section 7.5.2.31).
void Device::communication_error(std::uint64_t now_us) {
  const auto behaviour = static_cast<ErrorBehaviour>(values_.error_behaviour);
  if (behaviour == ErrorBehaviour::to_stopped) {
    enter(NmtState::stopped, now_us);
  } else if (behaviour == ErrorBehaviour::to_pre_operational && state_ == NmtState::operational) {
    enter(NmtState::pre_operational, now_us);
  }
}

void Device::run_event_timers(std::uint64_t now_us) {
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

// --- process data out

void Device::withdraw(std::size_t transmit_pdo) {
  pending_ &= ~(1U << transmit_pdo);
  for_sync_ &= ~(1U << transmit_pdo);
}

// What was under way through a PDO that has become invalid goes nowhere.
void Device::forget_invalid_pdos() {
  for (std::size_t i = 0; i < pdos_.receive().size(); ++i) {
    if (!pdos_.receive()[i].valid()) latest_[i] = {};
  }
  for (std::size_t i = 0; i < pdos_.transmit().size(); ++i) {
    if (pdos_.transmit()[i].valid()) continue;
    withdraw(i);
    transmit_state_[i] = {};
  }
}

void Device::trigger(std::size_t transmit_pdo) {
  if (state_ != NmtState::operational || !pdos_.transmit()[transmit_pdo].valid()) return;
  const std::uint8_t type = pdos_.transmit()[transmit_pdo].parameters().type;
  if (type >= kEventType) pending_ |= 1U << transmit_pdo;
  if (type == 0) for_sync_ |= 1U << transmit_pdo;
}

void Device::trigger_belated(std::size_t transmit_pdo) {
  trigger(transmit_pdo);
  pending_ |= for_sync_ & (1U << transmit_pdo);
  for_sync_ &= ~(1U << transmit_pdo);
}

void Device::trigger_synchronous() {
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

bool Device::inhibited(std::size_t pdo, std::uint64_t now_us) const {
  const PdoParameters& p = pdos_.transmit()[pdo].parameters();
  const TransmitState& sent = transmit_state_[pdo];
  return p.type >= kEventType && sent.sent_any &&
         now_us - sent.last_us < 100U * std::uint64_t{p.inhibit_100us};
}

bool Device::offer_pdo(hal::CanFrame& frame, std::uint64_t now_us) {
  const Span<Pdo> pdos = pdos_.transmit();
  for (std::size_t i = 0; pending_ != 0 && i < pdos.size(); ++i) {
    if ((pending_ & (1U << i)) == 0 || inhibited(i, now_us)) continue;
    pdos[i].gather(frame);
    offered_pdo_ = i;
    return true;
  }
  return false;
}

// The most urgent first.
bool Device::offer(hal::CanFrame& frame, std::uint64_t now_us) {
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
  } else if (state_ == NmtState::operational && offer_pdo(frame, now_us)) {
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

void Device::taken(std::uint64_t now_us) {
  switch (offered_) {
    case Offered::boot_up:
      boot_up_due_ = false;
      break;
    case Offered::sync:
      sync_waiting_ = false;
      break;
    case Offered::emergency:
      emergency_.taken(now_us);
      break;
    case Offered::pdo:
      pending_ &= ~(1U << offered_pdo_);
      transmit_state_[offered_pdo_].last_us = now_us;
      transmit_state_[offered_pdo_].sent_any = true;
      break;
    case Offered::sdo:
      sdo_waiting_ = false;
      break;
    case Offered::heartbeat:
      heartbeat_due_ = false;
      break;
    case Offered::none:
      break;
  }
  offered_ = Offered::none;
}

}  // namespace volcomp::canopen
