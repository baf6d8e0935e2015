#pragma once
// Text for a person on UART0. Waits until each byte is taken; needs uart::start() before.

#include <cstdint>

namespace volcomp::hal::mps2::console {

void put(const char* text);
void put_decimal(std::int32_t value);
void put_unsigned(std::uint32_t value);
void put_hex(std::uint32_t value);  // 0x and eight digits

}  // namespace volcomp::hal::mps2::console
