#pragma once
// Services of the debugger or emulator the board hangs on (Arm "Semihosting for AArch32 and
// AArch64"). Where no host listens, every call fails.

#include "comp/core/span.hpp"

namespace volcomp::hal::virt::semihosting {

// The command line of the program as the host reports it, zero-terminated; false when it does not
// fit or no host answers.
[[nodiscard]] bool command_line(Span<char> text);

// Ends the emulator with this exit code. Comes back only where no host listens.
void exit(int code);

}  // namespace volcomp::hal::virt::semihosting
