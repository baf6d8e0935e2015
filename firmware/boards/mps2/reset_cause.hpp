#pragma once
// Why the processor started, kept in RAM that no startup code clears.

#include "hal/reset_cause.hpp"

namespace volcomp::boards {

// Leaves the cause behind for the next start.
void note_reset_cause(hal::ResetCause cause);

// What was noted last, power_on when nothing was; the note stays.
[[nodiscard]] hal::ResetCause noted_reset_cause();

// The same, and clears the note.
[[nodiscard]] hal::ResetCause take_reset_cause();

// Restarts the processor with all its devices (AIRCR, DDI 0403, B3.2.6).
[[noreturn]] void restart();

}  // namespace volcomp::boards
