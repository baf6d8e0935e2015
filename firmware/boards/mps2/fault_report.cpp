// What a person reads on UART0 when the program cannot go on. The handlers in startup.S come here
// on a stack of their own, for a fault or the watchdog, wherever the processor was.
//
// Nothing is sent to the bus any more: the drives keep their last offset, and the missing heartbeat
// makes the controller stop the feed (1016h, 1029h).

#include <cstdint>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/registers.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/uart.hpp"

extern "C" {
// Made by the linker script: their addresses are meant.
extern std::uint32_t stack_guard;
extern std::uint32_t stack_bottom;
extern std::uint32_t stack_top;
}

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::hal::mps2::device_register;

// As the processor stacks them (DDI 0403, B1.5.6).
struct StackedRegisters {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

// Fault status and address (DDI 0403, B3.2.15 to B3.2.18).
struct FaultStatus {
  std::uint32_t configurable = device_register(0xE000'ED28);
  std::uint32_t hard = device_register(0xE000'ED2C);
  std::uint32_t memory_address = device_register(0xE000'ED34);
  std::uint32_t bus_address = device_register(0xE000'ED38);
};

struct Cause {
  std::uint32_t bit;  // of CFSR
  const char* words;
};

// The more specific first.
constexpr Cause kCauses[] = {
    {1U << 4U, "stack overflow: no room to save the registers for a handler"},
    {1U << 5U, "stack overflow: no room to save the FPU registers for a handler"},
    {1U << 0U, "execution where nothing may be executed"},
    {1U << 1U, "access to memory that is forbidden or not there"},
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
};

constexpr std::uint32_t kMemoryAddressValid = 1U << 7U;
constexpr std::uint32_t kBusAddressValid = 1U << 15U;
constexpr std::uint32_t kDataAccess = 1U << 1U;

std::uint32_t address(const std::uint32_t& symbol) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&symbol));
}

const char* forbidden_place(std::uint32_t at) {
  constexpr std::uint32_t kNullPageBytes = 1024;
  constexpr std::uint32_t kFlashBytes = 512 * 1024;
  if (at >= address(stack_guard) && at < address(stack_bottom))
    return "stack overflow: the guard below the stack was touched";
  if (at < kNullPageBytes) return "access through a null pointer";
  if (at < kFlashBytes) return "write to flash";
  return nullptr;
}

const char* cause_in_words(const FaultStatus& status) {
  constexpr std::uint32_t kAddressed = kDataAccess | kMemoryAddressValid;
  if ((status.configurable & kAddressed) == kAddressed) {
    const char* const place = forbidden_place(status.memory_address);
    if (place != nullptr) return place;
  }
  for (const Cause& cause : kCauses) {
    if ((status.configurable & cause.bit) != 0) return cause.words;
  }
  if ((status.hard & (1U << 1U)) != 0) return "the vector table could not be read";
  if ((status.hard & (1U << 31U)) != 0) return "a breakpoint without a debugger";
  return "unknown";
}

const char* exception_name(std::uint32_t number) {
  switch (number) {
    case 2:
      return "NMI";
    case 3:
      return "HardFault";
    case 4:
      return "MemManage";
    case 5:
      return "BusFault";
    case 6:
      return "UsageFault";
    default:
      return "interrupt";
  }
}

void put_register(const char* name, std::uint32_t value) {
  console::put(name);
  console::put(" ");
  console::put_hex(value);
}

std::uint32_t active_exception() {
  std::uint32_t number = 0;
  __asm volatile("mrs %0, ipsr" : "=r"(number));
  return number;
}

bool on_the_stack(const StackedRegisters* registers) {
  const auto at = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(registers));
  return at >= address(stack_bottom) && at + sizeof *registers <= address(stack_top);
}

void put_registers(const StackedRegisters* registers) {
  if (!on_the_stack(registers)) {
    console::put("  registers were not saved: the stack pointer is outside the stack\n");
    return;
  }
  put_register("  PC", registers->pc);
  put_register("  LR", registers->lr);
  put_register("  xPSR", registers->xpsr);
  put_register("\n  R0", registers->r0);
  put_register("  R1", registers->r1);
  put_register("  R2", registers->r2);
  put_register("  R3", registers->r3);
  put_register("  R12", registers->r12);
  console::put("\n");
}

void put_status(const FaultStatus& status, const StackedRegisters* registers,
                std::uint32_t exception_return) {
  put_register("  CFSR", status.configurable);
  put_register("  HFSR", status.hard);
  if ((status.configurable & kMemoryAddressValid) != 0)
    put_register("  MMFAR", status.memory_address);
  if ((status.configurable & kBusAddressValid) != 0) put_register("  BFAR", status.bus_address);
  put_register("\n  SP", static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(registers)));
  put_register("  EXC_RETURN", exception_return);
  console::put("\n");
}

void put_headline(const char* what, const char* why) {
  volcomp::hal::mps2::uart::start();  // nobody knows whether it was on
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

[[noreturn]] void stay_silent(int exit_code) {
  console::put("  The node is silent: drives keep their last offset, the heartbeat is missing.\n");
  volcomp::hal::mps2::semihosting::exit(exit_code);
  for (;;) {  // without a debugger until the watchdog bites
  }
}

}  // namespace

extern "C" [[noreturn]] void report_fault(const StackedRegisters* registers,
                                          std::uint32_t exception_return) {
  const FaultStatus status;
  put_headline("FAULT", cause_in_words(status));
  put_registers(registers);
  put_status(status, registers, exception_return);
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
  put_headline("WATCHDOG", "nobody fed it in time; the processor is restarted");
  put_registers(registers);
  volcomp::boards::restart(volcomp::boards::ResetCause::watchdog);
}
