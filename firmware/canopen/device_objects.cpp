// What SDO clients see of a Device.

#include <algorithm>

#include "firmware/canopen/bytes.hpp"
#include "firmware/canopen/device.hpp"

namespace volcomp::canopen {

AbortCode Device::begin_upload(ObjectId object, Span<const std::uint8_t>& source) {
  if (PdoTable::owns(object.index)) {
    PdoTable::Value value;
    const AbortCode why = pdos_.read(object, value);
    if (why != AbortCode::none) return why;
    store_le(scratch_.data(), value.bytes, value.value);
    source = {scratch_.data(), value.bytes};
    return AbortCode::none;
  }
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
  if (found.entry->type == DataType::domain) return application_.read_domain(object, source);
  application_.before_read(object);
  source = {found.value, ObjectDictionary::size(*found.entry, found.value)};
  // A copy, so that a segmented upload does not see a value change half-way.
  if (source.size() > scratch_.size()) return AbortCode::none;
  for (std::size_t i = 0; i < source.size(); ++i)
    scratch_[i] = source[i];
  source = {scratch_.data(), source.size()};
  return AbortCode::none;
}

AbortCode Device::begin_download(ObjectId object, std::size_t announced, Span<std::uint8_t>& sink) {
  std::size_t most = 0;
  if (PdoTable::owns(object.index)) {
    std::uint8_t bytes = 0;
    const AbortCode why = pdos_.writable(object, bytes);
    if (why != AbortCode::none) return why;
    most = bytes;
  } else {
    const ObjectDictionary::Found found = objects_.find(object);
    if (found.why != AbortCode::none) return found.why;
    if (found.entry == nullptr || !found.entry->writable()) return AbortCode::read_only;
    if (found.entry->type == DataType::domain)
      return application_.begin_domain(object, announced, sink);
    most = found.entry->type == DataType::visible_string ? found.entry->extra
                                                         : size_of(found.entry->type);
  }
  sink = {scratch_.data(), std::min(most, scratch_.size())};
  return announced > sink.size() ? AbortCode::too_long : AbortCode::none;
}

AbortCode Device::finish_download(ObjectId object, std::size_t size) {
  const ObjectDictionary::Found found = objects_.find(object);
  if (!PdoTable::owns(object.index) && found.entry != nullptr &&
      found.entry->type == DataType::domain)
    return application_.finish_domain(object, size);
  return write(object, {scratch_.data(), size});
}

void Device::abandon_download(ObjectId object) {
  const ObjectDictionary::Found found = objects_.find(object);
  if (PdoTable::owns(object.index) || found.entry == nullptr) return;
  if (found.entry->type == DataType::domain) application_.abandon_domain(object);
}

AbortCode Device::write(ObjectId object, Span<const std::uint8_t> bytes) {
  if (!PdoTable::owns(object.index)) return store(object, bytes);
  std::uint8_t wanted = 0;
  const AbortCode why = pdos_.writable(object, wanted);
  if (why != AbortCode::none) return why;
  if (bytes.size() != wanted) return AbortCode::wrong_length;
  const auto value = static_cast<std::uint32_t>(load_le(bytes.data(), wanted));
  const AbortCode result = pdos_.write(object, value);
  forget_invalid_pdos();
  return result;
}

AbortCode Device::store(ObjectId object, Span<const std::uint8_t> bytes) {
  const ObjectDictionary::Found found = objects_.find(object);
  if (found.why != AbortCode::none) return found.why;
  if (found.entry == nullptr) return AbortCode::read_only;
  AbortCode why = objects_.check(*found.entry, bytes);
  if (why == AbortCode::none) why = check_communication(object, bytes);
  if (why == AbortCode::none) why = application_.before_write(object, *found.entry, bytes);
  if (why != AbortCode::none) return why;
  if (found.value != nullptr) ObjectDictionary::assign(*found.entry, found.value, bytes);
  communication_written(object);
  application_.written(object, now_us_);
  return AbortCode::none;
}

// Rules of single communication objects that a range cannot express.
AbortCode Device::check_communication(ObjectId object, Span<const std::uint8_t> bytes) const {
  const std::uint64_t value = load_le(bytes.data(), bytes.size() <= 8 ? bytes.size() : 8);
  if (object.index == 0x1003 && value != 0) return AbortCode::invalid_value;
  if (object.index == 0x1005) {
    const std::uint64_t id = value & ~std::uint64_t{Sync::kProduce};
    if (id > hal::kMaxCanId || (id != kSync && restricted(static_cast<std::uint16_t>(id))))
      return AbortCode::invalid_value;
    // CiA 301, 7.5.2.5: the identifier may not change while SYNC is being produced.
    if (sync_.producing() && id != sync_.id()) return AbortCode::invalid_value;
  }
  if (object.index == 0x1019) {
    if (value == 1) return AbortCode::invalid_value;
    // CiA 301, 7.5.2.22. Stored values come back in the order of their indices.
    if (values_.cycle_period_us != 0 && state_ != NmtState::boot_up) return AbortCode::device_state;
  }
  if (object.index == 0x1016 && (value & 0xFFFFU) != 0) {
    const std::uint64_t node = value >> 16U;
    if (node == 0) return AbortCode::none;  // CiA 301, 7.5.2.17: not used
    if (node == node_id_) return AbortCode::invalid_value;
    for (std::size_t i = 0; i < kHeartbeatConsumers; ++i) {
      const std::uint32_t other = values_.consumer_heartbeat[i];
      const bool same = (other >> 16U) == node && (other & 0xFFFFU) != 0;
      if (same && i + 1U != object.sub) return AbortCode::incompatible_parameter;
    }
  }
  return AbortCode::none;
}

void Device::communication_written(ObjectId object) {
  std::uint8_t lost_node = 0;
  switch (object.index) {
    case 0x1003:
      emergency_.clear_history();
      break;
    case 0x1005:
    case 0x1006:
    case 0x1019:
      sync_.reset();
      break;
    case 0x1016:
      if (heartbeats_.restart(object.sub, lost_node))
        emergency_.clear(ErrorCode::heartbeat, lost_node);
      break;
    case 0x1017:
      last_heartbeat_us_ = now_us_;
      break;
    default:
      break;
  }
}

}  // namespace volcomp::canopen
