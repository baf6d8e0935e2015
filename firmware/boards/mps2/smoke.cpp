// The smallest image: proves startup, clock, tick interrupt, counter and link script of a board.

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/stack.hpp"
#include "hal/mps2/clock.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/instruction_counter.hpp"
#include "hal/mps2/timer.hpp"

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::hal::mps2::InstructionCounter;

constexpr std::uint32_t kPeriod_us = 1000;
constexpr std::uint32_t kTicks = 100;

volatile std::uint32_t ticks = 0;
volatile double six = 6.0;  // the product is done at run time, with or without a double FPU

void put_line(const char* name, std::uint32_t value) {
  console::put(name);
  console::put_unsigned(value);
  console::put("\n");
}

// Without what the readings themselves cost.
std::uint32_t count_hundred_nops(InstructionCounter& counter) {
  const std::uint32_t begin = InstructionCounter::ticks();
  const std::uint32_t before = InstructionCounter::ticks();
  __asm volatile(".rept 100\n nop\n .endr" ::: "memory");
  const std::uint32_t after = InstructionCounter::ticks();
  return counter.between(before, after) - counter.between(begin, before);
}

}  // namespace

extern "C" void TIMER0_Handler() {
  volcomp::hal::mps2::timer0.acknowledge();
  ticks = ticks + 1;
}

int main() {
  const volcomp::hal::mps2::Clock clock;
  volcomp::hal::mps2::Clock::start();
  InstructionCounter counter;
  counter.start();
  volcomp::hal::mps2::timer0.start(kPeriod_us);
  const std::uint64_t begin_us = clock.now_us();
  while (ticks < kTicks) {
  }
  const auto elapsed_us = static_cast<std::uint32_t>(clock.now_us() - begin_us);

  const std::uint32_t nops = count_hundred_nops(counter);
  const auto product = static_cast<std::uint32_t>(six * 7.0);
  put_line("ticks of 1 ms            ", ticks);
  put_line("microseconds             ", elapsed_us);
  put_line("instructions, 100 nops   ", nops);
  put_line("6 x 7 in double          ", product);
  put_line("stack, deepest, bytes    ", volcomp::boards::deepest_stack_bytes());
  const bool time_right =
      elapsed_us > (kTicks - 1) * kPeriod_us && elapsed_us < (kTicks + 1) * kPeriod_us;
  const bool fine = time_right && nops == 100 && counter.exact() && product == 42;
  return fine ? volcomp::boards::kFine : volcomp::boards::kCheckFailed;
}
