// The objects of a DeviceBase as SDO clients see them, and the rules of the communication objects.

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/device_base.hpp"

namespace volcomp::canopen {

AbortCode DeviceBase::read_pdo(ObjectId object, Span<const std::uint8_t>& source) {
  PdoTable::Value value;
  const AbortCode why = pdos_.read(object, value);
  if (why != AbortCode::none) return why;
  store_le(scratch_.data(), value.bytes, value.value);
  source = {scratch_.data(), value.bytes};
  return AbortCode::none;
}

// A copy, so that a segmented upload does not see a value change half-way.
AbortCode DeviceBase::copy_value(const ObjectDictionary::Found& found,
                                 Span<const std::uint8_t>& source) {
  source = {found.value, ObjectDictionary::size(*found.entry, found.value)};
  if (source.size() > scratch_.size()) return AbortCode::none;
  for (std::size_t i = 0; i < source.size(); ++i)
    scratch_[i] = source[i];
  source = {scratch_.data(), source.size()};
  return AbortCode::none;
}

AbortCode DeviceBase::room_for(ObjectId object, const ObjectDictionary::Found& found,
                               std::size_t announced, Span<std::uint8_t>& sink) {
  std::size_t most = 0;
  if (PdoTable::owns(object.index)) {
    std::uint8_t bytes = 0;
    const AbortCode why = pdos_.writable(object, bytes);
    if (why != AbortCode::none) return why;
    most = bytes;
  } else {
    most =
        found.entry->type() == DataType::visible_string ? found.entry->extra : found.entry->size();
  }
  sink = {scratch_.data(), std::min(most, scratch_.size())};
  return announced > sink.size() ? AbortCode::too_long : AbortCode::none;
}

bool DeviceBase::is_domain(ObjectId object) const {
  const Entry* const entry = objects_.find(object).entry;  // there is none for a PDO
  return entry != nullptr && entry->type() == DataType::domain;
}

// Rules of single communication objects that a range cannot express.
AbortCode DeviceBase::check_communication(ObjectId object, Span<const std::uint8_t> bytes) const {
  const auto value =
      static_cast<std::uint32_t>(load_le(bytes.data(), std::min<std::size_t>(bytes.size(), 4)));
  if (object.index == object::error_count.index && value != 0) return AbortCode::invalid_value;
  if (object.index == object::sync_cob_id.index) {
    const std::uint32_t id = value & ~Sync::kProduce;
    // CiA 301, table 40, restricts nothing of what SYNC and EMCY share; on its own EMCY a device
    // sends something else.
    const bool shared = id >= kSync && id < kTime && id != kEmergency + std::uint32_t{node_id_};
    if (id > hal::kMaxCanId || (!shared && restricted(static_cast<std::uint16_t>(id))))
      return AbortCode::invalid_value;
    // CiA 301, 7.5.2.5: the identifier may not change while SYNC is being produced.
    if (sync_.producing() && id != sync_.id()) return AbortCode::invalid_value;
  }
  if (object.index == object::sync_counter_overflow.index) {
    if (value == 1) return AbortCode::invalid_value;
    // CiA 301, 7.5.2.22. Stored values come back in the order of their indices.
    if (values_.cycle_period_us != 0 && state_ != NmtState::boot_up) return AbortCode::device_state;
  }
  if (object.index == object::consumer_heartbeat.index && (value & 0xFFFFU) != 0) {
    const std::uint32_t node = value >> 16U;
    if (node == 0 || node > kMaxNodeId) return AbortCode::none;  // CiA 301, 7.5.2.17: not used
    if (node == node_id_) return AbortCode::invalid_value;
    for (std::size_t i = 0; i < kHeartbeatConsumers; ++i) {
      const std::uint32_t other = values_.consumer_heartbeat[i];
      const bool same = (other >> 16U) == node && (other & 0xFFFFU) != 0;
      if (same && i + 1U != object.sub) return AbortCode::incompatible_parameter;
    }
  }
  return AbortCode::none;
}

void DeviceBase::communication_written(ObjectId object) {
  std::uint8_t lost_node = 0;
  switch (object.index) {
    case object::error_count.index:
      emergency_.clear_history();
      break;
    case object::sync_cob_id.index:
    case object::cycle_period_us.index:
    case object::sync_counter_overflow.index:
      sync_.reset();
      break;
    case object::consumer_heartbeat.index:
      if (heartbeats_.restart(object.sub, lost_node))
        emergency_.clear(ErrorCode::heartbeat, lost_node);
      break;
    case object::producer_heartbeat_ms.index:
      last_heartbeat_us_ = now_us_;
      break;
    default:
      break;
  }
}

}  // namespace volcomp::canopen
