#pragma once
// Emergency messages (CiA 301, section 7.2.7): one when an error appears, one with code 0000h when
// it has gone, never closer together than the inhibit time; the history of 1003h.

#include <array>
#include <cstdint>

#include "firmware/canopen/communication_objects.hpp"
#include "hal/can_port.hpp"

namespace volcomp::canopen {

// Error codes of CiA 301 table 26 and of this device.
enum class ErrorCode : std::uint16_t {
  none = 0x0000,
  temperature_held = 0x4100,      // CiA 301: ambient temperature; source: input, reason in 2701h
  memory_damaged = 0x5510,        // CiA 402: working memory; source: axis, 0: several
  program_damaged = 0x5520,       // CiA 402: program memory changed
  store_failed = 0x5530,          // 1010h or 1011h: non-volatile memory; reason in 2600h:0C
  unexpected_reset = 0x6010,      // CiA 402: software reset (watchdog); first byte: ResetCause
  background_overdue = 0x6100,    // internal software: the background hangs
  parameters_lost = 0x6310,       // 1010h: stored parameters damaged
  can_overrun = 0x8110,           // frames were lost before they could be read
  can_passive = 0x8120,           // CAN controller in error passive mode
  heartbeat = 0x8130,             // a monitored node fell silent
  bus_off_recovered = 0x8140,     // the CAN controller is back from bus-off
  sync_length = 0x8240,           // SYNC with or without counter against 1019h
  rpdo_length = 0x8210,           // PDO shorter than its mapping
  rpdo_timeout = 0x8250,          // process data of an axis missing
  axis_not_referenced = 0xFF01,   // not homed or not enabled
  axis_implausible = 0xFF02,      // position jumped
  axis_clamped = 0xFF03,          // correction limited
  axis_out_of_range = 0xFF04,     // more than half a pitch beyond its table
  no_authority = 0xFF05,          // the correcting axes cannot act here
  table_refused = 0xFF10,         // reason in 2112h
  table_damaged = 0xFF11,         // active tables changed in memory
  tables_expired = 0xFF12,        // active tables are past their expiry: 2704h
  time_doubted = 0xFF13,          // TIME jumped
  foreign_sync = 0xFF20,          // a second SYNC producer
  offset_not_confirmed = 0xFF21,  // a drive does not report the offset it was sent
  touch_rejected = 0xFF30,        // first byte: TouchVerdict; then the number of the touch
  point_lost = 0xFF31,            // 2410h is full because no client reads it
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
