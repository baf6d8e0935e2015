#pragma once
// The serial line UART0 (CMSDK APB UART, Arm DDI 0479, 4.3), bytes only. Sending waits while the
// one-byte transmitter is full; receiving is for an interrupt handler.

#include <cstdint>

namespace volcomp::hal::mps2::uart {

// Transmitter and receiver on, no interrupt, at the fastest rate: the emulator models no bit times.
// May be called again at any time, also by a fault handler that cannot know what ran before it.
void start();

// From then on each received byte raises UARTRX0 until receive() has taken it.
void enable_receive_interrupt();

void send(std::uint8_t byte);

// False when nothing is there. Clears the interrupt. Safe in an interrupt; one reader only.
bool receive(std::uint8_t& byte);

// Bytes were lost because nobody took them; asking forgets it.
bool take_receive_overrun();

}  // namespace volcomp::hal::mps2::uart
