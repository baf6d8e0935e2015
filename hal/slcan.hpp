#pragma once
// CAN frames as lines of text over a serial line, as LAWICEL adapters, slcand and python-can speak
// it (LAWICEL AB, "CAN232 manual", version 3).
//
//   t 123 2 11 22 \r    data frame, 11-bit identifier: id 3 digits, size 1, bytes 2 each, all hex
//   \r  \a              the device's answers: done, refused
//   S8 \r  O \r  C \r   bit rate, open, close; V N F Z: version, serial number, flags, time stamps
//
// CANopen has no use for 29-bit identifiers (T) and remote requests (r, R): they are refused.
// Nothing here does input or output, waits or allocates; every call is O(1).
//
//   SlcanDevice device;                              // the adapter's side, fed byte by byte
//   const SlcanRequest request = device.take(byte);
//   if (request.kind == SlcanRequest::Kind::answer) write(request.answer);
//   if (request.kind == SlcanRequest::Kind::frame)
//     write(queue.push(request.frame) ? kSlcanOk : kSlcanError);

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "hal/can_port.hpp"

namespace volcomp::hal {

inline constexpr char kSlcanOk = '\r';
inline constexpr char kSlcanError = '\a';

// A short text to be written as it is.
class SlcanText {
 public:
  // The longest there is: t, identifier, size, 8 bytes, end of line.
  static constexpr std::size_t kCapacity = 1 + 3 + 1 + 2 * 8 + 1;

  [[nodiscard]] const char* data() const { return text_.data(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  // Beyond the capacity nothing is added.
  void add(char c) {
    if (size_ < kCapacity) text_[size_++] = c;
  }
  // The lowest digits of the value, upper case, most significant first.
  void add_hex(std::uint32_t value, std::size_t digits);

 private:
  std::array<char, kCapacity> text_{};
  std::size_t size_ = 0;
};

// The frame as hal/can_port.hpp has it: id up to 0x7FF, size up to 8.
[[nodiscard]] SlcanText slcan_frame(const CanFrame& frame);

// Reads "t…" without its end of line; digits in either case. False, frame untouched, for everything
// else.
[[nodiscard]] bool parse_slcan_frame(Span<const char> line, CanFrame& frame);

// Collects a line byte by byte.
class SlcanLine {
 public:
  // The longest line of the protocol: T, identifier 8, size, 8 bytes, time stamp 4.
  static constexpr std::size_t kCapacity = 1 + 8 + 1 + 2 * 8 + 4;

  enum class Event : std::uint8_t {
    nothing,   // the line is not finished
    line,      // line() holds it, until the next byte; may be empty
    too_long,  // a line of more than kCapacity characters has ended; it is lost
    refused,   // the other side answered with kSlcanError
  };
  Event take(char c);
  [[nodiscard]] Span<const char> line() const { return {text_.data(), size_}; }

 private:
  std::array<char, kCapacity> text_{};
  std::size_t size_ = 0;
  bool too_long_ = false;
  bool finished_ = false;
};

// What an adapter has to do after a byte from its host.
struct SlcanRequest {
  enum class Kind : std::uint8_t {
    nothing,
    answer,  // write `answer`
    frame,   // send `frame`; write kSlcanOk when it was taken, else kSlcanError
  };
  Kind kind = Kind::nothing;
  SlcanText answer{};
  CanFrame frame{};
};

// The adapter's side: is the channel open, what is answered. Received frames may be written to the
// host only while it is open.
class SlcanDevice {
 public:
  // Bits of the answer to F, stored until they are read (manual, command F).
  enum Flag : std::uint8_t {
    receive_queue_full = 1U << 0U,
    transmit_queue_full = 1U << 1U,
    data_overrun = 1U << 3U,
  };

  // `serial`: the answer to N, 0…9999.
  explicit constexpr SlcanDevice(std::uint16_t serial = 0) : serial_(serial) {}

  [[nodiscard]] SlcanRequest take(char c);
  [[nodiscard]] bool open() const { return open_; }
  void raise(Flag flag) { flags_ = static_cast<std::uint8_t>(flags_ | flag); }

 private:
  [[nodiscard]] SlcanRequest take_line(Span<const char> line);
  [[nodiscard]] SlcanRequest take_frame(Span<const char> line) const;
  [[nodiscard]] bool set_bit_rate(Span<const char> line) const;
  [[nodiscard]] SlcanRequest set_open(bool open);
  [[nodiscard]] SlcanRequest tell_flags();
  [[nodiscard]] SlcanRequest tell_serial() const;

  SlcanLine line_;
  std::uint16_t serial_;
  std::uint8_t flags_ = 0;
  bool open_ = false;
};

}  // namespace volcomp::hal
