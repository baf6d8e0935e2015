#include "firmware/canopen/emergency.hpp"

#include "firmware/canopen/bytes.hpp"

namespace volcomp::canopen {
namespace {

std::uint8_t register_bit(ErrorCode code) {
  const auto value = static_cast<std::uint16_t>(code);
  if ((value & 0xFF00U) == 0xFF00U) return kManufacturerError;
  if ((value & 0xF000U) == 0x4000U) return kTemperatureError;
  return (value & 0xF000U) == 0x8000U ? std::uint8_t{kCommunicationError} : std::uint8_t{0};
}

}  // namespace

const char* sentence(ErrorCode code) {
  switch (code) {
    case ErrorCode::none:
      return "No error.";
    case ErrorCode::temperature_held:
      return "A temperature is missing or not plausible; the last good one is used.";
    case ErrorCode::memory_damaged:
      return "Settings changed in memory; corrections were taken back to zero.";
    case ErrorCode::program_damaged:
      return "The program changed in memory; corrections were ramped to zero.";
    case ErrorCode::store_failed:
      return "Parameters and tables could not be saved or forgotten; what was stored stays.";
    case ErrorCode::unexpected_reset:
      return "The device restarted without being asked to.";
    case ErrorCode::background_overdue:
      return "The background of the device hangs; corrections were ramped to zero.";
    case ErrorCode::parameters_lost:
      return "The stored parameters and tables were damaged.";
    case ErrorCode::can_overrun:
      return "Messages were lost before they could be read.";
    case ErrorCode::can_passive:
      return "The CAN controller counted so many errors that it is error passive.";
    case ErrorCode::heartbeat:
      return "A node that is watched fell silent.";
    case ErrorCode::bus_off_recovered:
      return "The CAN controller was bus-off, heard and sent nothing meanwhile, and is back.";
    case ErrorCode::sync_length:
      return "SYNC came with a counter where none is expected, or without one.";
    case ErrorCode::rpdo_length:
      return "Process data were shorter than their mapping.";
    case ErrorCode::rpdo_timeout:
      return "Process data of an axis did not come in time; its offset is held, then ramped down.";
    case ErrorCode::axis_not_referenced:
      return "An axis is not referenced or its drive is not enabled; it gets no correction.";
    case ErrorCode::axis_implausible:
      return "The position of an axis jumped faster than the axis can move.";
    case ErrorCode::axis_clamped:
      return "The correction of an axis reached its limit.";
    case ErrorCode::axis_out_of_range:
      return "An axis is more than half a pitch beyond its table.";
    case ErrorCode::no_authority:
      return "In this position the correcting axes cannot remove the error.";
    case ErrorCode::table_refused:
      return "A table image was refused.";
    case ErrorCode::table_damaged:
      return "The active tables changed in memory; corrections were ramped to zero.";
    case ErrorCode::tables_expired:
      return "The active tables are past their expiry; they stay active, measure the machine "
             "again.";
    case ErrorCode::time_doubted:
      return "TIME jumped; the device keeps its own date.";
    case ErrorCode::foreign_sync:
      return "A second device produces SYNC.";
    case ErrorCode::offset_not_confirmed:
      return "A drive does not report the offset it was sent.";
    case ErrorCode::touch_rejected:
      return "A touch of the probe was rejected.";
    case ErrorCode::point_lost:
      return "A probed point was lost: the points that wait are not read.";
  }
  return "An error of another device's making.";
}

bool Emergency::active(ErrorCode code, std::uint8_t source) const {
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (active_[i].code == code && active_[i].source == source) return true;
  }
  return false;
}

// The generic bit is set as long as there is any error (CiA 301, 7.5.2.2).
void Emergency::refresh_register() {
  std::uint8_t bits = active_count_ == 0 ? std::uint8_t{0} : std::uint8_t{kGenericError};
  for (std::size_t i = 0; i < active_count_; ++i)
    bits = static_cast<std::uint8_t>(bits | register_bit(active_[i].code));
  objects_.error_register = bits;
}

void Emergency::enqueue(const Message& message) {
  if (queued_ == kQueue) {
    if (dropped_ < UINT16_MAX) ++dropped_;
    return;
  }
  queue_[(first_ + queued_) % kQueue] = message;
  ++queued_;
}

void Emergency::raise(ErrorCode code, std::uint8_t source,
                      const std::array<std::uint8_t, 4>& detail) {
  if (active(code, source) || active_count_ == kMostActive) return;
  active_[active_count_++] = {code, source};
  refresh_register();
  enqueue({code, objects_.error_register, {source, detail[0], detail[1], detail[2], detail[3]}});
  for (std::size_t i = kErrorHistory - 1; i > 0; --i)
    objects_.error_history[i] = objects_.error_history[i - 1];
  objects_.error_history[0] = static_cast<std::uint32_t>(code) | (std::uint32_t{source} << 16U);
  if (objects_.error_count < kErrorHistory) ++objects_.error_count;
}

void Emergency::clear(ErrorCode code, std::uint8_t source) {
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (active_[i].code != code || active_[i].source != source) continue;
    active_[i] = active_[--active_count_];
    refresh_register();
    ErrorInfo gone{source};
    store_le(&gone[1], 2, static_cast<std::uint16_t>(code));
    enqueue({ErrorCode::none, objects_.error_register, gone});
    return;
  }
}

bool Emergency::offer(std::uint64_t now_us, hal::CanFrame& frame) const {
  if (queued_ == 0) return false;
  const std::uint64_t inhibit_us = 100U * std::uint64_t{objects_.emergency_inhibit_100us};
  if (sent_any_ && now_us - last_sent_us_ < inhibit_us) return false;
  const Message& message = queue_[first_];
  frame.id = static_cast<std::uint16_t>(objects_.emergency_cob_id & hal::kMaxCanId);
  frame.size = 8;
  store_le(frame.data.data(), 2, static_cast<std::uint16_t>(message.code));
  frame.data[2] = message.error_register;
  for (std::size_t i = 0; i < message.info.size(); ++i)
    frame.data[3 + i] = message.info[i];
  return true;
}

void Emergency::taken(std::uint64_t now_us) {
  first_ = (first_ + 1) % kQueue;
  --queued_;
  last_sent_us_ = now_us;
  sent_any_ = true;
}

void Emergency::clear_history() {
  objects_.error_history = {};
  objects_.error_count = 0;
}

void Emergency::reset() {
  active_count_ = 0;
  queued_ = 0;
  sent_any_ = false;
  refresh_register();
}

}  // namespace volcomp::canopen
