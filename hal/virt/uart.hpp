#pragma once
// Text for a person on the serial line (Arm PrimeCell UART PL011, DDI 0183). Waits until each byte
// is taken.

#include <cstdint>

namespace volcomp::hal::virt::uart {

// May be called again at any time, also by a fault handler that cannot know what ran before it.
void start();

void put(const char* text);
void put_unsigned(std::uint64_t value);
void put_hex(std::uint64_t value);  // 0x and sixteen digits

}  // namespace volcomp::hal::virt::uart
