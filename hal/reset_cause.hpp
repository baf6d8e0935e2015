#pragma once

#include <cstdint>

namespace volcomp::hal {

// Why the processor started.
enum class ResetCause : std::uint8_t {
  power_on = 0,
  request = 1,   // by software, on purpose
  watchdog = 2,  // not fed in time
  fault = 3,     // the processor met an instruction or an address it refused
};

}  // namespace volcomp::hal
