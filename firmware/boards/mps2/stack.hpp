#pragma once
// The stack of main and of all interrupts but faults. The startup code paints it, so that its
// deepest use can be read at any time.

#include <cstdint>

namespace volcomp::boards {

[[nodiscard]] std::uint32_t stack_bytes();

// The most that was in use at any time since the start or the last repaint(). A frame that was
// entered but not written to is not seen.
[[nodiscard]] std::uint32_t deepest_stack_bytes();

// Paints anew what the caller does not use. Interrupts may run meanwhile, their use may be lost.
void repaint_stack();

}  // namespace volcomp::boards
