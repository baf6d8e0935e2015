#pragma once
// Why the processor started, kept in RAM that no startup code clears.

#include "hal/reset_cause.hpp"

namespace volcomp::boards {

void note_reset_cause(hal::ResetCause cause);

// Returns the cause noted before the last restart, once: the next call returns power_on.
[[nodiscard]] hal::ResetCause take_reset_cause();

// Restarts the processor with all its devices (PSCI SYSTEM_RESET, DEN 0022).
[[noreturn]] void restart();

}  // namespace volcomp::boards
