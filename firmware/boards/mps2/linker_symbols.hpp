#pragma once
// Symbols of the linker script (sections.ld): only their addresses count; where noted, the address
// is a plain number.

#include <cstdint>

extern "C" {
extern std::uint8_t flash_begin[];
extern std::uint8_t flash_end[];
extern std::uint8_t flash_log2[];  // number: size of the MPU region
extern std::uint8_t code_begin[];
extern std::uint8_t code_end[];
extern std::uint8_t constants_end[];  // they follow the code
extern std::uint8_t ram_begin[];
extern std::uint8_t ram_log2[];  // number: size of the MPU region
extern std::uint8_t stack_guard[];
extern std::uint32_t stack_bottom[];
extern std::uint32_t stack_top[];
extern std::uint32_t fault_stack_top[];
extern std::uint8_t block_memory_begin[];
extern std::uint8_t block_memory_end[];
extern volatile std::uint32_t retained_begin[];
}

namespace volcomp::boards {

inline std::uint32_t address_of(const volatile void* place) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(place));
}

}  // namespace volcomp::boards
