// Lost, late, unreferenced and impossible positions: hold, drop softly, come back softly, and the
// other axes go on.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr std::int32_t kRate = 5'000;
constexpr std::int32_t kSoft = 200;
constexpr std::uint16_t kDropTicks = 10;

// X: 20 µm per 100 mm rising along X; Y: constant 30 µm; Z nothing.
MachineTables slope_tables() {
  MachineTables t;
  t.machine = kXyfzMachine;
  for (std::size_t a = 0; a < 3; ++a) {
    t.axis[a].q0 = 0;
    t.axis[a].pitch = 100'000'000;
    t.axis[a].knots = 5;
  }
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t travel = 0; travel < 2; ++travel) {
      t.axis[0].value[travel][i][0] = 20'000.0F * static_cast<float>(i);
      t.axis[1].value[travel][i][1] = 30'000.0F;
    }
  }
  return t;
}

class Stale : public ::testing::Test {
 protected:
  void SetUp() override {
    settings = open_settings<5>();
    settings.stale_drop_ticks = kDropTicks;
    for (AxisLimits& l : settings.axis) {
      l.rate = kRate;
      l.soft_rate = kSoft;
    }
    ASSERT_TRUE(runner.start(slope_tables(), settings).ok());
    for (int n = 0; n < 50; ++n)
      runner.tick({200'000'000, 0, 0, 0, 0});
    ASSERT_EQ(x(), 40'000);
    ASSERT_EQ(y(), 30'000);
    ASSERT_EQ(status(), kValid | kDirectionUnknown);
  }
  [[nodiscard]] std::int32_t x() const { return runner.out.offset[0]; }
  [[nodiscard]] std::int32_t y() const { return runner.out.offset[1]; }
  [[nodiscard]] unsigned status(std::size_t a = 0) const { return runner.out.status[a]; }

  CompensatorSettings<5> settings{};
  LoadedRunner runner{kXyfzMachine};
};

TEST_F(Stale, HoldsThenDropsSoftlyThenComesBackSoftly) {
  runner.in.axis[0].valid = false;
  for (int n = 1; n <= kDropTicks; ++n) {
    runner.tick({900'000'000, 0, 0, 0, 0});  // whatever its value, it is not valid
    ASSERT_EQ(x(), 40'000) << "stale tick " << n;
    ASSERT_EQ(status() & (kStale | kDropped | kValid), kStale);
    ASSERT_EQ(y(), 30'000) << "other axes go on";
    ASSERT_NE(status(1) & kValid, 0);
  }
  for (int n = 1; n <= 40'000 / kSoft; ++n) {
    runner.tick();
    ASSERT_NE(status() & kDropped, 0);
    ASSERT_EQ(x(), 40'000 - kSoft * n);
  }
  runner.tick();
  EXPECT_EQ(x(), 0);
  EXPECT_EQ(y(), 30'000);
  runner.in.axis[0].valid = true;
  for (int n = 1; n <= 40'000 / kSoft; ++n) {
    runner.tick({200'000'000, 0, 0, 0, 0});
    ASSERT_EQ(x(), kSoft * n) << "back at the soft rate";
    ASSERT_EQ(status() & (kStale | kDropped), 0U);
  }
  // full rate again once there
  runner.tick({200'000'000, 0, 0, 0, 0});
  runner.tick({400'000'000, 0, 0, 0, 0});
  EXPECT_EQ(x(), 40'000 + kRate);
}

TEST_F(Stale, AShortGapIsBridgedWithoutADrop) {
  runner.in.axis[0].valid = false;
  for (int n = 0; n < kDropTicks; ++n)
    runner.tick();
  runner.in.axis[0].valid = true;
  runner.tick({201'000'000, 0, 0, 0, 0});
  EXPECT_EQ(x(), 40'200);
  EXPECT_EQ(runner.compensator->diagnostics().began[0][3], 0) << "kDropped never began";
}

// The gap counter starts anew with every gap.
TEST_F(Stale, ManyShortGapsAreNotOneLongOne) {
  for (int n = 0; n < 200; ++n) {
    runner.in.axis[0].valid = n % 6 == 0;
    runner.tick();
    ASSERT_EQ(status() & kDropped, 0U);
    ASSERT_EQ(x(), 40'000);
  }
}

TEST_F(Stale, StaleForHoursStaysDropped) {
  runner.in.axis[0].valid = false;
  for (int n = 0; n < 70'000; ++n)  // beyond 16 bits
    runner.tick();
  EXPECT_NE(status() & kDropped, 0);
  EXPECT_EQ(x(), 0);
}

TEST_F(Stale, NotHomedGoesSoftlyToZeroAndReturnsSoftly) {
  runner.in.axis[0].homed = false;
  for (int n = 1; n <= 40'000 / kSoft; ++n) {
    runner.tick();
    ASSERT_EQ(x(), 40'000 - kSoft * n);
    ASSERT_EQ(status() & (kNotHomed | kValid), kNotHomed);
    ASSERT_EQ(y(), 30'000);
  }
  runner.in.axis[0].homed = true;
  for (int n = 1; n <= 40'000 / kSoft; ++n) {
    runner.tick();
    ASSERT_EQ(x(), kSoft * n);
  }
}

// A jump is not believed, in either direction; a position confirmed by the next tick is.
TEST_F(Stale, ImplausibleJumpIsHeld) {
  settings.axis[0].max_step = 1'000'000;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  for (const std::int64_t sign : {1, -1}) {
    constexpr std::int64_t kAt = 200'000'000;
    runner.tick({kAt, 0, 0, 0, 0});
    runner.tick({kAt + sign * 1'000'000, 0, 0, 0, 0});  // exactly the largest step
    EXPECT_EQ(x(), 40'000 + sign * 200);
    EXPECT_EQ(status() & kImplausible, 0U);
    runner.tick({kAt, 0, 0, 0, 0});
    EXPECT_EQ(x(), 40'000);
    runner.tick({kAt + sign * 1'000'001, 0, 0, 0, 0});  // one more is too much
    EXPECT_EQ(x(), 40'000) << "held";
    EXPECT_EQ(status() & (kImplausible | kStale | kValid), kImplausible | kStale);
    EXPECT_EQ(status(1) & (kImplausible | kStale), 0U);
    runner.tick({kAt, 0, 0, 0, 0});  // back is a jump as well
    EXPECT_EQ(x(), 40'000);
    EXPECT_NE(status() & kImplausible, 0U);
    runner.tick({kAt, 0, 0, 0, 0});
    EXPECT_EQ(status() & kImplausible, 0U);
  }
}

TEST_F(Stale, NoOffsetBeforeTheFirstPosition) {
  LoadedRunner fresh(kXyfzMachine);
  ASSERT_TRUE(fresh.start(slope_tables(), settings).ok());
  fresh.in.axis[0].valid = false;
  for (int n = 0; n < 100; ++n) {
    fresh.tick({200'000'000, 0, 0, 0, 0});
    ASSERT_EQ(fresh.out.offset, (std::array<std::int32_t, 5>{}));
    ASSERT_EQ(fresh.out.status[0] & kValid, 0);
    ASSERT_NE(fresh.out.status[1] & kStale, 0) << "the others wait for it";
  }
}

}  // namespace
}  // namespace volcomp::test
