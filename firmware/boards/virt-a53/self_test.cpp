// Proves the board: two SJA1000 on one bus send each other frames by interrupt while the tick runs.
// Nothing beyond the emulator is needed. Prints a line for each check; ends with 1 if one failed.

#include <array>
#include <cstdint>

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "firmware/boards/virt-a53/interrupts.hpp"
#include "hal/virt/generic_timer.hpp"
#include "hal/virt/kvaser_pci.hpp"
#include "hal/virt/uart.hpp"

// In self_test_registers.S.
extern "C" std::uint64_t registers_lost(const volatile std::uint32_t* ticks);

namespace {

namespace uart = volcomp::hal::virt::uart;
using volcomp::hal::CanFrame;
using volcomp::hal::virt::InterruptLock;
using volcomp::hal::virt::KvaserCan;
using volcomp::hal::virt::KvaserCard;

constexpr std::uint32_t kTickPeriod_us = 1000;
constexpr std::uint32_t kRounds = 5000;
constexpr std::uint32_t kBurst = 5;  // of 11 bytes each fit the FIFO of the chip
constexpr std::uint32_t kPatience_us = 10'000'000;

volcomp::hal::virt::PeriodicTimer timer;
volatile std::uint32_t ticks = 0;
volatile std::uint32_t alarms = 0;
volatile double sum_of_ticks = 0.0;  // so that the interrupt needs the FPU
std::array<KvaserCard, 2> cards;
std::array<KvaserCan, 2> can;

bool check(bool good, const char* what) {
  uart::put(good ? "ok     " : "WRONG  ");
  uart::put(what);
  uart::put("\n");
  return good;
}

// The same numbers in every run (C. E. Knuth's MMIX generator, upper half).
class Random {
 public:
  std::uint32_t next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(state_ >> 32U);
  }

 private:
  std::uint64_t state_ = 1;
};

CanFrame random_frame(Random& random) {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(random.next() & volcomp::hal::kMaxCanId);
  frame.size = static_cast<std::uint8_t>(random.next() % 9U);
  for (std::size_t i = 0; i < frame.size; ++i)
    frame.data[i] = static_cast<std::uint8_t>(random.next());
  return frame;
}

bool receive_within_patience(KvaserCan& port, CanFrame& frame) {
  const volcomp::hal::virt::Clock clock;
  const std::uint64_t begin_us = clock.now_us();
  while (!port.receive(frame)) {
    if (clock.now_us() - begin_us > kPatience_us) return false;
  }
  return true;
}

bool two_cards_start() {
  if (!check(volcomp::hal::virt::find_kvaser_cards(cards) == 2, "two CAN cards on the PCI bus"))
    return false;
  bool started = true;
  for (std::size_t i = 0; i < cards.size(); ++i) {
    started = can[i].start({cards[i].sja1000}, volcomp::hal::virt::kKvaser1Mbit) && started;
    volcomp::hal::virt::gic::enable(cards[i].interrupt);
  }
  return check(started, "an SJA1000 answers on each");
}

// `from` sends a burst, the other one has to receive the same.
bool burst_arrives(Random& random, KvaserCan& from, KvaserCan& to) {
  std::array<CanFrame, kBurst> sent;
  for (CanFrame& frame : sent) {
    frame = random_frame(random);
    if (!from.send(frame)) return false;
  }
  for (const CanFrame& frame : sent) {
    CanFrame got;
    if (!receive_within_patience(to, got) || got != frame) return false;
  }
  return true;
}

bool frames_arrive() {
  Random random;
  bool right = true;
  for (std::uint32_t round = 0; round < kRounds && right; ++round) {
    right = burst_arrives(random, can[0], can[1]) && burst_arrives(random, can[1], can[0]);
  }
  check(right, "50000 frames back and forth arrive as they were sent, by interrupt");
  constexpr std::uint32_t kEach = kRounds * kBurst;
  bool counted = true;
  for (const KvaserCan& port : can) {
    const volcomp::hal::Sja1000Counters c = port.counters();
    counted = counted && c.sent == kEach && c.received == kEach && c.refused == 0 &&
              c.fifo_overruns == 0 && c.ring_overruns == 0 && c.bus_offs == 0;
  }
  return check(counted, "the counters of both controllers say the same") && right;
}

// With the interrupt kept out the chip has room for five frames of eight bytes.
bool overrun_is_noticed() {
  const std::uint32_t before = can[1].counters().fifo_overruns;
  CanFrame frame;
  frame.size = 8;
  {
    const InterruptLock lock;
    for (frame.id = 1; frame.id <= kBurst + 2; ++frame.id)
      static_cast<void>(can[0].send(frame));
  }
  std::uint32_t arrived = 0;
  for (CanFrame got; can[1].receive(got); ++arrived) {
    if (got.id != arrived + 1) return check(false, "the oldest frames survive an overrun");
  }
  const bool counted = can[1].counters().fifo_overruns == before + 1;
  frame.id = 0x7FF;
  CanFrame got;
  const bool goes_on = can[0].send(frame) && receive_within_patience(can[1], got) && got == frame;
  return check(arrived == kBurst && counted && goes_on,
               "an overrun of the chip is counted, costs the newest frames, and is over");
}

bool tick_leaves_everything_alone() {
  constexpr std::uint32_t kTicks = 100;
  const volcomp::hal::virt::Clock clock;
  const std::uint64_t begin_us = clock.now_us();
  std::uint64_t lost = 0;
  for (std::uint32_t i = 0; i < kTicks; ++i)
    lost += registers_lost(&ticks);
  const std::uint64_t elapsed_us = clock.now_us() - begin_us;
  const bool never_early = elapsed_us > std::uint64_t{kTicks - 2} * kTickPeriod_us;
  const bool kept = check(lost == 0, "100 ticks leave all registers, FPU included, as they were");
  return check(never_early, "no tick comes early") && kept;
}

// Set for half a period after a tick.
bool alarm_goes_off_between_ticks() {
  constexpr std::uint32_t kAlarms = 20;
  const volcomp::hal::virt::Clock clock;
  for (std::uint32_t i = 0; i < kAlarms; ++i) {
    const std::uint32_t before = ticks;
    while (ticks == before) {
    }
    const InterruptLock lock;
    timer.set_alarm(clock.now_us() + kTickPeriod_us / 2);
  }
  const std::uint32_t last = ticks;
  while (ticks - last < 2) {
  }
  // A busy computer may hold up its emulator beyond the next period, which comes first then.
  return check(alarms > 0 && alarms <= kAlarms, "an alarm goes off between two ticks");
}

}  // namespace

void volcomp::boards::on_tick() {
  if (!timer.acknowledge()) {
    alarms = alarms + 1;
    return;
  }
  ticks = ticks + 1;
  sum_of_ticks = sum_of_ticks + 1.0;
}

void volcomp::boards::on_pci_interrupt(std::uint32_t id) {
  for (std::size_t i = 0; i < cards.size(); ++i) {
    if (cards[i].interrupt == id) can[i].on_interrupt();
  }
}

int main() {
  timer.start(kTickPeriod_us);
  volcomp::hal::virt::InterruptMask().leave();
  const bool fine = two_cards_start() && frames_arrive() && overrun_is_noticed() &&
                    tick_leaves_everything_alone() && alarm_goes_off_between_ticks();
  return fine ? volcomp::boards::kFine : volcomp::boards::kCheckFailed;
}
