// Commits the misdeed that its command line names and has to be stopped by the board. Ends with 1
// when nothing stopped it; faults_test.sh judges the report.

#include <array>
#include <cstdint>
#include <cstring>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "hal/mps2/clock.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/registers.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/watchdog.hpp"

namespace {

using volcomp::hal::ResetCause;
using volcomp::hal::mps2::Clock;
using volcomp::hal::mps2::Watchdog;
namespace console = volcomp::hal::mps2::console;

constexpr std::uint32_t kBite_us = 10'000;

// The compiler must not see where a pointer leads.
std::uint32_t hidden(std::uint32_t number) {
  volatile std::uint32_t copy = number;
  return copy;
}
volatile std::uint32_t& word_at(std::uint32_t address) {
  return volcomp::hal::mps2::device_register(hidden(address));
}

volatile std::uint32_t sink = 0;
[[gnu::noinline]] void read_null_pointer() { sink = word_at(16); }
[[gnu::noinline]] void read_wild_pointer() { sink = word_at(0x7000'0000); }
[[gnu::noinline]] void read_behind_ram() { sink = word_at(0x2010'0000); }
[[gnu::noinline]] void read_absent_device() { sink = word_at(0x4001'0000); }
[[gnu::noinline]] void write_flash() { word_at(0x1000) = 0; }
[[gnu::noinline]] void undefined_instruction() { __asm volatile("udf #0"); }
[[gnu::noinline]] void breakpoint() { __asm volatile("bkpt #0"); }

[[gnu::noinline]] void execute_ram() {
  static std::array<std::uint16_t, 2> code = {0x4770, 0x4770};  // bx lr
  const std::uint32_t entry = reinterpret_cast<std::uintptr_t>(code.data()) | 1U;
  __asm volatile("blx %0" : : "r"(entry) : "lr", "memory");
}

// Touches every word on its way down, as ordinary nested calls do.
// NOLINTNEXTLINE(misc-no-recursion)
[[gnu::noinline]] std::uint32_t overflow_in_small_steps(std::uint32_t depth) {
  volatile std::uint32_t frame[16] = {};  // NOLINT(modernize-avoid-c-arrays)
  frame[depth % 16U] = depth;
  if (depth == hidden(1'000'000)) return 0;
  return overflow_in_small_steps(depth + 1) + frame[depth % 16U];
}

// One frame that is larger than stack and guard together, written at its far end first.
[[gnu::noinline]] void overflow_in_one_leap() {
  volatile std::uint8_t frame[40'000];  // NOLINT(modernize-avoid-c-arrays)
  frame[0] = 1;
  sink = frame[0];
}

[[gnu::noinline]] void fault_while_interrupts_are_off() {
  __asm volatile("cpsid i" ::: "memory");
  read_wild_pointer();
}

[[gnu::noinline]] void unexpected_interrupt() {
  constexpr std::uint32_t kSetEnable = 0xE000'E100;
  constexpr std::uint32_t kSetPending = 0xE000'E200;
  constexpr std::uint32_t kNobodysInterrupt = 1U << 20U;
  word_at(kSetEnable) = kNobodysInterrupt;
  word_at(kSetPending) = kNobodysInterrupt;
}

void wait(const Clock& clock, std::uint32_t time_us) {
  const std::uint64_t end_us = clock.now_us() + time_us;
  while (clock.now_us() < end_us) {
  }
}

[[gnu::noinline]] void starve_watchdog() {
  const Clock clock;
  Clock::start();
  Watchdog watchdog;
  watchdog.start(kBite_us);
  wait(clock, 2 * kBite_us);
}

// Not a misdeed: shows that the watchdog of the test above bites for want of food, not always.
int feed_watchdog() {
  const Clock clock;
  Clock::start();
  Watchdog watchdog;
  watchdog.start(kBite_us);
  for (int i = 0; i < 20; ++i) {
    wait(clock, kBite_us / 2);
    const std::uint32_t left_us = watchdog.remaining_us();
    if (left_us < kBite_us / 4 || left_us > kBite_us / 2) return volcomp::boards::kCheckFailed;
    watchdog.feed();
  }
  console::put("the watchdog was fed\n");
  return volcomp::boards::kFine;
}

struct Misdeed {
  const char* name;
  void (*commit)();
};

constexpr std::array<Misdeed, 13> kMisdeeds = {{
    {"null-pointer", read_null_pointer},
    {"wild-pointer", read_wild_pointer},
    {"behind-ram", read_behind_ram},
    {"absent-device", read_absent_device},
    {"write-flash", write_flash},
    {"execute-ram", execute_ram},
    {"undefined", undefined_instruction},
    {"breakpoint", breakpoint},
    {"overflow", [] { static_cast<void>(overflow_in_small_steps(0)); }},
    {"overflow-leap", overflow_in_one_leap},
    {"interrupts-off", fault_while_interrupts_are_off},
    {"unexpected-interrupt", unexpected_interrupt},
    {"starve-watchdog", starve_watchdog},
}};

// The last word of the command line; empty without a semihosting host.
const char* wanted() {
  static std::array<char, 128> line{};
  if (!volcomp::hal::mps2::semihosting::command_line(line)) return "";
  const char* const space = std::strrchr(line.data(), ' ');
  return space == nullptr ? line.data() : space + 1;
}

}  // namespace

int main() {
  const ResetCause cause = volcomp::boards::take_reset_cause();
  if (cause == ResetCause::watchdog) console::put("restarted by the watchdog\n");
  if (cause == ResetCause::fault) console::put("restarted after a fault\n");
  if (cause != ResetCause::power_on) return volcomp::boards::kFine;
  const char* const name = wanted();
  if (*name == '\0') {
    Watchdog watchdog;
    watchdog.start(kBite_us);
    read_wild_pointer();
  }
  if (std::strcmp(name, "feed-watchdog") == 0) return feed_watchdog();
  for (const Misdeed& misdeed : kMisdeeds) {
    if (std::strcmp(name, misdeed.name) != 0) continue;
    misdeed.commit();
    console::put("nothing stopped it\n");
    return volcomp::boards::kCheckFailed;
  }
  console::put("unknown misdeed\n");
  return volcomp::boards::kUnusableInput;
}
