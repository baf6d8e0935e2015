#pragma once
// The SJA1000 as its data sheet (Philips Semiconductors, 2000 Jan 04, section 6.4) describes it to
// the processor, PeliCAN mode only, and a bus on which the test decides what happens next.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "hal/can_port.hpp"

namespace volcomp::test {

class Sja1000Chip {
 public:
  struct BusFrame {
    std::uint32_t id = 0;
    bool extended = false;
    bool remote = false;
    std::uint8_t length_code = 0;
    std::array<std::uint8_t, 8> data{};
  };

  // --- as the processor sees it
  std::uint8_t read(std::uint8_t address);
  void write(std::uint8_t address, std::uint8_t value);
  [[nodiscard]] bool interrupt() const { return interrupt_ != 0; }  // pin INT
  void hardware_reset();

  // --- as the bus sees it
  void receive(const BusFrame& frame);
  // The chip wants to send and the bus is free: from now on it cannot be stopped. False when it
  // has nothing to send.
  bool begin_transmission();
  // The frame that was begun, acknowledged by the others.
  BusFrame finish_transmission();
  // It was disturbed instead: 8 errors more (ISO 11898-1); the chip will try again by itself.
  void disturb_transmission();
  void receive_error();
  // Somebody else's frame went well: one error less.
  void receive_good() { set_receive_errors(receive_errors_ > 0 ? receive_errors_ - 1 : 0); }
  // So many times 11 recessive bits.
  void quiet_bus(unsigned times);

  [[nodiscard]] bool in_reset() const { return (mode_ & 1U) != 0; }
  [[nodiscard]] bool wants_to_send() const { return pending_ && !in_reset(); }
  [[nodiscard]] std::uint8_t register_value(std::uint8_t address) const {
    return plain_.at(address);
  }
  [[nodiscard]] const std::array<std::uint8_t, 13>& transmit_buffer() const { return transmit_; }

 private:
  static constexpr std::size_t kFifoBytes = 64;

  void raise(std::uint8_t bit);
  void write_command(std::uint8_t bits);
  void write_mode(std::uint8_t value);
  void release_transmit_buffer();
  [[nodiscard]] bool accepts(const BusFrame& frame) const;
  [[nodiscard]] bool passes(std::size_t byte, std::uint8_t value, std::uint8_t bits) const;
  void set_error_status();
  void set_transmit_errors(unsigned value);
  void set_receive_errors(unsigned value);
  void go_bus_off();

  std::uint8_t mode_ = 1;
  std::uint8_t status_ = 0x3C;
  std::uint8_t interrupt_ = 0;
  std::uint8_t enabled_ = 0;
  unsigned receive_errors_ = 0;
  unsigned transmit_errors_ = 0;
  std::array<std::uint8_t, 32> plain_{};  // what is only stored
  std::array<std::uint8_t, 8> filter_{};
  std::array<std::uint8_t, 13> transmit_{};
  std::deque<std::deque<std::uint8_t>> fifo_;
  bool pending_ = false;
  bool on_the_wire_ = false;
};

}  // namespace volcomp::test
