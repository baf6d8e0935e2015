// The interrupt comes after every single machine instruction of the background at which it can
// come, while tables are downloaded, checked, folded and activated, while they are scrubbed, and
// while the node is reset. What the node says is then compared, turn by turn and bit by bit, with a
// node in one context that was told the same.
//
// Of long work it is the first instructions of every scope in which the interrupt is let in, and
// the way out of it; with VOLCOMP_TEST_ALL_STEPS=1 in the environment it is all of them, which
// takes minutes. (What folding and scrubbing do to the tick is stepped through to the end in
// hand_over_test.cpp.) Firmware uses no heap, so whatever instruction was interrupted, the handler
// may.

#include <algorithm>
#include <cstdlib>

#include "firmware/canopen/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "tests/unit/node/single_step.hpp"
#include "tests/unit/node/task_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::NmtCommand;
using test::SingleStep;
using Frames = TaskBench::Frames;

constexpr std::uint64_t kFirstSteps = 1500;

std::uint64_t most_steps() {
  return std::getenv("VOLCOMP_TEST_ALL_STEPS") == nullptr ? kFirstSteps : UINT64_MAX;
}

// A frame the background had finished, and when it began with it.
struct Served {
  hal::CanFrame frame;
  std::uint64_t us = 0;
};

struct Turn {
  std::uint64_t us = 0;
  bool resetting = false;      // the node was in the middle of it
  std::vector<Served> served;  // since the turn before
  Frames in;
  Frames out;
};

// A task bench that writes down everything, and whose background can be interrupted anywhere.
class PreemptedBench {
 public:
  explicit PreemptedBench(Storage* storage = nullptr) : bench(storage) {
    bench.on_interrupt = [this](const Frames& in, const Frames& out) { note(in, out); };
    bench.background = [this] {
      while (step()) {
      }
    };
    bench.section.on_leave = [this] { leave(); };
    bench.section.on_enter = [this] { enter(); };
  }

  // From here on the interrupt comes as often as it can.
  void preempt(bool on) {
    preempted_ = on;
    bench.turn_us = on ? 10 : TaskBench::kTurn_us;
  }

  TaskBench bench;
  std::vector<Turn> turns;
  std::uint64_t interruptions = 0;
  std::function<void()> on_long_work;  // when the interrupt is let in

 private:
  void note(const Frames& in, const Frames& out) {
    const bool resetting = bench.task->node().device().state() == canopen::NmtState::boot_up;
    turns.push_back({bench.clock.us, resetting, std::move(served_), in, out});
    served_ = {};
    for (const hal::CanFrame& f : in) {
      if (bench.task->node().work(f) == canopen::Device::Work::lengthy) waiting_.push_back({f});
    }
  }

  void interrupt() {
    ++interruptions;
    bench.interrupt();
  }

  bool step() {
    serving_ = !waiting_.empty();
    if (!preempted_) return bench.task->background_step();
    bool more = false;
    SingleStep::through([&] { more = bench.task->background_step(); },
                        [&](std::uint64_t /*done*/) {
                          if (!bench.section.inside) interrupt();
                          return ++steps_ < most_steps_;
                        });
    return more;
  }

  // The background keeps the interrupt out: before it reads the clock and begins with a frame, or
  // at the end of long work.
  void enter() {
    if (preempted_) SingleStep::pause();
    if (serving_ && !bench.task->guardian().long_work()) waiting_.front().us = bench.clock.us;
  }

  // The background lets the interrupt in: with a frame that is finished, or in the middle of it.
  void leave() {
    if (serving_ && !bench.task->guardian().long_work()) {
      serving_ = false;
      served_.push_back(waiting_.front());
      waiting_.pop_front();
    }
    if (!preempted_) return;
    if (on_long_work && bench.task->guardian().long_work()) on_long_work();
    interrupt();
    steps_ = 0;
    SingleStep::resume();
  }

  bool preempted_ = false;
  bool serving_ = false;
  std::uint64_t most_steps_ = most_steps();
  std::uint64_t steps_ = 0;  // since the interrupt was let in
  std::deque<Served> waiting_;
  std::vector<Served> served_;
};

// --- the node in one context

class SingleNode {
 public:
  explicit SingleNode(Storage* storage = nullptr)
      : node_(std::make_unique<Node>(NodeBench::kId, storage)) {
    node_->power_on(0);
  }

  // What it says in such a turn.
  Frames turn(const Turn& turn) {
    for (const Served& s : turn.served)
      node_->receive(s.frame, s.us);
    for (const hal::CanFrame& f : turn.in) {
      if (node_->work(f) != canopen::Device::Work::lengthy) node_->receive(f, turn.us);
    }
    node_->poll(turn.us);
    Frames out;
    hal::CanFrame frame;
    while (out.size() < 32 && node_->offer(frame, turn.us)) {
      out.push_back(frame);
      node_->taken(turn.us);
    }
    return out;
  }

 private:
  std::unique_ptr<Node> node_;
};

// A node that is being reset is not on the bus: it says nothing, and what it did not hear the other
// one is not told either.
void expect_same(const std::vector<Turn>& turns, SingleNode& single) {
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i].resetting) {
      ASSERT_TRUE(turns[i].served.empty());
      ASSERT_TRUE(turns[i].out.empty()) << "turn " << i;
      continue;
    }
    ASSERT_EQ(turns[i].out, single.turn(turns[i])) << "turn " << i;
  }
}

// --- tables

TEST(NodePreemption, TablesChangeWhileTheMachineIsCorrected) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  const auto before = bench.bus.drive[0].held;
  const Bytes image = image_of(bench_tables(1));

  preempted.preempt(true);
  EXPECT_EQ(bench.write({0x2110, 1}, image), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_GT(preempted.interruptions, 4 * kFirstSteps);  // name, check, chain, fold
  preempted.preempt(false);
  bench.turns(200);

  EXPECT_NE(bench.bus.drive[0].held, before);
  EXPECT_LE(bench.bus.largest_step, 20'000);
  EXPECT_EQ(bench.section.misuses, 0);
  SingleNode single;
  expect_same(preempted.turns, single);
}

TEST(NodePreemption, TablesAreRefusedWhileTheMachineIsCorrected) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  MachineTables damaged = bench_tables(1);
  damaged.axis[1].value[0][2][4] = 1.0F;  // a radian
  EXPECT_EQ(bench.write({0x2110, 1}, image_of(damaged)), AbortCode::none);
  preempted.preempt(true);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  preempted.preempt(false);
  bench.turns(100);

  EXPECT_EQ(bench.state(), NodeState::compensating);
  SingleNode single;
  expect_same(preempted.turns, single);
}

// The compensator begins to tick, with the tables it has, in the middle of the command that gives
// it others.
TEST(NodePreemption, TablesChangeWhileTheCompensatorStarts) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  EXPECT_EQ(bench.write({0x2110, 1}, image_of(bench_tables(1))), AbortCode::none);
  bench.bus.nmt(NmtCommand::enter_pre_operational);
  bench.turns(10);
  bench.bus.nmt(NmtCommand::start);
  bench.turns(2);
  ASSERT_EQ(bench.state(), NodeState::waiting);
  bench.bus.with_sync = false;
  preempted.on_long_work = [&] { bench.bus.with_sync = true; };
  preempted.preempt(true);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  preempted.preempt(false);
  bench.turns(200);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.bus.largest_step, 20'000);
  SingleNode single;
  expect_same(preempted.turns, single);
}

// Tables of another machine would be taken while nothing is corrected; in the middle of the command
// that is over.
TEST(NodePreemption, TheMachineChangesOnlyUntilTheCompensatorStarts) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  MachineTables other = bench_tables(1);
  other.machine.body[3].joint.offset[0] += 10.0;
  EXPECT_EQ(bench.write({0x2110, 1}, image_of(other)), AbortCode::none);
  bench.bus.nmt(NmtCommand::enter_pre_operational);
  bench.turns(10);
  bench.bus.nmt(NmtCommand::start);
  bench.turns(2);
  ASSERT_EQ(bench.state(), NodeState::waiting);
  bench.bus.with_sync = false;
  preempted.on_long_work = [&] { bench.bus.with_sync = true; };
  preempted.preempt(true);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  preempted.preempt(false);
  bench.turns(100);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.bus.largest_step, 20'000);
  SingleNode single;
  expect_same(preempted.turns, single);
}

TEST(NodePreemption, CorrectionsAreTakenBack) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  preempted.preempt(true);
  EXPECT_EQ(bench.command(TableCommand::deactivate), AbortCode::none);
  preempted.preempt(false);
  bench.turns(200);
  EXPECT_TRUE(bench.offsets_are_zero());
  SingleNode single;
  expect_same(preempted.turns, single);
}

// Every ten seconds.
TEST(NodePreemption, TablesAreScrubbedWhileTheMachineIsCorrected) {
  PreemptedBench preempted;
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  while (bench.clock.us < 10'000'000)
    bench.turn();
  preempted.preempt(true);
  bench.turns(200);
  EXPECT_GT(preempted.interruptions, kFirstSteps);
  preempted.preempt(false);
  bench.turns(10);
  SingleNode single;
  expect_same(preempted.turns, single);
}

// --- reset

class FixedStorage final : public Storage {
 public:
  StoreResult save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) override {
    parameters_.keep(parameters);
    image_.keep(image);
    return StoreResult::done;
  }
  StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override {
    if (parameters_.size == 0) return StoreResult::nothing_stored;
    parameters_.give(parameters);
    if (image.data() != nullptr) image_.give(image);
    return StoreResult::loaded_older;  // said by an emergency as soon as the node may speak
  }
  StoreResult erase() override { return StoreResult::done; }

 private:
  struct Part {
    std::array<std::uint8_t, 8192> bytes{};
    std::size_t size = 0;

    void keep(Span<const std::uint8_t> from) {
      size = from.size();
      std::copy(from.begin(), from.end(), bytes.begin());
    }
    void give(Span<std::uint8_t>& to) const {
      std::copy_n(bytes.begin(), size, to.begin());
      to = {to.data(), size};
    }
  };
  Part parameters_;
  Part image_;
};

constexpr std::uint32_t kSave = 0x65766173;

TEST(NodePreemption, ResetInTheMiddleOfCorrections) {
  FixedStorage storage;
  PreemptedBench preempted(&storage);
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  bench.bus.nmt(NmtCommand::enter_pre_operational);
  bench.turns(2);
  preempted.preempt(true);
  EXPECT_EQ(bench.set(0x1010, 1, kSave), AbortCode::none);
  preempted.preempt(false);
  bench.bus.nmt(NmtCommand::start);
  bench.turns(100);
  ASSERT_EQ(bench.state(), NodeState::compensating);

  preempted.preempt(true);
  const std::uint64_t before = preempted.interruptions;
  bench.bus.nmt(NmtCommand::reset_node);
  bench.turns(2);
  EXPECT_GT(preempted.interruptions - before, 2 * kFirstSteps);
  preempted.preempt(false);
  bench.turns(10);
  bench.bus.nmt(NmtCommand::start);
  bench.turns(200);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.bus.largest_step, 20'000);

  FixedStorage another;
  SingleNode single(&another);
  expect_same(preempted.turns, single);
}

}  // namespace
}  // namespace volcomp::node
