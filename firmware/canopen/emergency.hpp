#pragma once
// Emergency messages (CiA 301, section 7.2.7): one when an error appears, one with code 0000h when
// it has gone, never closer together than the inhibit time; the history of 1003h.

#include <array>
#include <cstdint>

#include "firmware/canopen/communication_objects.hpp"
#include "hal/can_port.hpp"

namespace volcomp::canopen {

// Error codes of CiA 301 table 26 and of this device; what each means stands in codes.def.
enum class ErrorCode : std::uint16_t {
#define ERROR_CODE(number, name, title, sentence) name = (number),
#include "firmware/canopen/codes.def"
};

// One plain sentence; also for codes another device made up.
[[nodiscard]] const char* sentence(ErrorCode code);

// Bits of the error register 1001h.
enum ErrorRegister : std::uint8_t {
  kGenericError = 1U << 0U,
  kTemperatureError = 1U << 3U,
  kCommunicationError = 1U << 4U,
  kManufacturerError = 1U << 7U,
};

using ErrorInfo = std::array<std::uint8_t, 5>;

class Emergency {
 public:
  // `objects` holds 1001h, 1003h, 1014h and 1015h.
  explicit Emergency(CommunicationObjects& objects) : objects_(objects) {}

  // An error appeared or is still there. `source` distinguishes errors with the same code (axis,
  // node id); it is the first byte of the manufacturer-specific field. Reported once until cleared.
  void raise(ErrorCode code, std::uint8_t source, const std::array<std::uint8_t, 4>& detail = {});
  // The error has gone; does nothing when it was not active.
  void clear(ErrorCode code, std::uint8_t source);
  [[nodiscard]] bool active(ErrorCode code, std::uint8_t source) const;

  // The next message, when there is one and the inhibit time has passed since the last.
  [[nodiscard]] bool offer(std::uint64_t now_us, hal::CanFrame& frame) const;
  void taken(std::uint64_t now_us);
  // From when on offer() has a frame; 0: now; UINT64_MAX: never.
  [[nodiscard]] std::uint64_t sends_at_us() const {
    if (queued_ == 0) return UINT64_MAX;
    return sent_any_ ? last_sent_us_ + 100U * std::uint64_t{objects_.emergency_inhibit_100us} : 0;
  }

  void clear_history();
  void reset();

  // Messages that found the queue full: the history has them all the same.
  [[nodiscard]] std::uint16_t dropped() const { return dropped_; }

 private:
  struct Active {
    ErrorCode code = ErrorCode::none;
    std::uint8_t source = 0;
  };
  struct Message {
    ErrorCode code = ErrorCode::none;
    std::uint8_t error_register = 0;
    ErrorInfo info{};
  };
  static constexpr std::size_t kMostActive = 64;
  static constexpr std::size_t kQueue = 16;

  void refresh_register();
  void enqueue(const Message& message);

  CommunicationObjects& objects_;
  std::array<Active, kMostActive> active_{};
  std::size_t active_count_ = 0;
  std::array<Message, kQueue> queue_{};
  std::size_t first_ = 0;
  std::size_t queued_ = 0;
  std::uint64_t last_sent_us_ = 0;
  bool sent_any_ = false;
  std::uint16_t dropped_ = 0;
};

}  // namespace volcomp::canopen
