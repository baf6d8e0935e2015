#include "hal/virt/uart.hpp"

#include <array>
#include <cstddef>

#include "hal/virt/registers.hpp"

namespace volcomp::hal::virt::uart {
namespace {

constexpr Address kData = kUart + 0x00;
constexpr Address kFlags = kUart + 0x18;
constexpr Address kLineControl = kUart + 0x2C;
constexpr Address kControl = kUart + 0x30;

constexpr std::uint32_t kTransmitterFull = 1U << 5U;
constexpr std::uint32_t kEightBits = 3U << 5U;
constexpr std::uint32_t kFifo = 1U << 4U;
constexpr std::uint32_t kTransmitEnabled = (1U << 8U) | 1U;

void put_byte(char byte) {
  while ((word_register(kFlags) & kTransmitterFull) != 0) {
  }
  word_register(kData) = static_cast<std::uint8_t>(byte);
}

}  // namespace

// The baud rate stays as it is: the emulator models no bit times.
void start() {
  word_register(kLineControl) = kEightBits | kFifo;
  word_register(kControl) = kTransmitEnabled;
}

void put(const char* text) {
  for (; *text != '\0'; ++text)
    put_byte(*text);
}

void put_unsigned(std::uint64_t value) {
  std::array<char, 20> digits{};
  std::size_t count = 0;
  do {
    digits[count++] = static_cast<char>('0' + value % 10U);
    value /= 10U;
  } while (value != 0);
  while (count > 0)
    put_byte(digits[--count]);
}

void put_hex(std::uint64_t value) {
  put("0x");
  for (unsigned shift = 64; shift > 0; shift -= 4)
    put_byte("0123456789abcdef"[(value >> (shift - 4U)) & 0xFU]);
}

}  // namespace volcomp::hal::virt::uart
