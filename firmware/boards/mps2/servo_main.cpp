// volcomp-servo: the integrated form on a board. Two timers of 5 kHz: one turns the simulated
// encoders, half a period later the other runs the servo loop. Prints what the offsets were, which
// a PC prints to the last bit the same (firmware/embed/cpp/servo_host.cpp), and fails when a servo
// interrupt took longer than its period.

#include <atomic>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/stack.hpp"
#include "firmware/embed/cpp/servo_example.hpp"
#include "hal/mps2/clock.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/instruction_counter.hpp"
#include "hal/mps2/timer.hpp"

// Made by servo_tables.S: a table image in flash, as `volcomp build-tables` writes it.
extern "C" const std::uint8_t servo_tables_begin[];
extern "C" const std::uint8_t servo_tables_end[];

namespace {

using volcomp::example::ServoExample;
using volcomp::hal::mps2::InstructionCounter;
namespace console = volcomp::hal::mps2::console;

constexpr std::uint32_t kPeriod_us = 1'000'000 / volcomp::example::kServo_Hz;

// console.hpp as an object.
struct Uart {
  static void put(const char* text) { console::put(text); }
  static void put_unsigned(std::uint32_t value) { console::put_unsigned(value); }
  static void put_decimal(std::int32_t value) { console::put_decimal(value); }
  static void put_hex(std::uint32_t value) { console::put_hex(value); }
};

// Constructed at main's first call: no constructor runs before main. In .bss, or in tightly coupled
// memory where a linker script gives that section a place (tightly_coupled.ld).
ServoExample& example() {
  [[gnu::section(".bss.dtcm")]] static ServoExample the_example;
  return the_example;
}

InstructionCounter counter;
volatile std::uint32_t fewest_instructions = UINT32_MAX;
volatile std::uint32_t most_instructions = 0;

// Counts the periods of the summary, which only the servo interrupt writes. Atomic, because main
// waits for it and the compiler may read a plain variable once. Released after the summary, so that
// main prints a complete one.
std::atomic<std::uint32_t> periods_done{0};

bool finished() { return periods_done.load(std::memory_order_acquire) >= ServoExample::kPeriods; }

void note_instructions(std::uint32_t count) {
  if (count < fewest_instructions) fewest_instructions = count;
  if (count > most_instructions) most_instructions = count;
}

void wait_us(std::uint32_t time_us) {
  const volcomp::hal::mps2::Clock clock;
  const std::uint64_t end_us = clock.now_us() + time_us;
  while (clock.now_us() < end_us) {
  }
}

// In QEMU, see instruction_counter.hpp.
constexpr std::uint32_t kInstructionTime_ns = 64;
constexpr std::uint32_t kInstructionsOfPeriod = kPeriod_us * 1000 / kInstructionTime_ns;

// Whether every servo interrupt ended within its period, as far as instructions are counted.
bool tell_cost() {
  if (!counter.exact()) return true;
  console::put("servo interrupt: ");
  console::put_unsigned(fewest_instructions);
  console::put(" to ");
  console::put_unsigned(most_instructions);
  console::put(" instructions of ");
  console::put_unsigned(kInstructionsOfPeriod);
  console::put("\nstack: ");
  console::put_unsigned(volcomp::boards::deepest_stack_bytes());
  console::put(" bytes\n");
  if (most_instructions <= kInstructionsOfPeriod) return true;
  console::put("a servo interrupt took longer than its period\n");
  return false;
}

}  // namespace

// When both timers are pending, this one is served first: encoders turn in time even when a servo
// period takes too long.
extern "C" void TIMER0_Handler() {
  volcomp::hal::mps2::timer0.acknowledge();
  if (!finished()) example().machine().advance();
}

extern "C" void TIMER1_Handler() {
  volcomp::hal::mps2::timer1.acknowledge();
  if (finished()) return;
  const std::uint32_t from = InstructionCounter::ticks();
  example().on_servo_interrupt();
  note_instructions(counter.between(from, InstructionCounter::ticks()));
  periods_done.store(example().summary().periods, std::memory_order_release);
}

int main() {
  const volcomp::Span<const std::uint8_t> image{
      servo_tables_begin, static_cast<std::size_t>(servo_tables_end - servo_tables_begin)};
  const volcomp::Status status = example().commission(image);
  if (!status.ok()) {
    console::put("the table image: ");
    console::put(sentence(status.reason));
    console::put("\n");
    return volcomp::boards::kUnusableInput;
  }
  counter.start();
  volcomp::hal::mps2::Clock::start();
  volcomp::hal::mps2::timer0.start(kPeriod_us);
  wait_us(kPeriod_us / 2);
  volcomp::hal::mps2::timer1.start(kPeriod_us);
  while (!finished()) {
  }
  Uart uart;
  tell(example().summary(), uart);
  return tell_cost() ? volcomp::boards::kFine : volcomp::boards::kCheckFailed;
}
