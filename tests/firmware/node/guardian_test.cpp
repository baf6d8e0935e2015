// The guardian: which context hangs, what happens to the corrections, and when the watchdog bites.

#include "comp/core/bytes.hpp"
#include "tests/firmware/node/task_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using State = Guardian::State;

// --- by itself: times in µs, limits 100, 1000 and 500

constexpr GuardianSettings kShort{100, 1000, 500};

TEST(Guardian, TrustsABackgroundThatComesInTime) {
  Guardian guardian(kShort);
  for (std::uint64_t now = 1'000'000; now < 1'010'000; now += 100) {
    guardian.alive();
    ASSERT_EQ(guardian.check(now, true), State::trusting);
  }
}

TEST(Guardian, WaitsExactlyAsLongAsItWasTold) {
  Guardian guardian(kShort);
  guardian.alive();
  guardian.check(50, true);
  EXPECT_EQ(guardian.check(150, true), State::trusting);
  EXPECT_EQ(guardian.check(151, true), State::ramping);
}

// The clock of a board may begin anywhere, and the background may not have had its first turn yet.
TEST(Guardian, CountsFromTheFirstTick) {
  Guardian guardian(kShort);
  EXPECT_EQ(guardian.check(1ULL << 40U, true), State::trusting);
  EXPECT_EQ(guardian.check((1ULL << 40U) + 101, true), State::ramping);
}

TEST(Guardian, StarvesAsSoonAsTheCorrectionsAreAtRest) {
  Guardian guardian(kShort);
  guardian.check(0, false);
  ASSERT_EQ(guardian.check(101, false), State::ramping);
  EXPECT_EQ(guardian.check(300, false), State::ramping);
  EXPECT_EQ(guardian.check(301, true), State::starving);
}

TEST(Guardian, DoesNotWaitForEverForThemToComeToRest) {
  Guardian guardian(kShort);
  guardian.check(0, false);
  ASSERT_EQ(guardian.check(101, false), State::ramping);
  EXPECT_EQ(guardian.check(601, false), State::ramping);
  EXPECT_EQ(guardian.check(602, false), State::starving);
}

TEST(Guardian, ABackgroundThatComesBackInTimeIsTrustedAgain) {
  Guardian guardian(kShort);
  guardian.check(0, false);
  ASSERT_EQ(guardian.check(101, false), State::ramping);
  guardian.alive();
  EXPECT_EQ(guardian.check(200, false), State::trusting);
  EXPECT_EQ(guardian.check(300, false), State::trusting);
  EXPECT_EQ(guardian.check(301, false), State::ramping);
}

TEST(Guardian, StarvingIsFinal) {
  Guardian guardian(kShort);
  guardian.check(0, true);
  guardian.check(101, true);
  ASSERT_EQ(guardian.check(102, true), State::starving);
  guardian.alive();
  EXPECT_EQ(guardian.check(103, true), State::starving);
}

TEST(Guardian, AnnouncedLongWorkMayTakeLonger) {
  Guardian guardian(kShort);
  guardian.announce_long_work(true);
  guardian.check(0, true);
  EXPECT_EQ(guardian.check(1000, true), State::trusting);
  EXPECT_EQ(guardian.check(1001, true), State::ramping);
  guardian.announce_long_work(false);
  EXPECT_EQ(guardian.check(1002, true), State::trusting);
  EXPECT_EQ(guardian.check(1103, true), State::ramping);
}

// --- in a node that corrects

constexpr int kStaleTurns = 100;  // of a millisecond, as GuardianSettings has it

TEST(NodeGuardian, AFedWatchdogDoesNotBite) {
  TaskBench bench;
  bench.bring_up();
  for (int i = 0; i < 1000; ++i) {
    bench.turn();
    ASSERT_FALSE(bench.watchdog.bites());
  }
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

TEST(NodeGuardian, ADeadTickBites) {
  TaskBench bench;
  bench.bring_up();
  bench.clock.us += bench.watchdog.time_us - 1;
  EXPECT_FALSE(bench.watchdog.bites());
  bench.clock.us += 1;
  EXPECT_TRUE(bench.watchdog.bites());
}

TEST(NodeGuardian, AHangingBackgroundEndsWithCorrectionsAtZeroAndABite) {
  TaskBench bench;
  bench.bring_up();
  ASSERT_FALSE(bench.offsets_are_zero());
  bench.background_hangs = true;
  bench.turns(kStaleTurns);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  bench.bus.largest_step = 0;
  bench.turns(2);
  EXPECT_EQ(bench.state(), NodeState::overdue);
  EXPECT_TRUE(bench.emergency(ErrorCode::background_overdue, 0));
  // The ramp of 20 cycles: quintic, its steepest step is 1.875 of the mean one; fed all the while.
  while (!bench.offsets_are_zero()) {
    bench.turn();
    ASSERT_FALSE(bench.watchdog.bites());
    ASSERT_LT(bench.clock.us, 10'000'000U);
  }
  EXPECT_LE(bench.bus.largest_step, 20'000);
  bench.turns(30);
  EXPECT_TRUE(bench.watchdog.bites());
}

TEST(NodeGuardian, TheSlewLimitHoldsOnTheWayToZero) {
  TaskBench bench;
  bench.configure();
  for (std::uint8_t a = 1; a <= 3; ++a) {
    ASSERT_EQ(bench.set<std::int32_t>(0x2202, a, 700), AbortCode::none);
    ASSERT_EQ(bench.set<std::int32_t>(0x2203, a, 100), AbortCode::none);
  }
  bench.bring_up();
  bench.turns(200);
  bench.bus.largest_step = 0;
  bench.background_hangs = true;
  for (int i = 0; i < 2000 && !bench.watchdog.bites(); ++i)
    bench.turn();
  EXPECT_TRUE(bench.watchdog.bites());
  EXPECT_TRUE(bench.offsets_are_zero());
  EXPECT_GT(bench.bus.largest_step, 0);
  EXPECT_LE(bench.bus.largest_step, 700);
}

TEST(NodeGuardian, WithoutSyncNothingCanBeRampedAndTheWatchdogBitesAllTheSame) {
  TaskBench bench(nullptr, {100'000, 5'000'000, 300'000});
  bench.bring_up();
  bench.background_hangs = true;
  bench.bus.with_sync = false;
  bench.turns(kStaleTurns + 300);
  EXPECT_FALSE(bench.watchdog.bites());
  bench.turns(25);
  EXPECT_TRUE(bench.watchdog.bites());
}

TEST(NodeGuardian, WithoutCorrectionsThereIsNothingToWaitFor) {
  TaskBench bench;
  bench.configure();
  bench.background_hangs = true;
  bench.turns(kStaleTurns);
  EXPECT_FALSE(bench.watchdog.bites());
  bench.turns(25);
  EXPECT_TRUE(bench.watchdog.bites());
}

TEST(NodeGuardian, ABackgroundBackDuringTheRampLeavesTheCorrectionsAtZero) {
  TaskBench bench;
  bench.bring_up();
  const auto before = bench.bus.drive[0].held;
  bench.background_hangs = true;
  bench.turns(kStaleTurns + 10);
  ASSERT_EQ(bench.state(), NodeState::overdue);
  ASSERT_NE(bench.bus.drive[0].held, 0);
  bench.emergencies.clear();
  bench.background_hangs = false;
  bench.turns(500);
  EXPECT_FALSE(bench.watchdog.bites());
  EXPECT_EQ(bench.state(), NodeState::no_tables);
  EXPECT_TRUE(bench.offsets_are_zero());
  // The error has gone: code 0000h, error register 0.
  ASSERT_FALSE(bench.emergencies.empty());
  EXPECT_EQ(bench.emergencies.back().code, 0);
  EXPECT_EQ(bench.emergencies.back().error_register, 0);
  // Until tables are activated again.
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  bench.turns(100);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_NEAR(bench.bus.drive[0].held, before, 1);
  EXPECT_LE(bench.bus.largest_step, 20'000);
}

TEST(NodeGuardian, ABackgroundBackTooLateDoesNotStopTheBite) {
  TaskBench bench;
  bench.bring_up();
  bench.background_hangs = true;
  while (bench.task->guardian().state() != State::starving)
    bench.turn();
  bench.background_hangs = false;
  bench.turns(25);
  EXPECT_TRUE(bench.watchdog.bites());
}

// --- long work

// Saving takes `turns` turns, in which the interrupt goes on as it does beside a flash.
class SlowStorage final : public Storage {
 public:
  int turns = 0;
  TaskBench* bench = nullptr;

  StoreResult save(Span<const std::uint8_t> /*parameters*/,
                   Span<const std::uint8_t> /*image*/) override {
    EXPECT_FALSE(bench->section.inside);
    for (int i = 0; i < turns; ++i)
      bench->interrupt();
    return StoreResult::done;
  }
  StoreResult load(Span<std::uint8_t>& /*parameters*/, Span<std::uint8_t>& /*image*/) override {
    return StoreResult::nothing_stored;
  }
  StoreResult erase() override { return StoreResult::done; }
};

TEST(NodeGuardian, SavingMayTakeLongerThanABackgroundMayBeSilent) {
  SlowStorage storage;
  TaskBench bench(&storage);
  storage.bench = &bench;
  storage.turns = 20 * kStaleTurns;
  bench.configure();
  EXPECT_EQ(bench.set(0x1010, 1, kSave), AbortCode::none);
  EXPECT_FALSE(bench.watchdog.bites());
  EXPECT_EQ(bench.task->guardian().state(), State::trusting);
}

TEST(NodeGuardian, SavingForEverEndsWithABite) {
  SlowStorage storage;
  TaskBench bench(&storage, {100'000, 400'000, 300'000});
  storage.bench = &bench;
  storage.turns = 400 + 30;
  bench.configure();
  static_cast<void>(bench.set(0x1010, 1, kSave));
  EXPECT_TRUE(bench.watchdog.bites());
}

// --- after the bite

TEST(NodeGuardian, ANodeSaysWhyItWasRestarted) {
  for (const ResetCause cause : {ResetCause::watchdog, ResetCause::fault}) {
    TaskBench bench(nullptr, {}, cause);
    bench.turns(30);
    EXPECT_TRUE(bench.emergency(ErrorCode::unexpected_reset, static_cast<std::uint8_t>(cause)));
    EXPECT_EQ(bench.task->node().objects().reset_cause, static_cast<std::uint8_t>(cause));
  }
  for (const ResetCause cause : {ResetCause::power_on, ResetCause::request}) {
    TaskBench bench(nullptr, {}, cause);
    bench.turns(30);
    EXPECT_TRUE(bench.emergencies.empty());
  }
}

}  // namespace
}  // namespace volcomp::node
