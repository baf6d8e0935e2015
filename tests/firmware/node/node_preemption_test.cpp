// The interrupt comes after every single machine instruction of the background at which it can
// come, while tables are downloaded, checked, folded and activated, while they are scrubbed, and
// while the node is reset. What the node sends is then compared, turn by turn and bit by bit, with
// a node in one context that received the same.
//
// In long work it is the first instructions of every scope in which the interrupt is let in, and
// the way out of it; with VOLCOMP_TEST_ALL_STEPS=1 in the environment it is all of them, which
// takes minutes. (What folding and scrubbing do to the tick is stepped through to the end in
// hand_over_test.cpp.) Firmware uses no heap, so whatever instruction was interrupted, the handler
// may.

#include <algorithm>

#include "tests/firmware/node/preempted_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::NmtCommand;

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
  expect_same_in_one_context(preempted.turns);
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
  expect_same_in_one_context(preempted.turns);
}

// The compensator begins to tick, with the tables it has, in the middle of the command that gives
// it others. Returns what became of the command.
AbortCode activate_while_it_starts(PreemptedBench& preempted, const MachineTables& others) {
  TaskBench& bench = preempted.bench;
  bench.bring_up(bench_tables(0));
  EXPECT_EQ(bench.write({0x2110, 1}, image_of(others)), AbortCode::none);
  bench.bus.nmt(NmtCommand::enter_pre_operational);
  bench.turns(10);
  bench.bus.nmt(NmtCommand::start);
  bench.turns(2);
  EXPECT_EQ(bench.state(), NodeState::waiting);
  bench.bus.with_sync = false;
  preempted.on_long_work = [&] { bench.bus.with_sync = true; };
  preempted.preempt(true);
  const AbortCode answer = bench.command(TableCommand::activate);
  preempted.preempt(false);
  bench.turns(200);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.bus.largest_step, 20'000);
  expect_same_in_one_context(preempted.turns);
  return answer;
}

TEST(NodePreemption, TablesChangeWhileTheCompensatorStarts) {
  PreemptedBench preempted;
  EXPECT_EQ(activate_while_it_starts(preempted, bench_tables(1)), AbortCode::none);
}

// Tables of another machine would be taken while nothing is corrected; in the middle of the command
// that is over.
TEST(NodePreemption, TheMachineChangesOnlyUntilTheCompensatorStarts) {
  PreemptedBench preempted;
  MachineTables other = bench_tables(1);
  other.machine.body[3].joint.offset[0] += 10.0;
  EXPECT_EQ(activate_while_it_starts(preempted, other), AbortCode::general);
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
  expect_same_in_one_context(preempted.turns);
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
  expect_same_in_one_context(preempted.turns);
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
    return StoreResult::loaded_older;  // reported by an emergency as soon as the node may send
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
  expect_same_in_one_context(preempted.turns, &another);
}

}  // namespace
}  // namespace volcomp::node
