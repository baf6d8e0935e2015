// The report on the serial line when the program cannot go on. start.S comes here on a stack of its
// own, for a fault or the watchdog, wherever the processor was.
//
// Nothing is sent to the bus any more, which is the safe state: the drives keep their last offset,
// and the missing heartbeat makes controller and drives stop the feed (1016h, 1029h).

#include <array>
#include <cstdint>

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "firmware/boards/virt-a53/reset_cause.hpp"
#include "hal/virt/uart.hpp"

extern "C" {
// Symbols of the linker script: only their addresses count.
extern const char code_begin;
extern const char constants_end;
extern const char stack_guard;
extern const char interrupt_stack_guard;
extern const char fault_stack_guard;

// x0 … x30, SP_EL0, SP_EL1; filled by start.S.
std::array<std::uint64_t, 33> fault_registers;
}

namespace {

namespace uart = volcomp::hal::virt::uart;

// Exception syndrome (DDI 0487, D13.2.37).
struct Syndrome {
  std::uint64_t value;
  [[nodiscard]] unsigned exception_class() const { return (value >> 26U) & 0x3FU; }
  [[nodiscard]] unsigned fault_status() const { return value & 0x3FU; }
  [[nodiscard]] bool write() const { return (value & (1U << 6U)) != 0; }
};

struct Words {
  unsigned exception_class;
  const char* words;
};

constexpr unsigned kInstructionAbort = 0x21;
constexpr unsigned kDataAbort = 0x25;

constexpr std::array<Words, 9> kClasses = {{
    {0x00, "undefined instruction"},
    {0x0E, "illegal processor state"},
    {0x15, "a system call, which this program has none of"},
    {kInstructionAbort, "execution where nothing may be executed"},
    {0x22, "a jump to an address that is not a multiple of 4"},
    {kDataAbort, "access to memory that is forbidden or not there"},
    {0x26, "the stack pointer is not a multiple of 16"},
    {0x2F, "an asynchronous error of the memory system"},
    {0x3C, "a breakpoint without a debugger"},
}};

// Fault status codes of an abort (D13.2.37), without the level of the table.
constexpr unsigned kAlignment = 0x21;
constexpr unsigned kExternal = 0x10;

bool inside(std::uint64_t at, const char& begin, std::uint64_t bytes) {
  const auto first = reinterpret_cast<std::uintptr_t>(&begin);
  return at >= first && at - first < bytes;
}

const char* place_in_words(std::uint64_t at, const Syndrome& syndrome) {
  constexpr std::uint64_t kPageBytes = 4096;
  if (inside(at, stack_guard, kPageBytes))
    return "stack overflow: the guard below the program's stack was touched";
  if (inside(at, interrupt_stack_guard, kPageBytes))
    return "stack overflow: the guard below the stack of the interrupts was touched";
  if (inside(at, fault_stack_guard, kPageBytes))
    return "stack overflow: the guard below the stack of this report was touched";
  if (at < kPageBytes) return "access through a null pointer";
  const auto constant_bytes = static_cast<std::uint64_t>(&constants_end - &code_begin);
  if (syndrome.write() && inside(at, code_begin, constant_bytes))
    return "write to code or constants";
  return nullptr;
}

const char* cause_in_words(const Syndrome& syndrome, std::uint64_t at) {
  if (syndrome.exception_class() == kDataAbort) {
    if (syndrome.fault_status() == kAlignment) return "an access that is not aligned to its size";
    if (syndrome.fault_status() == kExternal) return "an access that nothing answered";
    const char* const place = place_in_words(at, syndrome);
    if (place != nullptr) return place;
  }
  for (const Words& known : kClasses) {
    if (known.exception_class == syndrome.exception_class()) return known.words;
  }
  return "unknown";
}

// The vectors come in groups of four: synchronous, interrupt, fast interrupt, error; the first
// group is from the program, the second from a handler.
bool is_watchdog(std::uint64_t vector) { return vector % 4 == 2; }
const char* origin(std::uint64_t vector) { return vector < 4 ? "the program" : "an interrupt"; }

void put_named(const char* name, std::uint64_t value) {
  uart::put(name);
  uart::put(" ");
  uart::put_hex(value);
}

void put_registers(const std::uint64_t* registers) {
  constexpr unsigned kInALine = 4;
  for (unsigned i = 0; i < 31; ++i) {
    uart::put(i % kInALine == 0 ? "\n  x" : "  x");
    uart::put_unsigned(i);
    put_named(i < 10 ? " " : "", registers[i]);
  }
  put_named("\n  SP_EL0", registers[31]);
  put_named("  SP_EL1", registers[32]);
  uart::put("\n");
}

std::uint64_t fault_address() {
  std::uint64_t value = 0;
  __asm volatile("mrs %0, far_el1" : "=r"(value));
  return value;
}

std::uint64_t return_address() {
  std::uint64_t value = 0;
  __asm volatile("mrs %0, elr_el1" : "=r"(value));
  return value;
}

Syndrome syndrome_register() {
  std::uint64_t value = 0;
  __asm volatile("mrs %0, esr_el1" : "=r"(value));
  return {value};
}

void put_headline(const char* what, std::uint64_t vector, const char* why) {
  uart::start();  // it may be off
  uart::put("\n");
  uart::put(what);
  uart::put(": ");
  uart::put(why);
  uart::put("\n  in ");
  uart::put(origin(vector));
  put_named("\n  PC", return_address());
}

[[noreturn]] void restart_for_watchdog(std::uint64_t vector, const std::uint64_t* registers) {
  put_headline("WATCHDOG", vector, "nobody fed it in time, the processor is restarted");
  put_registers(registers);
  volcomp::boards::note_reset_cause(volcomp::hal::ResetCause::watchdog);
  volcomp::boards::restart();
}

}  // namespace

extern "C" [[noreturn]] void report_exception_in_words(std::uint64_t vector,
                                                       const std::uint64_t* registers) {
  if (is_watchdog(vector)) restart_for_watchdog(vector, registers);
  const Syndrome syndrome = syndrome_register();
  const std::uint64_t at = fault_address();
  put_headline("FAULT", vector, cause_in_words(syndrome, at));
  put_named("  address", at);
  put_named("  ESR", syndrome.value);
  put_registers(registers);
  uart::put("  The node is silent: the drives keep their last offset, its heartbeat is missing.\n");
  end_of_program(volcomp::boards::kFault);
}
