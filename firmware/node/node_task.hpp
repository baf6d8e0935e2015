#pragma once
// The compensation node on a board: a timer interrupt, an interrupt of the bus and one background,
// as every board's main uses it.
//
//   BoardPort port;  BoardClock clock;          // hal/can_port.hpp, hal/clock.hpp
//   BoardSection section;  BoardWatchdog dog;   // hal/critical_section.hpp, hal/watchdog.hpp
//
//   using Task = NodeTask<BoardPort, BoardClock, BoardSection, BoardWatchdog>;
//   Task* task = nullptr;
//   extern "C" void timer_handler() { task->on_timer_interrupt(); }  // every millisecond, say
//   extern "C" void can_handler() { task->on_bus_interrupt(); }      // a frame has come
//
//   int main() {
//     static Task the_task({port, clock, section, dog}, kNodeId, &storage);
//     task = &the_task;
//     task->power_on(board_reset_cause());  // loads and checks the stored tables
//     dog.start();                          // bites after several ticks without food
//     timer.start();
//     for (;;) {
//       if (!task->background_step()) wait_for_interrupt();
//     }
//   }
//
// Both interrupts have one priority, so that neither interrupts the other. A board without the
// second is late by up to a period of the timer: enough for offsets 60B0h, not for forwarded
// targets at 500 Hz. One with an alarm sets it to deadline_us() at the end of each of the two, and
// calls on_bus_interrupt() when it goes off.
//
// The timer does what a loop around a node does (canopen/exchange.hpp), in the same order,
// except what takes long: SDO requests and resets wait for the background, and what could disturb
// the background in the middle of such work waits with them. So with a background that keeps up,
// the frames of this node are those of a node in one context, in every single turn.
//
// A port that exchanges whole turns (a frame pipe) has two more members, called around each
// interrupt's work: begin_turn() and end_turn().

#include <type_traits>
#include <utility>

#include "firmware/node/guardian.hpp"
#include "firmware/node/node.hpp"
#include "hal/can_port.hpp"
#include "hal/clock.hpp"
#include "hal/critical_section.hpp"
#include "hal/frame_ring.hpp"
#include "hal/watchdog.hpp"

namespace volcomp::node {

template <class Port, class = void>
struct ExchangesTurns : std::false_type {};

template <class Port>
struct ExchangesTurns<Port, std::void_t<decltype(std::declval<Port&>().begin_turn()),
                                        decltype(std::declval<Port&>().end_turn())>>
    : std::true_type {};

// What a board gives; all of it must outlive the task.
template <class Port, class Clock, class Section, class Watchdog>
struct Board {
  Port& port;
  const Clock& clock;
  Section& section;
  Watchdog& watchdog;
};
template <class Port, class Clock, class Section, class Watchdog>
Board(Port&, const Clock&, Section&, Watchdog&) -> Board<Port, Clock, Section, Watchdog>;

template <class Port, class Clock, class Section, class Watchdog>
class NodeTask final : private Preemption {
  static_assert(hal::IsCanPort<Port>::value, "see hal/can_port.hpp");
  static_assert(hal::IsClock<Clock>::value, "see hal/clock.hpp");
  static_assert(hal::IsCriticalSection<Section>::value, "see hal/critical_section.hpp");
  static_assert(hal::IsWatchdog<Watchdog>::value, "see hal/watchdog.hpp");

 public:
  // `node_id` 1…127; `storage` may be nullptr, as with a Node.
  NodeTask(const Board<Port, Clock, Section, Watchdog>& board, std::uint8_t node_id,
           Storage* storage, const GuardianSettings& guardian = {})
      : board_(board), guardian_(guardian), node_(node_id, storage, this) {}
  NodeTask(const NodeTask&) = delete;
  NodeTask& operator=(const NodeTask&) = delete;
  ~NodeTask() = default;

  // Code and constants, see Node; before power_on().
  void watch_program(Span<const std::uint8_t> program) { node_.watch_program(program); }
  // Once, before the timer runs. Takes as long as loading and checking the stored tables.
  void power_on(ResetCause cause) {
    const Guarded guarded(board_.section);
    node_.power_on(board_.clock.now_us(), cause);
  }

  // --- interrupts

  void on_timer_interrupt() {
    if constexpr (ExchangesTurns<Port>::value) board_.port.begin_turn();
    const std::uint64_t now_us = board_.clock.now_us();
    watch(now_us);
    exchange(now_us, true);
    if constexpr (ExchangesTurns<Port>::value) board_.port.end_turn();
    if (guardian_.state() != Guardian::State::starving) board_.watchdog.feed();
  }

  // Frames have come, or deadline_us() has: what they complete is computed and leaves at once.
  // Heartbeats, time-outs and the watchdog remain the timer's.
  void on_bus_interrupt() { exchange(board_.clock.now_us(), false); }

  // When the open cycle is computed with what has come until then, µs; UINT64_MAX: none is open.
  [[nodiscard]] std::uint64_t deadline_us() const { return node_.deadline_us(); }

  // The port lost frames before they could be fetched (overrun of the controller). From the tick
  // interrupt, for instance out of the port's receive().
  void frames_lost(std::uint32_t count) { lost_ += count; }

  // What the port knows of its controller (Node::bus_state). From the tick interrupt.
  void bus_state(hal::CanBusState state) { node_.bus_state(state); }

  // --- background

  // One frame and one touch that wait, and the scrub when it is due. False: nothing is left to do
  // until the next interrupt.
  bool background_step() {
    guardian_.alive();
    serve();
    probe();
    if constexpr (kWatchesStrokes) strokes();
    scrub();
    return waiting_count_ != 0;
  }

  // Only what a single access reads may be looked at while the timer runs.
  [[nodiscard]] const Node& node() const { return node_; }
  [[nodiscard]] const Guardian& guardian() const { return guardian_; }

 private:
  // A block of an SDO download comes without a pause: 127 segments, and what else is under way.
  static constexpr std::size_t kWaiting = 256;
  // Per interrupt; more than the bus carries in a millisecond (21 frames at 1 Mbit/s). What a port
  // still has stays there.
  static constexpr int kMostFetched = 256;
  static constexpr int kMostSent = 32;

  class Guarded {
   public:
    explicit Guarded(Section& section) : section_(section) { section_.enter(); }
    Guarded(const Guarded&) = delete;
    Guarded& operator=(const Guarded&) = delete;
    ~Guarded() { section_.leave(); }

   private:
    Section& section_;
  };

  // The scopes nest, the section does not. `scopes_` changes with the tick kept out.
  void allow() override {
    if (scopes_++ != 0) return;
    guardian_.announce_long_work(true);
    board_.section.leave();
  }
  void forbid() override {
    if (scopes_ == 1) {
      board_.section.enter();
      guardian_.announce_long_work(false);
    }
    --scopes_;
  }

  void serve() {
    const Guarded guarded(board_.section);
    hal::CanFrame frame;
    if (!waiting_.pop(frame)) return;
    node_.device().receive(frame, board_.clock.now_us());
    --waiting_count_;
  }
  void probe() {
    const Guarded guarded(board_.section);
    node_.poll_probe();
  }
  void strokes() {
    const Guarded guarded(board_.section);
    node_.poll_strokes();
  }
  // A slice keeps services waiting, so each waits in turn until all of them have been served: a
  // processor that is short of time would else lose frames.
  void scrub() {
    const Guarded guarded(board_.section);
    if (!served_) return;
    served_ = false;
    node_.poll_scrub(board_.clock.now_us());
  }

  // The background is neither in the middle of long work nor owes one for a frame.
  [[nodiscard]] bool undisturbed() const { return scopes_ == 0 && waiting_count_ == 0; }

  void watch(std::uint64_t now_us) {
    const Guardian::State before = guardian_.state();
    const Guardian::State state = guardian_.check(now_us, node_.at_rest(), node_.drives_follow());
    if (state == before) return;
    if (state == Guardian::State::ramping) node_.background_overdue(true);
    if (state == Guardian::State::trusting) node_.background_overdue(false);
  }

  void exchange(std::uint64_t now_us, bool with_services) {
    fetch(now_us);
    if (with_services && undisturbed()) {
      node_.device().poll_services(now_us);
      served_ = true;
    }
    node_.device().poll_cycle(now_us);
    send(now_us);
  }

  void fetch(std::uint64_t now_us) {
    hal::CanFrame frame;
    for (int i = 0; i < kMostFetched && board_.port.receive(frame); ++i) {
      const NodeDevice::Work work = node_.device().work(frame);
      if (work == NodeDevice::Work::cyclic) {
        node_.device().receive_cyclic(frame, now_us);
      } else if (work == NodeDevice::Work::service && undisturbed()) {
        node_.device().receive_service(frame, now_us);
      } else if (waiting_.push(frame)) {
        ++waiting_count_;
      } else {
        ++lost_;
      }
    }
    // The loss is over when everything that waited has been served.
    if (scopes_ == 0 && (lost_ != 0 || waiting_count_ == 0))
      node_.frames_lost(std::exchange(lost_, 0));
  }

  void send(std::uint64_t now_us) {
    hal::CanFrame frame;
    for (int i = 0; i < kMostSent; ++i) {
      if (!node_.device().offer(frame, now_us) || !board_.port.send(frame)) return;
      node_.device().taken(board_.clock.now_us());  // when it was handed over: 2620h
    }
  }

  Board<Port, Clock, Section, Watchdog> board_;
  Guardian guardian_;
  hal::FrameRing<kWaiting> waiting_;  // interrupt → background
  std::uint32_t waiting_count_ = 0;   // of them not yet served
  std::uint32_t lost_ = 0;            // frames, not yet reported
  int scopes_ = 0;                    // of preemptible work, one inside the other
  bool served_ = false;               // services were polled since the last slice of the scrub
  Node node_;
};

}  // namespace volcomp::node
