// Direction of travel: which of the two tables is in force, and that noise never changes it.

#include "comp/tables/direction.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr std::int32_t kHysteresis = 2'000;

std::uint32_t low(std::int64_t q) { return static_cast<std::uint32_t>(q); }

TEST(Direction, UnknownUntilHalfTheHysteresisHasPassed) {
  for (const int sign : {1, -1}) {
    DirectionTracker tracker;
    EXPECT_EQ(tracker.update(low(0), kHysteresis), Direction::unknown);
    EXPECT_EQ(tracker.update(low(sign * kHysteresis / 2), kHysteresis), Direction::unknown);
    EXPECT_EQ(tracker.update(low(sign * (kHysteresis / 2 + 1)), kHysteresis),
              sign > 0 ? Direction::forward : Direction::backward);
  }
}

TEST(Direction, FlipsOnlyAfterTheWholeHysteresis) {
  for (const int sign : {1, -1}) {
    const Direction along = sign > 0 ? Direction::forward : Direction::backward;
    const Direction against = sign > 0 ? Direction::backward : Direction::forward;
    DirectionTracker tracker;
    tracker.update(low(0), kHysteresis);
    EXPECT_EQ(tracker.update(low(sign * 50'000), kHysteresis), along);
    EXPECT_EQ(tracker.update(low(sign * (50'000 - kHysteresis)), kHysteresis), along);
    EXPECT_EQ(tracker.update(low(sign * 50'000), kHysteresis), along);
    EXPECT_EQ(tracker.update(low(sign * (50'000 - kHysteresis - 1)), kHysteresis), against);
    EXPECT_EQ(tracker.update(low(sign * (50'000 - 1)), kHysteresis), against);
    EXPECT_EQ(tracker.update(low(sign * 50'000), kHysteresis), along);
  }
}

// Noise of ± half the hysteresis on any true motion: never a wrong direction.
TEST(Direction, NoiseNeverFlips) {
  Random random(40);
  SCOPED_TRACE(random.trace());
  for (const int sign : {1, -1}) {
    DirectionTracker tracker;
    std::int64_t truth = 2'147'480'000;  // crosses the wrap of 32 bits on its way
    tracker.update(low(truth), kHysteresis);
    truth += sign * 10 * kHysteresis;
    const Direction along = tracker.update(low(truth), kHysteresis);
    ASSERT_EQ(along, sign > 0 ? Direction::forward : Direction::backward);
    for (int n = 0; n < 200'000; ++n) {
      if (random.chance(0.3)) truth += sign * random.integer(0, 5'000);
      const std::int64_t seen = truth + random.integer(-kHysteresis / 2, kHysteresis / 2);
      ASSERT_EQ(tracker.update(low(seen), kHysteresis), along) << "sample " << n;
    }
  }
}

// Forward 1000, backward 3000, mean 2000 nm on X.
class TwoTables : public ::testing::Test {
 protected:
  void SetUp() override {
    tables.machine = kXyfzMachine;
    for (std::size_t a = 0; a < 3; ++a) {
      tables.axis[a].q0 = -400'000'000;
      tables.axis[a].pitch = 100'000'000;
      tables.axis[a].knots = 5;
    }
    for (std::size_t i = 0; i < 5; ++i) {
      tables.axis[0].value[0][i][0] = 1000.0F;
      tables.axis[0].value[1][i][0] = 3000.0F;
    }
  }
  std::int32_t at(std::int64_t x) { return runner.tick({x, 0, 0, 0, 0}).offset[0]; }

  MachineTables tables;
  LoadedRunner runner{kXyfzMachine};
};

TEST_F(TwoTables, UnknownIsTheMeanThenEachDirectionItsOwn) {
  auto settings = open_settings<5>();
  settings.axis[0].hysteresis = kHysteresis;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  EXPECT_EQ(at(-1'000'000), 2000);
  EXPECT_NE(runner.out.status[0] & kDirectionUnknown, 0);
  EXPECT_NE(runner.out.status[0] & kValid, 0) << "an unknown direction is not an alarm";
  EXPECT_EQ(at(-1'000'000 + kHysteresis), 1000);
  EXPECT_EQ(runner.out.status[0] & kDirectionUnknown, 0);
  EXPECT_EQ(at(-1'000'000 + 1), 1000) << "within the hysteresis";
  EXPECT_EQ(at(-1'000'000 - 1), 3000);
}

TEST_F(TwoTables, AFlipGoesThroughTheSlewLimiter) {
  auto settings = open_settings<5>();
  settings.axis[0].hysteresis = kHysteresis;
  settings.axis[0].rate = 300;
  settings.axis[0].soft_rate = 100;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  std::int64_t x = -1'000'000;
  for (int n = 0; n < 20; ++n)
    at(x += 3'000);
  ASSERT_EQ(at(x), 1000);
  EXPECT_EQ(at(x - 10'000), 1300);
  EXPECT_NE(runner.out.status[0] & kRateLimited, 0);
  EXPECT_EQ(at(x - 10'000), 1600);
  for (int n = 0; n < 5; ++n)
    at(x - 10'000);
  EXPECT_EQ(runner.out.offset[0], 3000);
  EXPECT_EQ(runner.out.status[0] & kRateLimited, 0);
}

// While nothing is active the axis still moves: the direction taken up afterwards must be the last
// one, or unknown, never the opposite one.
TEST_F(TwoTables, MotionWhileInactiveIsNotMistakenForTheLastDirection) {
  auto settings = open_settings<5>();
  settings.axis[0].hysteresis = kHysteresis;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  at(-50'000'000);
  at(-49'000'000);
  runner.compensator->deactivate();
  at(-49'000'000);
  at(-10'000'000);  // far forward …
  at(-20'000'000);  // … then back
  ASSERT_TRUE(runner.swap(tables).ok());
  EXPECT_NE(at(-20'000'000), 1000) << "last motion was backward";
}

}  // namespace
}  // namespace volcomp::test
