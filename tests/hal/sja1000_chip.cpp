#include "tests/hal/sja1000_chip.hpp"

#include <algorithm>
#include <numeric>

namespace volcomp::test {
namespace {

// Sections 6.4.3 to 6.4.7. Written out once more: the names of the driver are under test.
constexpr std::uint8_t kReset = 0x01;
constexpr std::uint8_t kSingleFilter = 0x08;
constexpr std::uint8_t kFull = 0x01;
constexpr std::uint8_t kOverrun = 0x02;
constexpr std::uint8_t kReleased = 0x04;
constexpr std::uint8_t kComplete = 0x08;
constexpr std::uint8_t kTransmitting = 0x20;
constexpr std::uint8_t kErrors = 0x40;
constexpr std::uint8_t kOff = 0x80;
constexpr std::uint8_t kReceiveInterrupt = 0x01;
constexpr std::uint8_t kTransmitInterrupt = 0x02;
constexpr std::uint8_t kWarningInterrupt = 0x04;
constexpr std::uint8_t kOverrunInterrupt = 0x08;
constexpr std::uint8_t kPassiveInterrupt = 0x20;
constexpr unsigned kWarningLimit = 13;
constexpr unsigned kClockDivider = 31;

template <class T>
std::uint8_t byte(T value) {
  return static_cast<std::uint8_t>(value);
}

// As it stands in the buffers; sections 6.4.13 and 6.4.14.
std::deque<std::uint8_t> in_buffer(const Sja1000Chip::BusFrame& frame) {
  std::deque<std::uint8_t> bytes{
      byte((frame.extended ? 0x80 : 0) | (frame.remote ? 0x40 : 0) | frame.length_code)};
  const std::uint32_t left = frame.extended ? frame.id << 3U : frame.id << 21U;
  for (int i = 0; i < (frame.extended ? 4 : 2); ++i)
    bytes.push_back(byte(left >> (24 - 8 * i)));
  const int size = frame.remote ? 0 : std::min<int>(frame.length_code, 8);
  bytes.insert(bytes.end(), frame.data.begin(), frame.data.begin() + size);
  return bytes;
}

}  // namespace

void Sja1000Chip::hardware_reset() {
  *this = Sja1000Chip();
  plain_[kWarningLimit] = 96;
}

void Sja1000Chip::raise(std::uint8_t bit) { interrupt_ = byte(interrupt_ | (bit & enabled_)); }

std::uint8_t Sja1000Chip::read(std::uint8_t address) {
  switch (address) {
    case 0:
      return mode_;
    case 1:
      return 0;
    case 2:
      return status_;
    case 3: {
      const std::uint8_t value = interrupt_;
      interrupt_ = byte(fifo_.empty() ? 0 : interrupt_ & kReceiveInterrupt);
      return value;
    }
    case 4:
      return enabled_;
    case 14:
      return byte(receive_errors_);
    case 15:
      return byte(transmit_errors_);
    default:
      break;
  }
  if (address < 16 || address > 28) return plain_.at(address);
  const unsigned at = address - 16U;
  if (in_reset()) return at < filter_.size() ? filter_.at(at) : byte(0);
  if (fifo_.empty() || at >= fifo_.front().size()) return 0xA5;  // whatever was there before
  return fifo_.front()[at];
}

void Sja1000Chip::write(std::uint8_t address, std::uint8_t value) {
  if (address == 0) return write_mode(value);
  if (address == 1) return write_command(value);
  if (address == 4) {
    enabled_ = value;
  } else if (address >= 16 && address <= 28 && !in_reset()) {
    // Locked: lost without being indicated (section 6.4.5, note 5).
    if ((status_ & kReleased) != 0) transmit_.at(address - 16U) = value;
  } else if (in_reset() && address >= 16 && address <= 23) {
    filter_.at(address - 16U) = value;
  } else if (in_reset() && address == 14) {
    receive_errors_ = value;
  } else if (in_reset() && address == 15) {
    transmit_errors_ = value;
    status_ = byte(status_ & ~kOff);
  } else if (in_reset() || address == kClockDivider) {
    plain_.at(address) = value;
  }
}

void Sja1000Chip::write_mode(std::uint8_t value) {
  const bool was_in_reset = in_reset();
  mode_ = value;
  if (!was_in_reset && in_reset()) {
    fifo_.clear();
    status_ = byte((status_ & ~(kFull | kOverrun)) | kReleased);
    pending_ = on_the_wire_ = false;
  }
}

void Sja1000Chip::write_command(std::uint8_t bits) {
  if (in_reset()) return;
  if ((bits & 0x01U) != 0 && (status_ & kReleased) != 0) {
    pending_ = true;
    status_ = byte(status_ & ~(kReleased | kComplete));
  }
  if ((bits & 0x02U) != 0 && pending_ && !on_the_wire_) release_transmit_buffer();
  if ((bits & 0x04U) != 0 && !fifo_.empty()) {
    fifo_.pop_front();
    interrupt_ = byte(interrupt_ & ~kReceiveInterrupt);
    status_ = byte(status_ & ~kFull);
    if (!fifo_.empty()) {
      status_ = byte(status_ | kFull);
      raise(kReceiveInterrupt);
    }
  }
  if ((bits & 0x08U) != 0) status_ = byte(status_ & ~kOverrun);
}

void Sja1000Chip::release_transmit_buffer() {
  pending_ = on_the_wire_ = false;
  status_ = byte((status_ | kReleased) & ~kTransmitting);
  raise(kTransmitInterrupt);
}

// Bits of the acceptance code that matter for this byte; 1 in the mask: does not.
bool Sja1000Chip::passes(std::size_t byte_number, std::uint8_t value, std::uint8_t bits) const {
  const unsigned matters = ~unsigned{filter_.at(4 + byte_number)} & bits;
  return ((value ^ unsigned{filter_.at(byte_number)}) & matters) == 0;
}

// Section 6.4.15.2. With data to compare only if there are some.
bool Sja1000Chip::accepts(const BusFrame& frame) const {
  if ((mode_ & kSingleFilter) != 0) return false;  // the driver uses the dual one
  if (frame.extended) {
    const std::uint8_t high = byte(frame.id >> 21U);
    const std::uint8_t low = byte(frame.id >> 13U);
    return (passes(0, high, 0xFF) && passes(1, low, 0xFF)) ||
           (passes(2, high, 0xFF) && passes(3, low, 0xFF));
  }
  const std::uint8_t high = byte(frame.id >> 3U);
  const std::uint8_t low = byte((frame.id << 5U) | (frame.remote ? 0x10U : 0U));
  const bool has_data = !frame.remote && frame.length_code > 0;
  const bool data = !has_data || (passes(1, byte(frame.data[0] >> 4U), 0x0F) &&
                                  passes(3, byte(frame.data[0] & 0x0FU), 0x0F));
  return (passes(0, high, 0xFF) && passes(1, low, 0xF0) && data) ||
         (passes(2, high, 0xFF) && passes(3, low, 0xF0));
}

void Sja1000Chip::receive(const BusFrame& frame) {
  if (in_reset() || (status_ & kOff) != 0 || !accepts(frame)) return;
  const std::deque<std::uint8_t> bytes = in_buffer(frame);
  const std::size_t used =
      std::accumulate(fifo_.begin(), fifo_.end(), std::size_t{0},
                      [](std::size_t sum, const auto& waiting) { return sum + waiting.size(); });
  if (used + bytes.size() > kFifoBytes) {
    if ((status_ & kOverrun) == 0) raise(kOverrunInterrupt);
    status_ = byte(status_ | kOverrun);
    return;
  }
  fifo_.push_back(bytes);
  status_ = byte(status_ | kFull);
  raise(kReceiveInterrupt);
}

bool Sja1000Chip::begin_transmission() {
  if (!wants_to_send() || (status_ & kOff) != 0) return false;
  on_the_wire_ = true;
  status_ = byte(status_ | kTransmitting);
  return true;
}

Sja1000Chip::BusFrame Sja1000Chip::finish_transmission() {
  BusFrame frame;
  frame.extended = (transmit_[0] & 0x80U) != 0;
  frame.remote = (transmit_[0] & 0x40U) != 0;
  frame.length_code = transmit_[0] & 0x0FU;
  frame.id = (unsigned{transmit_[1]} << 3U) | (transmit_[2] >> 5U);
  std::copy_n(transmit_.begin() + 3, std::min<int>(frame.length_code, 8), frame.data.begin());
  status_ = byte(status_ | kComplete);
  release_transmit_buffer();
  set_transmit_errors(transmit_errors_ > 0 ? transmit_errors_ - 1 : 0);
  return frame;
}

void Sja1000Chip::disturb_transmission() {
  on_the_wire_ = false;
  status_ = byte(status_ & ~kTransmitting);
  set_transmit_errors(transmit_errors_ + 8);
}

void Sja1000Chip::receive_error() { set_receive_errors(receive_errors_ + 1); }

void Sja1000Chip::set_transmit_errors(unsigned value) {
  if (value > 255) return go_bus_off();
  if ((value > 127) != (transmit_errors_ > 127)) raise(kPassiveInterrupt);
  transmit_errors_ = value;
  set_error_status();
}

void Sja1000Chip::set_receive_errors(unsigned value) {
  if ((value > 127) != (receive_errors_ > 127)) raise(kPassiveInterrupt);
  receive_errors_ = value;
  set_error_status();
}

void Sja1000Chip::set_error_status() {
  const bool before = (status_ & kErrors) != 0;
  const bool now = std::max(transmit_errors_, receive_errors_) >= plain_[kWarningLimit];
  if (before == now) return;
  status_ = byte(status_ ^ kErrors);
  raise(kWarningInterrupt);
}

// Section 6.4.5, note 1.
void Sja1000Chip::go_bus_off() {
  status_ = byte(status_ | kOff | kErrors);
  transmit_errors_ = 127;
  receive_errors_ = 0;
  write_mode(byte(mode_ | kReset));
  raise(kWarningInterrupt);
}

void Sja1000Chip::quiet_bus(unsigned times) {
  if (in_reset() || (status_ & kOff) == 0) return;
  if (times <= transmit_errors_) {
    transmit_errors_ -= times;
    return;
  }
  transmit_errors_ = 0;
  status_ = byte(status_ & ~(kOff | kErrors));
  raise(kWarningInterrupt);
}

}  // namespace volcomp::test
