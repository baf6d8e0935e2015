#include "hal/mps2/uart.hpp"

#include "hal/mps2/nvic.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2::uart {
namespace {

constexpr std::uint32_t kData = kUart0 + 0x00;
constexpr std::uint32_t kState = kUart0 + 0x04;
constexpr std::uint32_t kControl = kUart0 + 0x08;
constexpr std::uint32_t kInterruptClear = kUart0 + 0x0C;
constexpr std::uint32_t kBaudDivider = kUart0 + 0x10;

// In state, control and interrupt register alike.
constexpr std::uint32_t kTransmit = 1U << 0U;
constexpr std::uint32_t kReceive = 1U << 1U;

constexpr std::uint32_t kReceiveOverrun = 1U << 3U;
constexpr std::uint32_t kTransmitInterrupt = 1U << 2U;
constexpr std::uint32_t kReceiveInterrupt = 1U << 3U;

constexpr std::uint32_t kSmallestDivider = 16;

}  // namespace

void start() {
  device_register(kBaudDivider) = kSmallestDivider;
  device_register(kControl) = kTransmit;
}

bool ready_to_send() { return (device_register(kState) & kTransmit) == 0; }

void send(std::uint8_t byte) {
  while (!ready_to_send()) {
  }
  device_register(kData) = byte;
}

bool receive(std::uint8_t& byte) {
  device_register(kInterruptClear) = kReceive;
  if ((device_register(kState) & kReceive) == 0) return false;
  byte = static_cast<std::uint8_t>(device_register(kData));
  return true;
}

bool take_receive_overrun() {
  if ((device_register(kState) & kReceiveOverrun) == 0) return false;
  device_register(kState) = kReceiveOverrun;
  return true;
}

void start_interrupts() {
  device_register(kControl) = kTransmit | kReceive | kTransmitInterrupt | kReceiveInterrupt;
  nvic::enable(kUart0ReceiveIrq, nvic::kLinkPriority);
  nvic::enable(kUart0TransmitIrq, nvic::kLinkPriority);
}

void request_transmit_interrupt() { nvic::request(kUart0TransmitIrq); }

void acknowledge_transmit() { device_register(kInterruptClear) = kTransmit; }

}  // namespace volcomp::hal::mps2::uart
