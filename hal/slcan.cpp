#include "hal/slcan.hpp"

namespace volcomp::hal {
namespace {

// Hardware and software version as V wants them: two digits each.
constexpr std::uint32_t kVersion = 0x0101;
constexpr std::size_t kIdDigits = 3;

constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

// False when one of the characters is no digit.
bool read_hex(Span<const char> line, std::size_t at, std::size_t digits, std::uint32_t& value) {
  value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const int digit = hex_digit(line[at + i]);
    if (digit < 0) return false;
    value = value << 4U | static_cast<std::uint32_t>(digit);
  }
  return true;
}

SlcanRequest answer(char c) {
  SlcanRequest request;
  request.kind = SlcanRequest::Kind::answer;
  request.answer.add(c);
  return request;
}

SlcanRequest judged(bool done) { return answer(done ? kSlcanOk : kSlcanError); }

// A letter, digits of its own, end of line.
SlcanRequest tell(char letter, std::uint32_t value, std::size_t digits) {
  SlcanRequest request = answer(letter);
  request.answer.add_hex(value, digits);
  request.answer.add(kSlcanOk);
  return request;
}

}  // namespace

void SlcanText::add_hex(std::uint32_t value, std::size_t digits) {
  static constexpr std::array<char, 16> kDigits{'0', '1', '2', '3', '4', '5', '6', '7',
                                                '8', '9', 'A', 'B', 'C', 'D', 'E', 'F'};
  for (std::size_t left = digits; left > 0; --left)
    add(kDigits[value >> 4U * (left - 1) & 0xFU]);
}

SlcanText slcan_frame(const CanFrame& frame) {
  SlcanText text;
  text.add('t');
  text.add_hex(frame.id, kIdDigits);
  text.add_hex(frame.size, 1);
  for (std::size_t i = 0; i < frame.size && i < frame.data.size(); ++i)
    text.add_hex(frame.data[i], 2);
  text.add('\r');
  return text;
}

bool parse_slcan_frame(Span<const char> line, CanFrame& frame) {
  constexpr std::size_t kData = 1 + kIdDigits + 1;
  if (line.size() < kData || line[0] != 't') return false;
  std::uint32_t id = 0;
  std::uint32_t size = 0;
  if (!read_hex(line, 1, kIdDigits, id) || id > kMaxCanId) return false;
  if (!read_hex(line, 1 + kIdDigits, 1, size) || size > frame.data.size()) return false;
  if (line.size() != kData + 2 * std::size_t{size}) return false;
  CanFrame read;
  read.id = static_cast<std::uint16_t>(id);
  read.size = static_cast<std::uint8_t>(size);
  for (std::size_t i = 0; i < size; ++i) {
    std::uint32_t byte = 0;
    if (!read_hex(line, kData + 2 * i, 2, byte)) return false;
    read.data[i] = static_cast<std::uint8_t>(byte);
  }
  frame = read;
  return true;
}

SlcanLine::Event SlcanLine::take(char c) {
  if (finished_) size_ = 0;
  finished_ = false;
  if (c == kSlcanError) return Event::refused;
  if (c == '\r') {
    const bool lost = too_long_;
    too_long_ = false;
    finished_ = true;
    if (lost) size_ = 0;
    return lost ? Event::too_long : Event::line;
  }
  if (size_ == kCapacity) {
    too_long_ = true;
  } else {
    text_[size_++] = c;
  }
  return Event::nothing;
}

SlcanRequest SlcanDevice::take(char c) {
  const SlcanLine::Event event = line_.take(c);
  if (event == SlcanLine::Event::line) return take_line(line_.line());
  if (event == SlcanLine::Event::too_long) return answer(kSlcanError);
  return {};  // a host does not refuse; its line goes on
}

// Hosts send empty lines to end whatever was begun before; they wait for no answer.
SlcanRequest SlcanDevice::take_line(Span<const char> line) {
  if (line.empty()) return {};
  const bool alone = line.size() == 1;
  switch (line[0]) {
    case 't':
      return take_frame(line);
    case 'S':
      return judged(set_bit_rate(line));
    case 'O':
      return alone ? set_open(true) : judged(false);
    case 'C':
      return alone ? set_open(false) : judged(false);
    case 'V':
      return alone ? tell('V', kVersion, 4) : judged(false);
    case 'N':
      return alone ? tell_serial() : judged(false);
    case 'F':
      return alone ? tell_flags() : judged(false);
    case 'Z':  // there are no time stamps: only Z0 is true
      return judged(line.size() == 2 && line[1] == '0');
    default:
      return judged(false);
  }
}

SlcanRequest SlcanDevice::take_frame(Span<const char> line) const {
  SlcanRequest request;
  if (!open_ || !parse_slcan_frame(line, request.frame)) return judged(false);
  request.kind = SlcanRequest::Kind::frame;
  return request;
}

// S0 … S8: 10 kbit/s … 1 Mbit/s. Behind a serial line there is no bus whose rate would matter.
bool SlcanDevice::set_bit_rate(Span<const char> line) const {
  return !open_ && line.size() == 2 && line[1] >= '0' && line[1] <= '8';
}

// Refused when it is so already, as the manual has it.
SlcanRequest SlcanDevice::set_open(bool open) {
  const bool changes = open_ != open;
  open_ = open;
  return judged(changes);
}

SlcanRequest SlcanDevice::tell_flags() {
  if (!open_) return judged(false);
  const std::uint8_t flags = flags_;
  flags_ = 0;
  return tell('F', flags, 2);
}

// Decimal digits, as on a type plate.
SlcanRequest SlcanDevice::tell_serial() const {
  const std::uint32_t n = serial_ % 10'000U;
  return tell('N', n / 1000U << 12U | n / 100U % 10U << 8U | n / 10U % 10U << 4U | n % 10U, 4);
}

}  // namespace volcomp::hal
