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
