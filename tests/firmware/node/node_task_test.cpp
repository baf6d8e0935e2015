// One interrupt and one background serve the node: what each of them does, in which order, and that
// the bus sees no difference.

#include <algorithm>
#include <functional>
#include <map>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/exchange.hpp"
#include "tests/firmware/node/task_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;
using canopen::NmtState;

using Frames = std::vector<hal::CanFrame>;

hal::CanFrame sdo_read(std::uint16_t index, std::uint8_t sub) {
  hal::CanFrame f{canopen::kSdoRequest + NodeBench::kId, 8, {0x40}};
  store_le(&f.data[1], 2, index);
  f.data[3] = sub;
  return f;
}

hal::CanFrame sdo_write_u32(std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
  hal::CanFrame f = sdo_read(index, sub);
  f.data[0] = 0x23;
  store_le(&f.data[4], 4, value);
  return f;
}

hal::CanFrame heartbeat(std::uint8_t node, NmtState state) {
  return {static_cast<std::uint16_t>(canopen::kHeartbeat + node),
          1,
          {static_cast<std::uint8_t>(state)}};
}

bool is_sdo(const hal::CanFrame& f) { return f.id == canopen::kSdoResponse + NodeBench::kId; }

Frames sdo_of(const Frames& frames) {
  Frames out;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(out), is_sdo);
  return out;
}

Frames others_of(const Frames& frames) {
  Frames out;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(out),
               [](const hal::CanFrame& f) { return !is_sdo(f); });
  return out;
}

NmtState nmt_state(const TaskBench& bench) { return bench.task->node().device().state(); }

// --- the same on the bus

// Everything that can be on a bus, at random: lost frames, drives that fall silent and return, NMT,
// heartbeats, requests. A node in one context and a task receive the same; what they send is equal
// turn by turn, SDO responses apart: they leave one turn later.
TEST(NodeTask, SaysWhatANodeInOneContextSays) {
  test::Random random(4711);
  SCOPED_TRACE(random.trace());
  TaskBench bench;
  NodeBench single;
  single.now_us = bench.clock.us;
  bench.configure();
  single.configure();
  const Bytes image = image_of(bench_tables());
  ASSERT_EQ(bench.write({0x2110, 1}, image), AbortCode::none);
  ASSERT_EQ(single.write({0x2110, 1}, image), AbortCode::none);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  ASSERT_EQ(single.command(TableCommand::activate), AbortCode::none);
  for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{127}}) {
    const auto sub = static_cast<std::uint8_t>(node == 1 ? 1 : 2);
    const std::uint32_t watch = std::uint32_t{node} << 16U | 60U;
    ASSERT_EQ(bench.set(0x1016, sub, watch), AbortCode::none);
    ASSERT_EQ(single.set(0x1016, sub, watch), AbortCode::none);
  }
  // Their heartbeats count from the moment 1017h is written; the task's was served a turn ago.
  ASSERT_EQ(bench.set<std::uint16_t>(0x1017, 0, 100), AbortCode::none);
  single.now_us = bench.clock.us - TaskBench::kTurn_us;
  ASSERT_EQ(single.set<std::uint16_t>(0x1017, 0, 100), AbortCode::none);

  BenchPort port;
  Frames sdo;
  Frames single_sdo;
  int compensating = 0;
  bool asked = false;
  for (int turn = 0; turn < 20'000; ++turn) {
    BenchBus& bus = bench.bus;
    const int event = static_cast<int>(random.integer(0, 399));
    if (event == 0) bus.drive[0].silent = !bus.drive[0].silent;
    if (event == 1) bus.drive[2].status ^= 0x0100U;
    if (event == 2 && !asked) bus.nmt(NmtCommand::stop);  // it would swallow the answer
    if (event == 3) bus.nmt(NmtCommand::enter_pre_operational);
    if (nmt_state(bench) != NmtState::operational && event > 380) bus.nmt(NmtCommand::start);
    if (event % 8 == 0) bus.put(heartbeat(127, NmtState::operational));
    if (event % 8 == 1) bus.put(heartbeat(1, event == 9 ? NmtState::boot_up : NmtState::stopped));
    bus.drive[1].target += static_cast<std::int32_t>(random.integer(-30'000, 30'000));

    bench.clock.us += TaskBench::kTurn_us;
    Frames frames = bus.turn();
    if (random.chance(0.05) && !frames.empty()) frames.pop_back();
    asked = event % 20 == 6;
    if (asked) frames.push_back(sdo_read(0x1018, static_cast<std::uint8_t>(turn % 5)));
    for (const hal::CanFrame& f : frames) {
      bench.port.in.push_back(f);
      port.in.push_back(f);
    }
    bench.port.out.clear();
    port.out.clear();
    bench.task->on_timer_interrupt();
    while (bench.task->background_step()) {
    }
    canopen::exchange(single.node->device(), port, bench.clock.us);
    ASSERT_EQ(others_of(bench.port.out), others_of(port.out)) << "turn " << turn;
    for (const hal::CanFrame& f : port.out)
      bus.hear(f);
    for (const hal::CanFrame& f : sdo_of(bench.port.out))
      sdo.push_back(f);
    for (const hal::CanFrame& f : sdo_of(port.out))
      single_sdo.push_back(f);
    compensating += bench.state() == NodeState::compensating ? 1 : 0;
  }
  if (sdo.size() < single_sdo.size()) single_sdo.pop_back();
  EXPECT_EQ(sdo, single_sdo);
  EXPECT_GT(sdo.size(), 100U);
  EXPECT_GT(compensating, 500) << "the bus was never quiet enough to show anything";
}

// --- the interrupt of the bus

bool is_offset(const hal::CanFrame& f) { return f.id > 0x300 && f.id <= 0x303; }

// Gives the frames of a turn one by one, each with its own interrupt of the bus.
Frames with_bus_interrupts(TaskBench& bench, const Frames& frames) {
  bench.port.out.clear();
  for (const hal::CanFrame& f : frames) {
    bench.port.in.push_back(f);
    bench.task->on_bus_interrupt();
  }
  return bench.port.out;
}

TEST(NodeTask, OffsetsLeaveWithTheLastFrameOfTheirCycle) {
  TaskBench bench;
  bench.bring_up();
  Frames frames = bench.bus.turn();
  if (frames.empty()) frames = bench.bus.turn();
  const hal::CanFrame last = frames.back();
  frames.pop_back();
  const Frames early = with_bus_interrupts(bench, frames);
  EXPECT_EQ(std::count_if(early.begin(), early.end(), is_offset), 0);
  const Frames then = with_bus_interrupts(bench, {last});
  EXPECT_EQ(std::count_if(then.begin(), then.end(), is_offset), 3);
  bench.port.out.clear();
  bench.clock.us += TaskBench::kTurn_us;
  bench.task->on_timer_interrupt();
  EXPECT_EQ(std::count_if(bench.port.out.begin(), bench.port.out.end(), is_offset), 0)
      << "the cycle has been served";
}

// 2200h:03 = 0: 60 % of the period of 2 ms.
TEST(NodeTask, AnIncompleteCycleIsComputedWhenItIsDue) {
  TaskBench bench;
  bench.bring_up();
  EXPECT_EQ(bench.task->deadline_us(), UINT64_MAX);
  Frames frames = bench.bus.turn();
  if (frames.empty()) frames = bench.bus.turn();
  frames.pop_back();
  static_cast<void>(with_bus_interrupts(bench, frames));
  const std::uint64_t due_us = bench.clock.us + 1200;
  EXPECT_EQ(bench.task->deadline_us(), due_us);
  bench.clock.us = due_us - 1;
  const Frames early = with_bus_interrupts(bench, {heartbeat(1, NmtState::operational)});
  EXPECT_EQ(std::count_if(early.begin(), early.end(), is_offset), 0);
  bench.clock.us = due_us;
  bench.task->on_bus_interrupt();
  EXPECT_EQ(std::count_if(bench.port.out.begin(), bench.port.out.end(), is_offset), 3);
  EXPECT_EQ(bench.task->deadline_us(), UINT64_MAX);
}

// What each drive has at the next SYNC.
std::map<std::uint16_t, hal::CanFrame> last_offsets(const Frames& frames) {
  std::map<std::uint16_t, hal::CanFrame> last;
  for (const hal::CanFrame& f : frames) {
    if (is_offset(f)) last[f.id] = f;
  }
  return last;
}

// The drives have the same offsets at each SYNC, at whatever moments the node is called: two tasks,
// one of them with an interrupt for each frame, on one random bus.
TEST(NodeTask, AnInterruptForEachFrameChangesNoOffset) {
  test::Random random(815);
  SCOPED_TRACE(random.trace());
  TaskBench timed;
  TaskBench prompt;
  timed.bring_up();
  prompt.bring_up();
  ASSERT_EQ(timed.clock.us, prompt.clock.us);
  int offsets = 0;
  for (int turn = 0; turn < 5'000; ++turn) {
    BenchBus& bus = timed.bus;
    const int event = static_cast<int>(random.integer(0, 399));
    if (event == 0) bus.drive[0].silent = !bus.drive[0].silent;
    if (event == 1) bus.drive[2].status ^= 0x0100U;
    if (event % 8 == 0) bus.put(heartbeat(127, NmtState::operational));
    bus.drive[1].target += static_cast<std::int32_t>(random.integer(-30'000, 30'000));
    const Frames frames = bus.turn();
    timed.clock.us += TaskBench::kTurn_us;
    prompt.clock.us = timed.clock.us;
    timed.port.in.insert(timed.port.in.end(), frames.begin(), frames.end());
    timed.port.out.clear();
    timed.task->on_timer_interrupt();
    static_cast<void>(with_bus_interrupts(prompt, frames));
    prompt.task->on_timer_interrupt();
    const auto said = last_offsets(prompt.port.out);
    for (TaskBench* bench : {&timed, &prompt}) {
      while (bench->task->background_step()) {
      }
    }
    ASSERT_EQ(said, last_offsets(timed.port.out)) << "turn " << turn;
    for (const auto& [id, f] : said)
      bus.hear(f);
    offsets += static_cast<int>(said.size());
  }
  EXPECT_GT(offsets, 1'000);
}

// --- which context serves what

// A processor that is short of time would else serve one frame for every slice of the scrub, and
// lose what comes meanwhile.
TEST(NodeTask, TheScrubWaitsUntilWhatCameIsServed) {
  TaskBench bench;
  bench.turns(5);
  constexpr int kSections = kWatchesStrokes ? 4 : 3;  // of a background step without a slice
  int left = 0;
  bench.section.on_leave = [&] { ++left; };
  const auto scrubs = [&] {
    left = 0;
    bench.task->background_step();
    return left > kSections;
  };
  for (int i = 0; i < 3; ++i)
    bench.bus.put(sdo_read(0x1018, 1));
  bench.interrupt();
  for (int i = 0; i < 3; ++i)
    EXPECT_FALSE(scrubs()) << "frame " << i;
  EXPECT_FALSE(scrubs()) << "no interrupt has served since";
  bench.interrupt();
  EXPECT_TRUE(scrubs());
  bench.section.on_leave = nullptr;
}

TEST(NodeTask, SdoIsServedByTheBackground) {
  TaskBench bench;
  bench.turn();
  bench.background_hangs = true;
  bench.bus.put(sdo_read(0x1000, 0));
  bench.turns(3);
  EXPECT_TRUE(sdo_of(bench.sent).empty());
  bench.background_hangs = false;
  bench.turn();
  bench.turn();
  EXPECT_EQ(sdo_of(bench.sent).size(), 1U);
}

TEST(NodeTask, WhatComesAfterARequestWaitsBehindIt) {
  TaskBench bench;
  bench.turn();
  bench.bus.put(sdo_write_u32(0x2200, 1, 77));
  bench.bus.nmt(NmtCommand::start);
  bench.interrupt();
  EXPECT_EQ(nmt_state(bench), NmtState::pre_operational);
  EXPECT_TRUE(bench.task->background_step());
  EXPECT_EQ(bench.task->node().objects().ramp_cycles, 77U);
  EXPECT_EQ(nmt_state(bench), NmtState::pre_operational);
  EXPECT_FALSE(bench.task->background_step());
  EXPECT_EQ(nmt_state(bench), NmtState::operational);
}

TEST(NodeTask, NmtIsObeyedInTheSameTurnWhenNothingWaits) {
  TaskBench bench;
  bench.turn();
  bench.bus.nmt(NmtCommand::start);
  bench.interrupt();
  EXPECT_EQ(nmt_state(bench), NmtState::operational);
}

TEST(NodeTask, ResetsWaitForTheBackground) {
  TaskBench bench;
  bench.turn();
  bench.bus.nmt(NmtCommand::start);
  bench.turn();
  bench.bus.nmt(NmtCommand::reset_node);
  bench.interrupt();
  EXPECT_EQ(nmt_state(bench), NmtState::operational);
  bench.task->background_step();
  EXPECT_EQ(nmt_state(bench), NmtState::pre_operational);
  bench.interrupt();
  const hal::CanFrame boot_up{canopen::kHeartbeat + TaskBench::kId, 1, {}};
  EXPECT_EQ(std::count(bench.sent.begin(), bench.sent.end(), boot_up), 1);
}

// Saving is long work: meanwhile the interrupt comes, and what it fetches is sorted.
class BusyStorage final : public Storage {
 public:
  std::function<void()> meanwhile;

  StoreResult save(Span<const std::uint8_t> /*parameters*/,
                   Span<const std::uint8_t> /*image*/) override {
    meanwhile();
    return StoreResult::done;
  }
  StoreResult load(Span<std::uint8_t>& /*parameters*/, Span<std::uint8_t>& /*image*/) override {
    return StoreResult::nothing_stored;
  }
  StoreResult erase() override { return StoreResult::done; }
};

TEST(NodeTask, DuringLongWorkTheCycleGoesOnAndServicesWait) {
  BusyStorage storage;
  TaskBench bench(&storage);
  bench.turn();
  bool heartbeats = false;
  storage.meanwhile = [&] {
    bench.bus.nmt(NmtCommand::start);
    bench.bus.put(sdo_read(0x1000, 0));
    for (int i = 0; i < 250; ++i) {
      bench.interrupt();
      EXPECT_TRUE(sdo_of(bench.sent).empty());
      heartbeats = heartbeats || !bench.sent.empty();
    }
    EXPECT_EQ(nmt_state(bench), NmtState::pre_operational);
  };
  bench.bus.put(sdo_write_u32(0x1010, 1, 0x65766173));
  bench.turn();
  EXPECT_TRUE(heartbeats);
  EXPECT_EQ(nmt_state(bench), NmtState::operational);
  bench.turn();
  EXPECT_EQ(sdo_of(bench.sent).size(), 1U) << "one answer waits at a time, the newest";
}

// The controller's heartbeats wait with the other services: they are not missing.
TEST(NodeTask, LongWorkDoesNotMakeOthersFallSilent) {
  BusyStorage storage;
  TaskBench bench(&storage);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1016, 1, std::uint32_t{127} << 16U | 50U), AbortCode::none);
  bench.bus.put(heartbeat(127, NmtState::operational));
  bench.turn();
  storage.meanwhile = [&] {
    for (int i = 0; i < 500; ++i) {
      if (i % 20 == 0) bench.bus.put(heartbeat(127, NmtState::operational));
      bench.interrupt();
    }
  };
  bench.bus.put(sdo_write_u32(0x1010, 1, 0x65766173));
  bench.turns(20);
  EXPECT_FALSE(bench.emergency(ErrorCode::heartbeat, 127));
  bench.turns(60);
  EXPECT_TRUE(bench.emergency(ErrorCode::heartbeat, 127));
}

TEST(NodeTask, SectionIsNeverEnteredTwice) {
  TaskBench bench;
  bench.bring_up();
  bench.bus.nmt(NmtCommand::reset_node);
  bench.turns(10);
  EXPECT_EQ(bench.section.misuses, 0);
  EXPECT_FALSE(bench.section.inside);
}

// Initialisation (CiA 301, section 7.3.2.2.1): before it has ended a node is not on the bus.
TEST(NodeTask, ANodeThatWasNotStartedNeitherHearsNorSays) {
  Node node(NodeBench::kId, nullptr);
  node.device().receive({canopen::kNmt, 2, {1, NodeBench::kId}}, 1000);
  node.device().receive(sdo_read(0x1000, 0), 1000);
  node.device().poll(2'000'000);
  hal::CanFrame frame;
  EXPECT_FALSE(node.device().offer(frame, 2'000'000));
  EXPECT_EQ(node.device().state(), NmtState::boot_up);
}

// --- lost frames

TEST(NodeTask, FramesThatFindNoRoomAreReported) {
  TaskBench bench;
  bench.turns(20);
  bench.background_hangs = true;
  for (int i = 0; i < 256; ++i)
    bench.bus.put(sdo_read(0x1000, 0));
  bench.turns(2);
  EXPECT_FALSE(bench.emergency(ErrorCode::can_overrun, 0));
  bench.bus.put(sdo_read(0x1000, 0));
  bench.turns(2);
  EXPECT_TRUE(bench.emergency(ErrorCode::can_overrun, 0));
  EXPECT_EQ(bench.emergencies.size(), 1U);
  bench.background_hangs = false;
  bench.turns(20);
  ASSERT_EQ(bench.emergencies.size(), 2U);
  EXPECT_EQ(bench.emergencies.back().code, 0);
  EXPECT_EQ(bench.emergencies.back().error_register, 0);
}

TEST(NodeTask, FramesThePortHasLostAreReported) {
  TaskBench bench;
  bench.turns(2);
  bench.task->frames_lost(3);
  bench.turns(20);
  ASSERT_EQ(bench.emergencies.size(), 2U);
  EXPECT_EQ(bench.emergencies[0].code, 0x8110);
  EXPECT_EQ(bench.emergencies[1].code, 0);
  EXPECT_EQ(bench.task->node().objects().frames_lost, 3U);
}

// --- sending

TEST(NodeTask, AFullPortTakesTheMostUrgentFirst) {
  TaskBench bench;
  bench.bring_up();
  bench.bus.put(sdo_read(0x1000, 0));
  while (sdo_of(bench.sent).empty()) {
    bench.port.room = 3;
    bench.turn();
    for (std::size_t i = 1; i < bench.sent.size(); ++i) {
      const bool offset_after_sdo = is_sdo(bench.sent[i - 1]) && bench.sent[i].id < 0x310;
      EXPECT_FALSE(offset_after_sdo);
    }
    ASSERT_LE(bench.sent.size(), 3U);
    ASSERT_LT(bench.clock.us, 2'000'000U);
  }
}

// A whole block is sent without waiting for the client, but not in one interrupt.
TEST(NodeTask, ALongAnswerIsSpreadOverInterrupts) {
  TaskBench bench;
  bench.bring_up();
  hal::CanFrame open = sdo_read(0x2110, 1);
  open.data[0] = 0xA4;  // initiate block upload with CRC
  open.data[4] = 127;
  bench.bus.put(open);
  bench.turns(2);
  ASSERT_EQ(sdo_of(bench.sent).size(), 1U);
  bench.bus.put({open.id, 8, {0xA3}});  // start
  bench.turn();
  std::size_t segments = 0;
  for (int i = 0; i < 20; ++i) {
    bench.turn();
    EXPECT_LE(bench.sent.size(), 32U);
    segments += sdo_of(bench.sent).size();
    if (i % 2 == 1) {
      EXPECT_GE(others_of(bench.sent).size(), 3U) << "offsets go first";
    }
  }
  EXPECT_EQ(segments, 127U);
}

// --- ports that exchange turns

struct TurnPort {
  std::string log;
  BenchPort port;

  void begin_turn() { log += '('; }
  void end_turn() { log += ')'; }
  bool receive(hal::CanFrame& frame) {
    log += 'r';
    return port.receive(frame);
  }
  bool send(const hal::CanFrame& frame) {
    log += 's';
    return port.send(frame);
  }
};

TEST(NodeTask, APortIsToldWhereATurnBeginsAndEnds) {
  TurnPort port;
  BenchClock clock;
  BenchSection section;
  BenchWatchdog watchdog{clock};
  auto task = std::make_unique<NodeTask<TurnPort, BenchClock, BenchSection, BenchWatchdog>>(
      Board{port, clock, section, watchdog}, NodeBench::kId, nullptr);
  task->power_on(ResetCause::power_on);
  port.port.in.push_back(sdo_read(0x1000, 0));
  task->on_timer_interrupt();
  EXPECT_EQ(port.log, "(rrs)");  // boot-up
}

}  // namespace
}  // namespace volcomp::node
