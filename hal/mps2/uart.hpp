#pragma once
// The serial line UART0 (CMSDK APB UART, Arm DDI 0479, 4.3), bytes only.

#include <cstdint>

namespace volcomp::hal::mps2::uart {

// Transmitter on, no interrupt, at the fastest rate: the emulator models no bit times. May be
// called again at any time, also by a fault handler that cannot know what ran before it.
void start();

// Waits while the one-byte transmitter is full.
void send(std::uint8_t byte);
[[nodiscard]] bool ready_to_send();

// False when nothing is there. Clears the interrupt. One reader only.
bool receive(std::uint8_t& byte);

// Bytes were lost because they were not taken; the call clears it.
bool take_receive_overrun();

// Turns the receiver on together with the interrupts: a byte that came in between would raise none,
// and while it is not taken no other comes. From then on each received byte raises UARTRX0 until
// receive() has taken it, and each byte that has left, or a request, raises UARTTX0 until it is
// acknowledged.
void start_interrupts();
void request_transmit_interrupt();
void acknowledge_transmit();

}  // namespace volcomp::hal::mps2::uart
