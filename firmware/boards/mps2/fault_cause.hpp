#pragma once
// Describes the content of the fault status registers.

#include <cstdint>

namespace volcomp::boards {

// Armv7-M Architecture Reference Manual DDI 0403, B3.2.15 to B3.2.18.
struct FaultStatus {
  std::uint32_t configurable = 0;  // CFSR
  std::uint32_t hard = 0;          // HFSR
  std::uint32_t memory_address = 0;
  std::uint32_t bus_address = 0;

  [[nodiscard]] bool memory_address_valid() const { return (configurable & (1U << 7U)) != 0; }
  [[nodiscard]] bool bus_address_valid() const { return (configurable & (1U << 15U)) != 0; }
};

[[nodiscard]] FaultStatus read_fault_status();

// Half a sentence.
[[nodiscard]] const char* cause_in_words(const FaultStatus& status);

}  // namespace volcomp::boards
