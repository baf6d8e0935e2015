#include "hal/mps2/slcan_port.hpp"

#include "hal/mps2/uart.hpp"

namespace volcomp::hal::mps2 {

// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void SlcanPort::start() { uart::start_interrupts(); }

bool SlcanPort::send(const CanFrame& frame) {
  // An answer to the host must find room, too: it waits for it.
  constexpr std::size_t kReserve = 2 * SlcanText::kCapacity;
  if (!device_.open()) return true;
  if (outgoing_.room() < kReserve) return false;
  const SlcanText text = slcan_frame(frame);
  write(text);
  return true;
}

bool SlcanPort::receive(CanFrame& frame) {
  std::uint8_t byte = 0;
  while (received_.pop(byte)) {
    const SlcanRequest request = device_.take(static_cast<char>(byte));
    if (request.kind == SlcanRequest::Kind::answer) write(request.answer);
    if (request.kind != SlcanRequest::Kind::frame) continue;
    write({&kSlcanOk, 1});
    frame = request.frame;
    return true;
  }
  return false;
}

std::uint32_t SlcanPort::take_losses() {
  const std::uint32_t losses = losses_.load(std::memory_order_relaxed);
  const std::uint32_t fresh = losses - losses_told_;
  losses_told_ = losses;
  if (fresh != 0) device_.raise(SlcanDevice::data_overrun);
  return fresh;
}

bool SlcanPort::on_receive_interrupt() {
  bool lost = uart::take_receive_overrun();
  bool line_has_ended = false;
  std::uint8_t byte = 0;
  while (uart::receive(byte)) {
    lost = !received_.push(byte) || lost;
    line_has_ended = line_has_ended || byte == static_cast<std::uint8_t>(kSlcanOk);
  }
  // No other context writes the counter.
  if (lost) losses_.store(losses_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return line_has_ended;
}

void SlcanPort::on_transmit_interrupt() {
  uart::acknowledge_transmit();
  std::uint8_t byte = 0;
  while (uart::ready_to_send() && outgoing_.pop(byte))
    uart::send(byte);
}

void SlcanPort::write(Span<const char> text) {
  for (const char c : text) {
    if (!outgoing_.push(static_cast<std::uint8_t>(c)))
      device_.raise(SlcanDevice::transmit_queue_full);
  }
  uart::request_transmit_interrupt();
}

}  // namespace volcomp::hal::mps2
