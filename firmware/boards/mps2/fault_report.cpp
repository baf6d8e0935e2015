// The report on UART0 when the program cannot go on. The handlers in startup.S come here on a stack
// of their own, for a fault or the watchdog, wherever the processor was.
//
// Nothing is sent to the bus any more, which is the safe state: the drives keep their last offset,
// and the missing heartbeat makes controller and drives stop the feed (1016h, 1029h).

#include <array>
#include <cstdint>

#include "firmware/boards/mps2/call_trace.hpp"
#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/fault_cause.hpp"
#include "firmware/boards/mps2/linker_symbols.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/uart.hpp"

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::boards::address_of;
using volcomp::boards::FaultStatus;
using volcomp::hal::ResetCause;

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
    const std::uint32_t caller = volcomp::boards::next_return_address(word);
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
  const FaultStatus status = volcomp::boards::read_fault_status();
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
