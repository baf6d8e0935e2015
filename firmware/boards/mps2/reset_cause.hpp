#pragma once
// Why the processor started, kept in RAM that no startup code clears.

#include <cstdint>

namespace volcomp::boards {

enum class ResetCause : std::uint8_t { power_on, watchdog };

// What the last run left behind, once: the next call says power_on.
[[nodiscard]] ResetCause take_reset_cause();

// Leaves the cause behind and restarts the processor with all its devices (AIRCR, DDI 0403,
// B3.2.6).
[[noreturn]] void restart(ResetCause cause);

}  // namespace volcomp::boards
