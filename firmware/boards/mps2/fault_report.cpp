// The report on UART0 when the program cannot go on. The handlers in startup.S come here on a stack
// of their own, for a fault or the watchdog, wherever the processor was.
//
// Nothing is sent to the bus any more, which is the safe state: the drives keep their last offset,
// and the missing heartbeat makes controller and drives stop the feed (1016h, 1029h).

#include <array>
#include <cstdint>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/linker_symbols.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/registers.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/uart.hpp"

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::boards::address_of;
using volcomp::hal::ResetCause;
using volcomp::hal::mps2::device_register;

// As the processor stacks them (DDI 0403, B1.5.6).
struct StackedRegisters {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

// After an overflow the processor had no room to save them, and reading there would be a fault. The
// watchdog may find the processor on the stack of this very report.
bool were_saved(const StackedRegisters* registers) {
  return address_of(registers) >= address_of(stack_bottom) &&
         address_of(registers + 1) <= address_of(fault_stack_top);
}

// Encodings of DDI 0403, A7.7.18 (BL) and A7.7.19 (BLX).
bool is_long_call(std::uint16_t first, std::uint16_t second) {
  return (first & 0xF800U) == 0xF000U && (second & 0xD000U) == 0xD000U;
}
bool is_register_call(std::uint16_t instruction) { return (instruction & 0xFF87U) == 0x4780U; }

bool follows_call(std::uint32_t address) {
  if ((address & 1U) == 0) return false;  // return addresses carry the Thumb bit
  if (address < address_of(code_begin) + 5U || address > address_of(code_end) + 1U) return false;
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* const next = reinterpret_cast<const std::uint16_t*>(address - 1U);
  return is_long_call(next[-2], next[-1]) || is_register_call(next[-1]);
}

// There are no frame pointers to follow, so every word of the stack from `word` on is taken that is
// the address behind a call; one that is left over from an earlier call looks the same. Moves
// `word` behind it; 0 when the stack has no more.
std::uint32_t next_return_address(const std::uint32_t*& word) {
  while (word < stack_top) {
    const std::uint32_t candidate = *word;
    ++word;
    if (follows_call(candidate)) return candidate;
  }
  return 0;
}

// Armv7-M Architecture Reference Manual DDI 0403, B3.2.15 to B3.2.18.
struct FaultStatus {
  std::uint32_t configurable = 0;  // CFSR
  std::uint32_t hard = 0;          // HFSR
  std::uint32_t memory_address = 0;
  std::uint32_t bus_address = 0;

  [[nodiscard]] bool memory_address_valid() const { return (configurable & (1U << 7U)) != 0; }
  [[nodiscard]] bool bus_address_valid() const { return (configurable & (1U << 15U)) != 0; }
};

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

FaultStatus read_fault_status() {
  return {device_register(0xE000'ED28), device_register(0xE000'ED2C), device_register(0xE000'ED34),
          device_register(0xE000'ED38)};
}

// Half a sentence.
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

std::uint32_t active_exception() {
  std::uint32_t number = 0;
  __asm volatile("mrs %0, ipsr" : "=r"(number));
  return number;
}

const char* exception_name(std::uint32_t number) {
  constexpr std::array<const char*, 5> kNames = {"NMI", "HardFault", "MemManage", "BusFault",
                                                 "UsageFault"};
  constexpr std::size_t kFirst = 2;
  const std::size_t index = number - kFirst;
  if (index >= kNames.size()) return "interrupt";
  return kNames[index];
}

void put_register(const char* name, std::uint32_t value) {
  console::put(name);
  console::put(" ");
  console::put_hex(value);
}

void put_headline(const char* what, const char* why) {
  volcomp::hal::mps2::uart::start();  // it may be off
  console::put("\n");
  console::put(what);
  console::put(": ");
  console::put(why);
  console::put("\n  exception ");
  const std::uint32_t number = active_exception();
  console::put_unsigned(number);
  console::put(" (");
  console::put(exception_name(number));
  console::put(")\n");
}

void put_registers(const StackedRegisters* registers) {
  if (!were_saved(registers)) {
    put_register("  registers were not saved: there is no stack at SP", address_of(registers));
    console::put("\n");
    return;
  }
  put_register("  PC", registers->pc);
  put_register("  LR", registers->lr);
  put_register("  xPSR", registers->xpsr);
  put_register("  SP", address_of(registers));
  put_register("\n  R0", registers->r0);
  put_register("  R1", registers->r1);
  put_register("  R2", registers->r2);
  put_register("  R3", registers->r3);
  put_register("  R12", registers->r12);
  console::put("\n");
}

void put_call_trace(const StackedRegisters* registers) {
  const bool saved = were_saved(registers);
  const auto* word = saved ? reinterpret_cast<const std::uint32_t*>(registers + 1) : stack_bottom;
  console::put("  called from, as far as the stack tells:");
  constexpr int kMost = 6;
  for (int i = 0; i < kMost; ++i) {
    const std::uint32_t caller = next_return_address(word);
    if (caller == 0) break;
    put_register("", caller - 1U);
  }
  console::put("\n");
}

void put_status(const FaultStatus& status, std::uint32_t exception_return) {
  put_register("  CFSR", status.configurable);
  put_register("  HFSR", status.hard);
  if (status.memory_address_valid()) put_register("  MMFAR", status.memory_address);
  if (status.bus_address_valid()) put_register("  BFAR", status.bus_address);
  put_register("  EXC_RETURN", exception_return);
  console::put("\n");
}

[[noreturn]] void stay_silent(int exit_code) {
  console::put(
      "  The node is silent: the drives keep their last offset, its heartbeat is missing.\n");
  if (volcomp::hal::mps2::semihosting::host_found())
    volcomp::hal::mps2::semihosting::exit(exit_code);
  for (;;) {  // without a debugger until the watchdog bites
  }
}

}  // namespace

extern "C" [[noreturn]] void report_fault(const StackedRegisters* registers,
                                          std::uint32_t exception_return) {
  const FaultStatus status = read_fault_status();
  put_headline("FAULT", cause_in_words(status));
  put_registers(registers);
  put_status(status, exception_return);
  put_call_trace(registers);
  volcomp::boards::note_reset_cause(ResetCause::fault);
  stay_silent(volcomp::boards::kFault);
}

extern "C" [[noreturn]] void report_unexpected_interrupt(const StackedRegisters* registers,
                                                         std::uint32_t /*exception_return*/) {
  put_headline("UNEXPECTED INTERRUPT", "nobody handles it");
  put_registers(registers);
  stay_silent(volcomp::boards::kUnexpectedInterrupt);
}

extern "C" [[noreturn]] void report_watchdog(const StackedRegisters* registers,
                                             std::uint32_t /*exception_return*/) {
  put_headline("WATCHDOG", "nobody fed it in time, the processor is restarted");
  put_registers(registers);
  put_call_trace(registers);
  // Without a debugger the watchdog ends the report of a fault: the cause stays the fault.
  if (volcomp::boards::noted_reset_cause() != ResetCause::fault)
    volcomp::boards::note_reset_cause(ResetCause::watchdog);
  volcomp::boards::restart();
}
