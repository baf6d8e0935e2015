#include "firmware/canopen/emergency.hpp"

#include "comp/core/bytes.hpp"

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
#define ERROR_CODE(number, name, title, sentence) \
  case ErrorCode::name:                           \
    return sentence;
#include "firmware/canopen/codes.def"
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
