// Counters: what each one counts, and that it stops at its end instead of starting anew.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

std::size_t bit(StatusBit status) {
  return static_cast<std::size_t>(__builtin_ctz(static_cast<unsigned>(status)));
}

class Counters : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(runner.start(constant_tables(1'500.0F)).ok()); }
  [[nodiscard]] int began(std::size_t axis, StatusBit status) const {
    return runner.compensator->diagnostics().began[axis][bit(status)];
  }

  LoadedRunner runner{kXyfzMachine};
};

TEST_F(Counters, TicksAndActivations) {
  EXPECT_EQ(runner.compensator->diagnostics().ticks, 0U);
  EXPECT_EQ(runner.compensator->diagnostics().activations, 0U) << "counted when it happens";
  for (int n = 0; n < 7; ++n)
    runner.tick({0, 0, 0, 0, 0});
  EXPECT_EQ(runner.compensator->diagnostics().ticks, 7U);
  EXPECT_EQ(runner.compensator->diagnostics().activations, 1U);
  ASSERT_STREQ(code(runner.swap(constant_tables(-900.0F)).reason), "ok");
  runner.tick();
  EXPECT_EQ(runner.compensator->diagnostics().activations, 2U);
}

TEST_F(Counters, LargestOffsetKeepsItsSize) {
  runner.tick({0, 0, 0, 0, 0});
  EXPECT_EQ(runner.compensator->diagnostics().largest[0], 1'500);
  ASSERT_STREQ(code(runner.swap(constant_tables(-2'500.0F)).reason), "ok");
  runner.tick();
  EXPECT_EQ(runner.compensator->diagnostics().largest[0], 2'500);
  ASSERT_TRUE(runner.swap(constant_tables(10.0F)).ok());
  runner.tick();
  EXPECT_EQ(runner.compensator->diagnostics().largest[0], 2'500);
  EXPECT_EQ(runner.compensator->diagnostics().largest[1], 0);
}

// A condition is counted once per occurrence, not once per tick.
TEST_F(Counters, ConditionsCountTheirBeginnings) {
  for (int round = 1; round <= 3; ++round) {
    for (int n = 0; n < 5; ++n)
      runner.tick({0, 0, 0, 0, 0});
    runner.in.axis[1].valid = false;
    for (int n = 0; n < 5; ++n)
      runner.tick();
    runner.in.axis[1].valid = true;
    runner.in.axis[2].homed = false;
    for (int n = 0; n < 5; ++n)
      runner.tick();
    runner.in.axis[2].homed = true;
    for (int n = 0; n < 5; ++n)
      runner.tick({500'000'000, 0, 0, 0, 0});
    EXPECT_EQ(began(1, kStale), round);
    EXPECT_EQ(began(0, kStale), 0);
    EXPECT_EQ(began(2, kNotHomed), round);
    EXPECT_EQ(began(0, kOutOfRange), round);
    EXPECT_EQ(began(0, kFarOutOfRange), round);
    EXPECT_EQ(began(1, kOutOfRange), 0);
  }
  EXPECT_EQ(began(0, kDirectionUnknown), 1);
  EXPECT_EQ(began(0, kNoTables), 0);
}

TEST_F(Counters, ClampAndRateAreCounted) {
  auto settings = open_settings<5>();
  settings.axis[0].limit = 1'000;
  settings.axis[0].rate = 400;
  settings.axis[0].soft_rate = 400;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  for (int n = 0; n < 10; ++n)
    runner.tick({0, 0, 0, 0, 0});
  EXPECT_EQ(runner.out.offset[0], 1'000);
  EXPECT_EQ(began(0, kClamped), 1);
  EXPECT_EQ(began(0, kRateLimited), 1);
  EXPECT_EQ(runner.out.status[0] & (kClamped | kRateLimited), kClamped);
}

TEST_F(Counters, SaturateInsteadOfWrapping) {
  for (int n = 0; n < 2 * 65'540; ++n) {
    runner.in.axis[1].valid = n % 2 == 0;
    runner.tick({0, 0, 0, 0, 0});
  }
  EXPECT_EQ(began(1, kStale), 65'535);
  EXPECT_EQ(began(1, kValid), 65'535);
}

TEST_F(Counters, InactiveSaysSo) {
  LoadedRunner idle(kXyfzMachine);
  idle.tick({0, 0, 0, 0, 0});
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_EQ(idle.out.status[a], kNoTables);
  EXPECT_FALSE(idle.compensator->active());
}

// Status bits are distinct and all of them counted.
TEST(StatusBits, OnePerCondition) {
  unsigned all = 0;
  for (const StatusBit s : {kValid, kNotHomed, kStale, kDropped, kImplausible, kOutOfRange,
                            kFarOutOfRange, kClamped, kRateLimited, kDirectionUnknown, kRamping,
                            kNoAuthority, kNoTables, kTableDamaged, kAccelerationLimited}) {
    EXPECT_EQ(all & s, 0U);
    EXPECT_LT(bit(s), static_cast<std::size_t>(kStatusBits));
    all |= s;
  }
  EXPECT_EQ(all, (1U << static_cast<unsigned>(kStatusBits)) - 1U);
}

}  // namespace
}  // namespace volcomp::test
