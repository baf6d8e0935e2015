#pragma once
// The members of Device that call the application, see device.hpp.

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/device.hpp"

namespace volcomp::canopen {

// --- life cycle

template <class Application>
void Device<Application>::power_on(std::uint64_t now_us) {
  now_us_ = now_us;
  restart(true, now_us);
}

template <class Application>
void Device<Application>::restart(bool application_too, std::uint64_t now_us) {
  begin_restart();
  if (application_too) application_.reset_application();
  application_.reset_communication();
  end_restart(now_us);
  enter(NmtState::pre_operational, now_us);
}

template <class Application>
void Device<Application>::enter(NmtState state, std::uint64_t now_us) {
  if (change_state(state)) application_.state_changed(state, now_us);
}

// --- in

template <class Application>
void Device<Application>::receive(const hal::CanFrame& frame, std::uint64_t now_us) {
  switch (work(frame)) {
    case Work::cyclic:
      return receive_cyclic(frame, now_us);
    case Work::service:
      return receive_service(frame, now_us);
    case Work::lengthy:
      return receive_lengthy(frame, now_us);
  }
}

template <class Application>
void Device<Application>::receive_cyclic(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!enter_call(now_us)) return;
  if (frame.id == sync_.id()) return take_sync(frame, now_us);
  if (frame.id == kTime) return take_time(frame);
  if (state_ == NmtState::operational) take_process_data(frame, now_us);
}

template <class Application>
void Device<Application>::receive_service(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!enter_call(now_us)) return;
  if (frame.id != kNmt) return take_heartbeat(frame, now_us);
  if (!commanded(frame)) return;
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  if (command == NmtCommand::start) enter(NmtState::operational, now_us);
  if (command == NmtCommand::stop) enter(NmtState::stopped, now_us);
  if (command == NmtCommand::enter_pre_operational) enter(NmtState::pre_operational, now_us);
}

template <class Application>
void Device<Application>::receive_lengthy(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (!enter_call(now_us)) return;
  if (frame.id != kNmt) {
    if (state_ != NmtState::stopped && frame.size == 8) sdo_.request(frame.data, now_us);
  } else if (commanded(frame)) {
    restart(static_cast<NmtCommand>(frame.data[0]) == NmtCommand::reset_node, now_us);
  }
}

template <class Application>
void Device<Application>::take_sync(const hal::CanFrame& frame, std::uint64_t now_us) {
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
template <class Application>
void Device<Application>::take_time(const hal::CanFrame& frame) {
  if (state_ == NmtState::stopped || frame.size != 6) return;
  const auto midnight_ms = static_cast<std::uint32_t>(load_le(frame.data.data(), 4) & 0x0FFF'FFFFU);
  application_.time_of_day(midnight_ms,
                           static_cast<std::uint16_t>(load_le(frame.data.data() + 4, 2)));
}

template <class Application>
void Device<Application>::run_cycle(std::uint64_t now_us) {
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

template <class Application>
void Device<Application>::take_process_data(const hal::CanFrame& frame, std::uint64_t now_us) {
  const Span<Pdo> pdos = pdos_.receive();
  const auto wanted = [id = frame.id](const Pdo& pdo) { return pdo.answers_to(id); };
  Pdo* pdo = std::find_if(pdos.begin(), pdos.end(), wanted);
  while (pdo != pdos.end()) {
    if (accept(static_cast<std::size_t>(pdo - pdos.begin()), frame, now_us))
      apply(*pdo, frame, now_us);
    pdo = std::find_if(pdo + 1, pdos.end(), wanted);
  }
}

template <class Application>
void Device<Application>::apply(const Pdo& pdo, const hal::CanFrame& frame, std::uint64_t now_us) {
  pdo.scatter(frame);
  application_.received(pdo, now_us);
}

template <class Application>
void Device<Application>::take_heartbeat(const hal::CanFrame& frame, std::uint64_t now_us) {
  if (frame.size != 1) return;
  const auto node = static_cast<std::uint8_t>(frame.id - kHeartbeat);
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7FU);
  HeartbeatEvent event{};
  if (!heartbeats_.heard(node, state, now_us, event)) return;
  emergency_.clear(ErrorCode::heartbeat, node);
  application_.heartbeat(node, event, now_us);
}

// --- time

template <class Application>
void Device<Application>::poll(std::uint64_t now_us) {
  poll_services(now_us);
  poll_cycle(now_us);
  if (state_ != NmtState::boot_up) application_.background(now_us);
}

template <class Application>
void Device<Application>::poll_services(std::uint64_t now_us) {
  if (!enter_call(now_us)) return;
  sdo_.poll(now_us);
  watch_heartbeats(now_us);
}

template <class Application>
void Device<Application>::poll_cycle(std::uint64_t now_us) {
  if (!enter_call(now_us)) return;
  run_own_timers(now_us);
  if (state_ != NmtState::stopped && sync_.due(now_us, sync_frame_)) {
    sync_waiting_ = true;
    if (state_ == NmtState::operational) run_cycle(now_us);
  }
  if (state_ == NmtState::operational) run_event_timers(now_us);
  application_.due(now_us);
}

template <class Application>
void Device<Application>::watch_heartbeats(std::uint64_t now_us) {
  std::uint8_t node = 0;
  for (std::size_t i = 0; i < kHeartbeatConsumers && heartbeats_.overdue(now_us, node); ++i) {
    emergency_.raise(ErrorCode::heartbeat, node);
    if (application_.heartbeat(node, HeartbeatEvent::lost, now_us))
      enter(state_after_error(), now_us);
  }
}

// --- out

template <class Application>
void Device<Application>::taken(std::uint64_t now_us) {
  now_us_ = now_us;
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
      application_.sent(offered_pdo_);
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

// --- objects

template <class Application>
AbortCode Device<Application>::begin_upload(ObjectId object, Span<const std::uint8_t>& source) {
  if (PdoTable::owns(object.index)) return read_pdo(object, source);
  const ObjectDictionary::Found found = objects_.find(object);
  if (found.why != AbortCode::none) return found.why;
  if (found.entry == nullptr) {
    scratch_[0] = found.highest_sub;
    source = {scratch_.data(), 1};
    return AbortCode::none;
  }
  if (!found.entry->readable()) return AbortCode::write_only;
  // CiA 301, 7.5.2.4: beyond the errors that have happened there is nothing to read.
  if (object.index == 0x1003 && object.sub > values_.error_count) return AbortCode::no_data;
  if (found.entry->type() == DataType::domain) return application_.read_domain(object, source);
  application_.before_read(object);
  return copy_value(found, source);
}

template <class Application>
AbortCode Device<Application>::begin_download(ObjectId object, std::size_t announced,
                                              Span<std::uint8_t>& sink) {
  ObjectDictionary::Found found;
  if (!PdoTable::owns(object.index)) {
    found = objects_.find(object);
    if (found.why != AbortCode::none) return found.why;
    if (found.entry == nullptr || !found.entry->writable()) return AbortCode::read_only;
    if (found.entry->type() == DataType::domain)
      return application_.begin_domain(object, announced, sink);
  }
  return room_for(object, found, announced, sink);
}

template <class Application>
AbortCode Device<Application>::finish_download(ObjectId object, std::size_t size) {
  if (is_domain(object)) return application_.finish_domain(object, size);
  return write(object, {scratch_.data(), size});
}

template <class Application>
void Device<Application>::abandon_download(ObjectId object) {
  if (is_domain(object)) application_.abandon_domain(object);
}

template <class Application>
AbortCode Device<Application>::write(ObjectId object, Span<const std::uint8_t> bytes) {
  if (!PdoTable::owns(object.index)) return store(object, bytes);
  const AbortCode result = pdos_.write(object, bytes, state_ == NmtState::operational);
  forget_invalid_pdos();
  return result;
}

template <class Application>
AbortCode Device<Application>::store(ObjectId object, Span<const std::uint8_t> bytes) {
  const ObjectDictionary::Found found = objects_.find(object);
  if (found.why != AbortCode::none) return found.why;
  if (found.entry == nullptr) return AbortCode::read_only;
  AbortCode why = objects_.check(*found.entry, bytes);
  if (why == AbortCode::none) why = check_communication(object, bytes);
  if (why == AbortCode::none) why = application_.before_write(object, bytes);
  if (why != AbortCode::none) return why;
  if (found.value != nullptr) ObjectDictionary::assign(*found.entry, found.value, bytes);
  communication_written(object);
  application_.written(object, now_us_);
  return AbortCode::none;
}

}  // namespace volcomp::canopen
