// Changes are ramped along s(u) = 6u⁵ − 15u⁴ + 10u³ from where the output is to where it should be.

#include "comp/tick/limiter.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

double smooth(double u) { return 6 * std::pow(u, 5) - 15 * std::pow(u, 4) + 10 * std::pow(u, 3); }

CompensatorSettings<5> ramped(std::uint32_t ticks) {
  auto settings = open_settings<5>();
  settings.ramp_ticks = ticks;
  return settings;
}

TEST(RampShape, IsTheQuinticStep) {
  for (const std::uint32_t ticks : {1U, 2U, 7U, 200U, 100'000U}) {
    Ramp ramp;
    ramp.restart(ticks);
    // Long ramps end a little lower, so that rounding does not bring them above 1: 1.9e-6 more.
    const double tolerance = ticks < 269 ? 2e-6 : 4e-6;
    for (std::uint32_t k = 1; k <= ticks; ++k) {
      ASSERT_TRUE(ramp.running());
      const double u = static_cast<double>(k) / ticks;
      ASSERT_NEAR(static_cast<double>(ramp.advance()), smooth(u), tolerance)
          << k << " of " << ticks;
    }
    EXPECT_FALSE(ramp.running());
    EXPECT_EQ(ramp.advance(), 1.0F);
  }
}

// A factor above 1 would put a clamped output beyond its limit: 9 nm at the largest.
TEST(RampShape, DoesNotGoBeyondItsEnd) {
  for (std::uint32_t ticks = 2; ticks <= 2000; ++ticks) {
    Ramp ramp;
    ramp.restart(ticks);
    for (float factor = ramp.begin(); ramp.running(); factor = ramp.advance())
      ASSERT_TRUE(factor >= 0.0F && factor <= 1.0F) << ticks << " ticks";
  }
}

// Nothing to ramp: at its end from the beginning.
TEST(RampShape, OfNoTicksIsOver) {
  Ramp none;
  none.restart(0);
  EXPECT_FALSE(none.running());
  EXPECT_TRUE(none.at_rest());
}

TEST(Ramp, ActivationSwapAndDeactivationFollowTheSmoothStep) {
  constexpr std::uint32_t kTicks = 200;
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(constant_tables(100'000.0F), ramped(kTicks)).ok());
  double from = 0.0;
  const auto follow = [&](double to) {
    for (std::uint32_t k = 1; k <= kTicks; ++k) {
      runner.tick({0, 0, 0, 0, 0});
      const double want = from + (to - from) * smooth(static_cast<double>(k) / kTicks);
      ASSERT_NEAR(runner.out.offset[0], want, 1.0) << "tick " << k;
      ASSERT_NE(runner.out.status[0] & kRamping, 0);
    }
    ASSERT_EQ(runner.out.offset[0], static_cast<std::int32_t>(to)) << "ends exactly";
    runner.tick({0, 0, 0, 0, 0});
    ASSERT_EQ(runner.out.offset[0], static_cast<std::int32_t>(to)) << "and stays";
    ASSERT_EQ(runner.out.status[0] & kRamping, 0);
    from = to;
  };
  follow(100'000);
  ASSERT_TRUE(runner.swap(constant_tables(-80'001.0F)).ok());
  follow(-80'001);
  runner.compensator->deactivate();
  follow(0);
}

// A change in the middle of a change starts where the output is: no step, no kink of the first
// tick.
TEST(Ramp, InterruptedRampContinuesFromWhereItIs) {
  constexpr std::uint32_t kTicks = 100;
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(constant_tables(100'000.0F), ramped(kTicks)).ok());
  for (int k = 0; k < 50; ++k)
    runner.tick({0, 0, 0, 0, 0});
  ASSERT_EQ(runner.out.offset[0], 50'000);
  runner.compensator->deactivate();
  for (std::uint32_t k = 1; k <= kTicks; ++k) {
    runner.tick({0, 0, 0, 0, 0});
    const double want = 50'000 * (1 - smooth(static_cast<double>(k) / kTicks));
    ASSERT_NEAR(runner.out.offset[0], want, 1.0) << "tick " << k;
  }
}

TEST(Ramp, FirstTickContinuesFromTheGivenOffsets) {
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.compensator->configure(ramped(200)).ok());
  ASSERT_TRUE(runner.compensator->start_from({34'567, -12'345, 777, 0, 0}).ok());
  const auto offset = runner.tick({0, 0, 0, 0, 0}).offset;
  EXPECT_EQ(offset[0], 34'567);
  EXPECT_EQ(offset[1], -12'345);
  EXPECT_EQ(offset[2], 777);
  for (int n = 0; n < 200; ++n)
    runner.tick();
  EXPECT_EQ(runner.out.offset, (std::array<std::int32_t, 5>{}));
  EXPECT_NE(runner.out.status[0] & kNoTables, 0);
}

TEST(Ramp, StartOffsetsAreHeldUntilEveryAxisHasReported) {
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.compensator->configure(ramped(10)).ok());
  ASSERT_TRUE(runner.compensator->start_from({34'567, -12'345, 777, 0, 0}).ok());
  ASSERT_TRUE(runner.swap(constant_tables(50'000.0F)).ok());
  runner.in.axis[2].valid = false;
  for (int n = 0; n < 5; ++n) {
    runner.tick({0, 0, 0, 0, 0});
    EXPECT_EQ(runner.out.offset[0], 34'567);
    EXPECT_NE(runner.out.status[0] & kStale, 0);
  }
  runner.in.axis[2].valid = true;
  for (int n = 0; n < 20; ++n)
    runner.tick();
  EXPECT_EQ(runner.out.offset[0], 50'000);
}

// Once a ramp has ended, where it began is forgotten: no bit of the output depends on it.
TEST(Ramp, AfterTheEndTheStartLeavesNoTrace) {
  Random random(60);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  LoadedRunner plain(kXyfzMachine);
  LoadedRunner started(kXyfzMachine);
  ASSERT_TRUE(plain.start(tables).ok());
  ASSERT_TRUE(started.compensator->configure(open_settings<5>()).ok());
  ASSERT_TRUE(started.compensator->start_from({4'000'001, -3'999'999, 2'345'677, 0, 0}).ok());
  ASSERT_TRUE(started.swap(tables).ok());
  const LoadedRunner::Positions first{-250'000'000, -150'000'000, -200'000'000, 0, 0};
  for (int n = 0; n < 3; ++n) {
    plain.tick(first);
    started.tick(first);
  }
  for (int n = 0; n < 100'000; ++n) {
    const LoadedRunner::Positions q{random.integer(-500'000'000, 0),
                                    random.integer(-300'000'000, 0),
                                    random.integer(-400'000'000, 0), 0, 0};
    ASSERT_EQ(plain.tick(q).offset, started.tick(q).offset) << "point " << n;
  }
}

// A float counts exactly up to 2^24: the longest ramp that is accepted never runs backwards, longer
// ones are refused.
TEST(Ramp, LongestRampIsMonotoneAndLongerOnesAreRefused) {
  constexpr std::uint32_t kLongest = 1U << 24U;
  LoadedRunner runner(kXyfzMachine);
  auto settings = open_settings<5>();
  settings.ramp_ticks = kLongest;
  EXPECT_TRUE(runner.compensator->configure(settings).ok());
  for (const std::uint32_t ticks : {kLongest + 1, UINT32_MAX}) {
    settings.ramp_ticks = ticks;
    const Status refused = runner.compensator->configure(settings);
    EXPECT_EQ(refused.reason, Reason::bad_setting);
    EXPECT_STREQ(refused.where.field, "ramp_ticks");
  }
  Ramp ramp;
  ramp.restart(kLongest);
  float last = 0.0F;
  for (std::uint32_t k = 0; k < kLongest; ++k) {
    const float now = ramp.advance();
    // The terms of the polynomial are up to 10, half a unit in the last place of each is 5e-7:
    // 0.2 nm of the largest ordinary offset may be taken back, no more.
    if (now < last - 1e-6F) FAIL() << "tick " << k;
    last = now;
  }
  EXPECT_EQ(last, 1.0F);
  EXPECT_FALSE(ramp.running());
}

// Integers in range are rounded exactly, ties go to the even neighbour.
TEST(Rounding, HalfToEvenOverTheWholeRange) {
  Random random(61);
  SCOPED_TRACE(random.trace());
  for (std::int32_t n = -20; n < 20; ++n) {
    EXPECT_EQ(round_half_even(static_cast<float>(n) + 0.5F), n % 2 == 0 ? n : n + 1);
    EXPECT_EQ(round_half_even(static_cast<float>(n)), n);
  }
  for (int k = 0; k < 100'000; ++k) {
    const auto x = static_cast<float>(random.in(-4'194'303.0, 4'194'303.0));
    ASSERT_EQ(round_half_even(x), static_cast<std::int32_t>(std::nearbyint(x))) << x;
  }
  EXPECT_EQ(round_half_even(4'194'303.0F), 4'194'303);
  EXPECT_EQ(round_half_even(-4'194'303.0F), -4'194'303);
}

// What a limit below 2^22 is compared with needs no test of its own for numbers beyond, infinities
// and what is not a number.
TEST(RoundHalfEven, AnythingElseLiesBeyondWhatIsRounded) {
  std::size_t others = 0;
  for (std::uint64_t pattern = 0; pattern <= UINT32_MAX; pattern += 997) {
    const auto x = bit_cast<float>(static_cast<std::uint32_t>(pattern));
    if (std::abs(x) < 4'194'303.5F) continue;
    ++others;
    ASSERT_GT(std::abs(std::int64_t{round_half_even(x)}), 4'194'303) << x;
  }
  EXPECT_GT(others, 1'000'000U);
  for (const float x : {HUGE_VALF, -HUGE_VALF, std::nanf(""), -std::nanf(""), -12'582'912.0F})
    EXPECT_GT(std::abs(std::int64_t{round_half_even(x)}), 4'194'303) << x;
}

}  // namespace
}  // namespace volcomp::test
