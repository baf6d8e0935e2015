#pragma once
// The CAN port of hal/can_port.hpp over UART0: to its host the board is a LAWICEL adapter
// (hal/slcan.hpp) whose bus has one station, the node. Bytes come and go by interrupt; the frames
// are made of them where send() and receive() are called.
//
//   SlcanPort port;
//   port.start();                       // from then on UARTRX0_Handler and UARTTX0_Handler call …
//   if (port.on_receive_interrupt()) …  // a line has ended: receive() may have a frame
//   port.on_transmit_interrupt();

#include <cstddef>
#include <cstdint>

#include "comp/core/atomic_word.hpp"
#include "hal/can_port.hpp"
#include "hal/ring.hpp"
#include "hal/slcan.hpp"

namespace volcomp::hal::mps2 {

class SlcanPort {
 public:
  // Not static, because the interrupts it enables need this port.
  void start();

  // False when the line is busy. While the host has not opened the channel the frame is lost, as on
  // a bus without another station.
  bool send(const CanFrame& frame);
  bool receive(CanFrame& frame);

  // How often bytes of the host were lost since the last call: each time a frame is lost or refused
  // as crippled. From the tick.
  [[nodiscard]] std::uint32_t take_losses();

  // True: a line has ended.
  bool on_receive_interrupt();
  void on_transmit_interrupt();

 private:
  static constexpr std::size_t kBytes = 1024;  // 11 ms of a line at 921 600 baud

  void write(Span<const char> text);

  SlcanDevice device_;
  Ring<std::uint8_t, kBytes> received_;
  Ring<std::uint8_t, kBytes> outgoing_;
  AtomicWord<> losses_{0};  // the receive interrupt counts
  std::uint32_t losses_told_ = 0;
};

}  // namespace volcomp::hal::mps2
