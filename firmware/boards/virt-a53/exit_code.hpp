#pragma once
// How an image ends, as the exit code of the emulator.

namespace volcomp::boards {

enum ExitCode : int {
  kFine = 0,
  kCheckFailed = 1,
  kUnusableInput = 2,
  kUnexpectedInterrupt = 97,
  kFault = 99,
};

}  // namespace volcomp::boards

// Reports the code to the host and stops. Main returns into it, too.
extern "C" [[noreturn]] void end_of_program(int exit_code);
