#pragma once
// Services of the debugger or emulator the board hangs on (Arm "Semihosting for AArch32 and
// AArch64"). The processor stands still, virtual time included, until the host has answered. Where
// no host listens, every call fails; inside a HardFault or NMI handler it would lock up, so check
// host_found() there.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp::hal::mps2::semihosting {

// Finds out whether a host listens and stores the answer. Before main.
void find_host();
[[nodiscard]] bool host_found();

enum class Mode : std::uint8_t { read = 1, write = 5 };  // fopen "rb", "wb"

// A file or FIFO of the host in the folder it was started in; negative when that fails. A FIFO
// blocks until its other end is open, too.
[[nodiscard]] int open(const char* path, Mode mode);

// All bytes or false. Blocks until they are there.
[[nodiscard]] bool read(int handle, Span<std::uint8_t> bytes);
[[nodiscard]] bool write(int handle, Span<const std::uint8_t> bytes);

// The command line of the program as the host reports it, zero-terminated; false when it does not
// fit or no host answers.
[[nodiscard]] bool command_line(Span<char> text);

// Ends the emulator with this exit code. Comes back only where no host listens.
void exit(int code);

}  // namespace volcomp::hal::mps2::semihosting
