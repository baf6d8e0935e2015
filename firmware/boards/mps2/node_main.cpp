// volcomp-node: the compensation node on a board. Timer 0 interrupts at 1 kHz; timer 1 does when a
// frame has come or the open cycle is due; all the rest is the background. See
// firmware/node/node_task.hpp.
//
// After a permanent failure the node sends nothing: the drives keep their last offset, and the
// missing heartbeat stops the feed. The next start reports the cause of the restart.

#include <array>
#include <string_view>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/linker_symbols.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "firmware/boards/mps2/stack.hpp"
#include "firmware/node/node_task.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "hal/mps2/clock.hpp"
#include "hal/mps2/console.hpp"
#include "hal/mps2/flash_blocks.hpp"
#include "hal/mps2/nvic.hpp"
#include "hal/mps2/pipe_port.hpp"
#include "hal/mps2/semihosting.hpp"
#include "hal/mps2/slcan_port.hpp"
#include "hal/mps2/tick_mask.hpp"
#include "hal/mps2/timer.hpp"
#include "hal/mps2/watchdog.hpp"

namespace {

using volcomp::hal::mps2::FlashBlocks;
using volcomp::hal::mps2::PipePort;
using volcomp::hal::mps2::TickMask;
using volcomp::hal::mps2::Watchdog;
namespace hal = volcomp::hal;
namespace console = volcomp::hal::mps2::console;

// The last word of the semihosting command line is "slcan"; anything else, or no debugger, selects
// the frame pipe.
bool slcan_is_wanted() {
  constexpr std::string_view kWord = " slcan";
  std::array<char, 128> text{};
  if (!hal::mps2::semihosting::command_line(text)) return false;
  std::string_view line(text.data());
  if (line.size() < kWord.size()) return false;
  line.remove_prefix(line.size() - kWord.size());
  return line == kWord;
}

// How the node reaches its bus, chosen when it starts: by the frame pipe, or by SLCAN on UART0. To
// the node it is one CAN port with one clock; see node_task.hpp.
class NodeLink {
 public:
  // False when the frame pipe cannot be opened.
  [[nodiscard]] bool open() {
    hal::mps2::Clock::start();
    is_pipe_ = !slcan_is_wanted();
    if (is_pipe_) return pipe_.open();
    slcan_.start();
    return true;
  }

  [[nodiscard]] bool is_pipe() const { return is_pipe_; }
  [[nodiscard]] const hal::mps2::PipePort& pipe() const { return pipe_; }
  [[nodiscard]] hal::mps2::SlcanPort& slcan() { return slcan_; }

  // A turn of the pipe is a tick of the node; SLCAN knows no turns.
  void begin_turn() {
    if (is_pipe_) pipe_.begin_turn();
  }
  void end_turn() {
    if (is_pipe_) pipe_.end_turn();
  }
  bool send(const hal::CanFrame& frame) {
    return is_pipe_ ? pipe_.send(frame) : slcan_.send(frame);
  }
  bool receive(hal::CanFrame& frame) {
    return is_pipe_ ? pipe_.receive(frame) : slcan_.receive(frame);
  }

  // In the pipe the time of the host, so that the node and the bus have one time.
  [[nodiscard]] std::uint64_t now_us() const { return is_pipe_ ? pipe_.now_us() : clock_.now_us(); }

 private:
  hal::mps2::PipePort pipe_;
  hal::mps2::SlcanPort slcan_;
  hal::mps2::Clock clock_;
  bool is_pipe_ = false;  // open() decides
};

using Task = volcomp::node::NodeTask<NodeLink, NodeLink, TickMask, Watchdog>;

constexpr std::uint8_t kNodeId = 32;
constexpr std::uint32_t kTick_us = 1000;
// From turn to turn of the frame pipe, in the emulator's count of instructions. A turn can hold a
// whole bus cycle and then keeps the processor busy for a millisecond; the background needs time
// after each.
constexpr std::uint32_t kTurn_us = 1250;

// How long the tick and the background may be overdue.
struct Timeouts {
  std::uint32_t bite_us;
  volcomp::node::GuardianSettings guardian;
};
// 20 ticks without food. Not a whole number, so that the bite falls between two ticks: inside one
// it could leave the other end of a frame pipe without the answer to its turn.
constexpr Timeouts kTurnByTurn{20 * kTurn_us + kTurn_us / 2, {}};
// In real time the emulated processor stops while the computer is busy, but its timers do not: up
// to a second was measured, after which all missed ticks come at once.
constexpr Timeouts kRealTime{5'000'000, {5'000'000, 5'000'000, 5'000'000}};

NodeLink link;
TickMask tick_mask;
Watchdog watchdog;
FlashBlocks flash;
Task* task = nullptr;  // main makes it before the interrupts start

// After the link is open.
const Timeouts& patience() { return link.is_pipe() ? kTurnByTurn : kRealTime; }

// Function-local, because nothing is constructed before main. In .bss, or in tightly coupled memory
// where a linker script gives that section a place (tightly_coupled.ld).
Task& make_task() {
  static volcomp::node::RecordStorage<FlashBlocks> storage(flash);
  [[gnu::section(".bss.dtcm")]] static Task the_task({link, link, tick_mask, watchdog}, kNodeId,
                                                     &storage, patience().guardian);
  return the_task;
}

bool attach_flash() {
  using volcomp::boards::address_of;
  const std::size_t bytes = address_of(block_memory_end) - address_of(block_memory_begin);
  return flash.attach({block_memory_begin, bytes});
}

int give_up(const char* sentence) {
  console::put(sentence);
  console::put("\n");
  return volcomp::boards::kUnusableInput;
}

int end_of_pipe(PipePort::End end) {
  switch (end) {
    case PipePort::End::gone:
      return give_up("The other end of the frame pipe is gone.");
    case PipePort::End::nonsense:
      return give_up("What comes from the frame pipe is not a record of it.");
    case PipePort::End::too_many_frames:
      return give_up("The frame pipe brought more frames in one turn than fit.");
    case PipePort::End::told_to_quit:
    case PipePort::End::none:
      break;
  }
  console::put("stack: ");
  console::put_unsigned(volcomp::boards::deepest_stack_bytes());
  console::put(" bytes\n");
  return volcomp::boards::kFine;
}

}  // namespace

namespace {

// The open cycle is computed when it is due, not up to a tick later.
void set_alarm() {
  const std::uint64_t now_us = link.now_us();
  const std::uint64_t due_us = task->deadline_us();
  if (due_us >= now_us + kTick_us) return;  // the next tick looks again
  volcomp::hal::mps2::timer1.set_alarm(due_us > now_us ? static_cast<std::uint32_t>(due_us - now_us)
                                                       : 1U);
}

}  // namespace

extern "C" void TIMER0_Handler() {
  volcomp::hal::mps2::timer0.acknowledge();
  task->on_timer_interrupt();
  if (link.is_pipe()) return;  // a turn has all its frames and is all its time
  task->frames_lost(link.slcan().take_losses());
  set_alarm();
}

extern "C" void TIMER1_Handler() {
  volcomp::hal::mps2::timer1.stop();
  volcomp::hal::mps2::timer1.acknowledge();
  task->on_bus_interrupt();
  set_alarm();
}

extern "C" void UARTRX0_Handler() {
  if (link.slcan().on_receive_interrupt()) volcomp::hal::mps2::timer1.raise();
}
extern "C" void UARTTX0_Handler() { link.slcan().on_transmit_interrupt(); }

int main() {
  if (!attach_flash()) return give_up("The board has less flash than the store wants.");
  if (!link.open())
    return give_up("There is no frame pipe: to_node and from_node must be where QEMU starts.");
  task = &make_task();
  const std::size_t program_bytes =
      volcomp::boards::address_of(constants_end) - volcomp::boards::address_of(code_begin);
  task->watch_program({code_begin, program_bytes});
  task->power_on(volcomp::boards::take_reset_cause());
  watchdog.start(patience().bite_us);
  volcomp::hal::mps2::timer0.start(link.is_pipe() ? kTurn_us : kTick_us);
  if (!link.is_pipe()) volcomp::hal::mps2::timer1.enable();
  while (link.pipe().end() == PipePort::End::none) {
    const bool more = task->background_step();
    // On the pipe every run must be alike, and in the emulator's count of instructions a waiting
    // processor loses time; see nvic.hpp.
    if (!more && !link.is_pipe()) volcomp::hal::mps2::nvic::wait_for_interrupt();
  }
  return end_of_pipe(link.pipe().end());
}
