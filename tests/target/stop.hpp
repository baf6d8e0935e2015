#pragma once

namespace volcomp::target {

// Prints why and ends the emulator with exit code 1: a check failed.
[[noreturn]] void stop(const char* sentence);

}  // namespace volcomp::target
