#include "hal/mps2/console.hpp"

#include <array>
#include <cstddef>

#include "hal/mps2/uart.hpp"

namespace volcomp::hal::mps2::console {

void put(const char* text) {
  for (; *text != '\0'; ++text)
    uart::send(static_cast<std::uint8_t>(*text));
}

void put_unsigned(std::uint32_t value) {
  std::array<char, 10> digits{};
  std::size_t count = 0;
  do {
    digits[count++] = static_cast<char>('0' + value % 10U);
    value /= 10U;
  } while (value != 0);
  while (count > 0)
    uart::send(static_cast<std::uint8_t>(digits[--count]));
}

void put_decimal(std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  if (value < 0) put("-");
  put_unsigned(value < 0 ? 0U - bits : bits);
}

void put_hex(std::uint32_t value) {
  put("0x");
  for (std::uint32_t shift = 32; shift > 0; shift -= 4)
    uart::send(static_cast<std::uint8_t>("0123456789abcdef"[(value >> (shift - 4U)) & 0xFU]));
}

}  // namespace volcomp::hal::mps2::console
