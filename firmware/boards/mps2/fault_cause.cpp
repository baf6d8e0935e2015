#include "firmware/boards/mps2/fault_cause.hpp"

#include <array>

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::boards {
namespace {

using hal::mps2::device_register;

struct Cause {
  std::uint32_t bit;  // of CFSR
  const char* words;
};

constexpr std::uint32_t kDataAccess = 1U << 1U;

// The more specific first.
constexpr std::array<Cause, 17> kCauses = {{
    {1U << 4U, "stack overflow: no room to save the registers for a handler"},
    {1U << 5U, "stack overflow: no room to save the FPU registers for a handler"},
    {1U << 0U, "execution where nothing may be executed"},
    {kDataAccess, "access to memory that is forbidden or not there"},
    {1U << 3U, "a handler could not restore the registers: the stack pointer is wrong"},
    {1U << 9U, "a bus access that nothing answered"},
    {1U << 10U, "a buffered write that nothing answered (PC is somewhat later)"},
    {1U << 8U, "an instruction fetch that nothing answered"},
    {1U << 11U, "a bus error while a handler restored the registers"},
    {1U << 12U, "a bus error while the registers were saved for a handler"},
    {1U << 13U, "a bus error while the FPU registers were saved for a handler"},
    {1U << 16U, "undefined instruction"},
    {1U << 17U, "a jump to an address without the Thumb bit"},
    {1U << 18U, "a wrong return value of an exception"},
    {1U << 19U, "an instruction of a coprocessor that is off or absent"},
    {1U << 24U, "an unaligned access that has to be aligned"},
    {1U << 25U, "integer division by zero"},
}};

// Names the forbidden memory that was accessed; nullptr where the address is in none of it.
const char* forbidden_place(std::uint32_t at) {
  constexpr std::uint32_t kLargestLeap = 1024 * 1024;  // below the guard there is no other memory
  if (at >= address_of(stack_bottom) - kLargestLeap && at < address_of(stack_bottom))
    return "stack overflow: memory below the stack was touched";
  if (at < address_of(code_begin)) return "access through a null pointer";
  if (at < address_of(flash_end)) return "write to flash";
  return nullptr;
}

}  // namespace

FaultStatus read_fault_status() {
  return {device_register(0xE000'ED28), device_register(0xE000'ED2C), device_register(0xE000'ED34),
          device_register(0xE000'ED38)};
}

const char* cause_in_words(const FaultStatus& status) {
  if ((status.configurable & kDataAccess) != 0 && status.memory_address_valid()) {
    const char* const place = forbidden_place(status.memory_address);
    if (place != nullptr) return place;
  }
  for (const Cause& cause : kCauses) {
    if ((status.configurable & cause.bit) != 0) return cause.words;
  }
  if ((status.hard & (1U << 1U)) != 0) return "the vector table could not be read";
  return "a breakpoint without a debugger";
}

}  // namespace volcomp::boards
