// Commits the misdeed that its command line names and has to be stopped by the board. Ends with 1
// when nothing stopped it; tests/target/faults/faults_test.sh judges the report.

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "firmware/boards/virt-a53/interrupts.hpp"
#include "firmware/boards/virt-a53/reset_cause.hpp"
#include "hal/virt/interrupt_lock.hpp"
#include "hal/virt/semihosting.hpp"
#include "hal/virt/uart.hpp"
#include "hal/virt/watchdog.hpp"

extern "C" {
extern const char code_begin;  // made by the linker script: its address is meant
}

namespace {

namespace gic = volcomp::hal::virt::gic;
namespace uart = volcomp::hal::virt::uart;
using volcomp::hal::virt::Address;
using volcomp::hal::virt::Clock;
using volcomp::hal::virt::Watchdog;

constexpr std::uint32_t kBite_us = 10'000;

// The compiler must not see where a pointer leads.
Address hidden(Address number) {
  volatile Address copy = number;
  return copy;
}
volatile std::uint32_t& word_at(Address address) {
  return volcomp::hal::virt::word_register(hidden(address));
}

volatile std::uint32_t sink = 0;
volatile bool fault_in_tick = false;
[[gnu::noinline]] void read_null_pointer() { sink = word_at(16); }
[[gnu::noinline]] void read_wild_pointer() { sink = word_at(0x5000'0000); }
[[gnu::noinline]] void read_beyond_4_gib() { sink = word_at(0x1'0000'0000); }
[[gnu::noinline]] void read_absent_device() { sink = word_at(0x0A00'0000); }
[[gnu::noinline]] void write_code() {
  word_at(reinterpret_cast<std::uintptr_t>(&code_begin) + 64) = 0;
}
[[gnu::noinline]] void jump_beside_instruction() {
  const Address beside = hidden(reinterpret_cast<std::uintptr_t>(&code_begin) + 2);
  __asm volatile("blr %0" : : "r"(beside) : "x30", "memory");
}
[[gnu::noinline]] void undefined_instruction() { __asm volatile("udf #0"); }
[[gnu::noinline]] void breakpoint() { __asm volatile("brk #0"); }

[[gnu::noinline]] void execute_data() {
  static std::array<std::uint32_t, 1> code = {0xD65F'03C0};  // ret
  __asm volatile("blr %0" : : "r"(code.data()) : "x30", "memory");
}

// Touches every word on its way down, as ordinary nested calls do.
// NOLINTNEXTLINE(misc-no-recursion)
[[gnu::noinline]] std::uint64_t overflow(std::uint64_t depth) {
  volatile std::uint64_t frame[16] = {};  // NOLINT(modernize-avoid-c-arrays)
  frame[depth % 16U] = depth;
  if (depth == hidden(1'000'000)) return 0;
  return overflow(depth + 1) + frame[depth % 16U];
}

void wait(std::uint32_t time_us) {
  const Clock clock;
  const std::uint64_t end_us = clock.now_us() + time_us;
  while (clock.now_us() < end_us) {
  }
}

volcomp::hal::virt::PeriodicTimer timer;

void start_tick() {
  timer.start(1000);
  volcomp::hal::virt::InterruptMask().leave();
}

[[gnu::noinline]] void overflow_in_interrupt() {
  fault_in_tick = true;
  start_tick();
  wait(10'000);
}

[[gnu::noinline]] void unexpected_interrupt() {
  constexpr std::uint32_t kNobodysInterrupt = 40;
  gic::enable(kNobodysInterrupt);
  volcomp::hal::virt::InterruptMask().leave();
  word_at(volcomp::hal::virt::kGicDistributor + 0x204) = 1U << (kNobodysInterrupt - 32U);
  wait(10'000);
}

[[gnu::noinline]] void starve_watchdog() {
  const volcomp::hal::virt::InterruptLock nobody_comes_in;
  Watchdog watchdog;
  watchdog.start(kBite_us);
  wait(2 * kBite_us);
}

// Not a misdeed: shows that the watchdog of the test above bites for want of food, not always.
int feed_watchdog() {
  Watchdog watchdog;
  watchdog.start(kBite_us);
  for (int i = 0; i < 20; ++i) {
    wait(kBite_us / 2);
    const std::uint32_t left_us = watchdog.remaining_us();
    if (left_us < kBite_us / 4 || left_us > kBite_us / 2) return volcomp::boards::kCheckFailed;
    watchdog.feed();
  }
  uart::put("the watchdog was fed\n");
  return volcomp::boards::kFine;
}

struct Misdeed {
  std::string_view name;
  void (*commit)();
};

constexpr std::array<Misdeed, 13> kMisdeeds = {{
    {"null-pointer", read_null_pointer},
    {"wild-pointer", read_wild_pointer},
    {"beyond-4-gib", read_beyond_4_gib},
    {"absent-device", read_absent_device},
    {"write-code", write_code},
    {"jump-beside", jump_beside_instruction},
    {"execute-data", execute_data},
    {"undefined", undefined_instruction},
    {"breakpoint", breakpoint},
    {"overflow", [] { static_cast<void>(overflow(0)); }},
    {"overflow-in-interrupt", overflow_in_interrupt},
    {"unexpected-interrupt", unexpected_interrupt},
    {"starve-watchdog", starve_watchdog},
}};

// The last word of the command line; empty without a semihosting host.
std::string_view wanted() {
  static std::array<char, 128> text{};
  if (!volcomp::hal::virt::semihosting::command_line(text)) return {};
  std::string_view line = text.data();
  line.remove_prefix(line.rfind(' ') + 1);
  return line;
}

}  // namespace

void volcomp::boards::on_tick() {
  timer.acknowledge();
  if (fault_in_tick) static_cast<void>(overflow(0));
}

void volcomp::boards::on_pci_interrupt(std::uint32_t /*id*/) {}

int main() {
  using volcomp::boards::kCheckFailed;
  if (volcomp::boards::take_reset_cause() == volcomp::hal::ResetCause::watchdog) {
    uart::put("restarted by the watchdog\n");
    return volcomp::boards::kFine;
  }
  const std::string_view name = wanted();
  if (name.empty()) read_wild_pointer();
  if (name == "feed-watchdog") return feed_watchdog();
  for (const Misdeed& misdeed : kMisdeeds) {
    if (name != misdeed.name) continue;
    misdeed.commit();
    uart::put("nothing stopped it\n");
    return kCheckFailed;
  }
  uart::put("unknown misdeed\n");
  return volcomp::boards::kUnusableInput;
}
