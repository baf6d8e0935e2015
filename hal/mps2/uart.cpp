#include "hal/mps2/uart.hpp"

#include "hal/mps2/nvic.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2::uart {
namespace {

constexpr std::uint32_t kData = kUart0 + 0x00;
constexpr std::uint32_t kState = kUart0 + 0x04;
constexpr std::uint32_t kControl = kUart0 + 0x08;
constexpr std::uint32_t kInterrupt = kUart0 + 0x0C;
constexpr std::uint32_t kBaudDivider = kUart0 + 0x10;

constexpr std::uint32_t kTransmitterFull = 1U << 0U;
constexpr std::uint32_t kReceiverFull = 1U << 1U;
constexpr std::uint32_t kReceiverOverrun = 1U << 3U;

constexpr std::uint32_t kTransmit = 1U << 0U;
constexpr std::uint32_t kReceive = 1U << 1U;
constexpr std::uint32_t kReceiveInterrupt = 1U << 3U;

constexpr std::uint32_t kSmallestDivider = 16;

}  // namespace

void start() {
  device_register(kBaudDivider) = kSmallestDivider;
  device_register(kControl) = kTransmit | kReceive;
}

void enable_receive_interrupt() {
  device_register(kControl) = kTransmit | kReceive | kReceiveInterrupt;
  nvic::enable(kUart0ReceiveIrq, nvic::kLinkPriority);
}

void send(std::uint8_t byte) {
  while ((device_register(kState) & kTransmitterFull) != 0) {
  }
  device_register(kData) = byte;
}

bool receive(std::uint8_t& byte) {
  device_register(kInterrupt) = kReceive;
  if ((device_register(kState) & kReceiverFull) == 0) return false;
  byte = static_cast<std::uint8_t>(device_register(kData));
  return true;
}

bool take_receive_overrun() {
  if ((device_register(kState) & kReceiverOverrun) == 0) return false;
  device_register(kState) = kReceiverOverrun;
  return true;
}

}  // namespace volcomp::hal::mps2::uart
