// The compensation node on a Kvaser card. It keeps nothing through a restart: the machine has no
// memory for that.

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "firmware/boards/virt-a53/interrupts.hpp"
#include "firmware/boards/virt-a53/reset_cause.hpp"
#include "firmware/node/node_task.hpp"
#include "hal/virt/generic_timer.hpp"
#include "hal/virt/interrupt_lock.hpp"
#include "hal/virt/kvaser_pci.hpp"
#include "hal/virt/uart.hpp"
#include "hal/virt/watchdog.hpp"

extern "C" {
// Symbols of the linker script: only their addresses count.
extern const std::uint8_t code_begin[];
extern const std::uint8_t constants_end[];
}

namespace {

namespace uart = volcomp::hal::virt::uart;
using volcomp::hal::CanBusState;

constexpr std::uint8_t kNodeId = 32;
constexpr std::uint32_t kTickPeriod_us = 1000;
constexpr std::uint32_t kBite_us = 2'000'000;  // a busy computer may hold up its emulator that long

std::array<volcomp::hal::virt::KvaserCard, 1> cards;
volcomp::hal::virt::KvaserCan can;
volcomp::hal::virt::PeriodicTimer timer;
volcomp::hal::virt::Clock the_clock;
volcomp::hal::virt::InterruptMask interrupts;
volcomp::hal::virt::Watchdog watchdog;

// Constructed at main's first call: no constructor runs before main.
auto& the_task() {
  static volcomp::node::NodeTask task(volcomp::node::Board{can, the_clock, interrupts, watchdog},
                                      kNodeId, nullptr);
  return task;
}

bool join_bus() {
  if (volcomp::hal::virt::find_kvaser_cards(cards) == 0) return false;
  if (!can.start({cards[0].sja1000}, volcomp::hal::virt::kKvaser1Mbit)) return false;
  volcomp::hal::virt::gic::enable(cards[0].interrupt);
  return true;
}

const char* in_words(CanBusState state) {
  switch (state) {
    case CanBusState::stopped:
      break;
    case CanBusState::active:
      return "CAN: in order\n";
    case CanBusState::warning:
      return "CAN: many errors\n";
    case CanBusState::passive:
      return "CAN: so many errors that the controller is error passive\n";
    case CanBusState::off:
      return "CAN: bus-off, nothing is sent or received for a while\n";
  }
  return "CAN: stopped\n";
}

// What a person at the serial line should know about the bus, when it changes.
void report_bus() {
  static CanBusState told_state = CanBusState::stopped;
  static std::uint32_t told_losses = 0;
  const CanBusState state = can.state();
  if (state != told_state) uart::put(in_words(state));
  told_state = state;
  const volcomp::hal::Sja1000Counters counters = can.counters();
  const std::uint32_t losses = counters.fifo_overruns + counters.ring_overruns;
  if (losses == told_losses) return;
  told_losses = losses;
  uart::put("CAN: frames were lost, times so far: ");
  uart::put_unsigned(losses);
  uart::put("\n");
}

}  // namespace

void volcomp::boards::on_tick() {
  if (timer.acknowledge()) {
    can.supervise(the_clock.now_us());
    the_task().frames_lost(can.take_losses());
    the_task().bus_state(can.state());
    the_task().on_timer_interrupt();
  } else {
    the_task().on_bus_interrupt();
  }
  timer.set_alarm(the_task().deadline_us());
}

void volcomp::boards::on_pci_interrupt(std::uint32_t /*id*/) {
  can.on_interrupt();
  the_task().on_bus_interrupt();
  timer.set_alarm(the_task().deadline_us());
}

int main() {
  uart::put("volcomp-node: node 32 on an SJA1000, 1 Mbit/s\n");
  if (!join_bus()) {
    uart::put("volcomp-node: there is no Kvaser card with an SJA1000\n");
    return volcomp::boards::kUnusableInput;
  }
  the_task().watch_program({code_begin, static_cast<std::size_t>(constants_end - code_begin)});
  the_task().power_on(volcomp::boards::take_reset_cause());
  watchdog.start(kBite_us);
  timer.start(kTickPeriod_us);
  interrupts.leave();
  for (;;) {
    report_bus();
    if (!the_task().background_step()) volcomp::hal::virt::wait_for_interrupt();
  }
}
