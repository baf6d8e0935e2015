// The following error of a drive at a reversal. The figures are those of the study the limiter was
// specified with (an independent model in Python): 40 µm, 2 m/s², 10 % to spare, 40 Hz, 125 µs.

#include "host_sim/experiments/reversal/scenario.hpp"

#include <gtest/gtest.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::reversal {
namespace {

// A critically damped loop with speed and acceleration fed forward is ahead by a·T/ω: its fed
// forward speed is the mean of the period that begins.
TEST(Reversal, WithoutAnOffsetTheErrorIsThatOfTheLoop) {
  const ReversalResult r = run_reversal({});
  constexpr double kExpected_um = 1e6 * 2.0 * 125e-6 / (2.0 * 3.14159265358979 * 40.0);
  EXPECT_NEAR(r.without_um, kExpected_um, 0.01);
}

TEST(Reversal, AnOffsetInOnePeriodIsFollowingError) {
  const ReversalResult r = run_reversal({});
  EXPECT_NEAR(r.effects.at(0).along_um, 39.7, 0.4);
  EXPECT_NEAR(r.effects.at(0).against_um, 40.9, 0.4);
}

TEST(Reversal, WithTheAccelerationToSpareTheDriveFollows) {
  const ReversalResult r = run_reversal({});
  const OffsetEffect& e = r.effects.at(r.judged);
  EXPECT_EQ(e.plan.rate, 10.0);
  EXPECT_NEAR(e.plan.acceleration, 0.2, 1e-12);
  EXPECT_NEAR(e.along_um, 1.1, 0.1);
  EXPECT_NEAR(e.against_um, 1.1, 0.1);
  EXPECT_LE(e.largest_um(), 1.2);
  EXPECT_TRUE(r.ok());
}

// 40 µm with 0.2 m/s²: up and down again as a triangle, 2·√(s/a) = 28.3 ms; with 3 nm per period
// and period, which is 0.192 m/s², 28.9 ms.
TEST(Reversal, TheOffsetTakesAsLongAsItsAccelerationDemands) {
  const ReversalResult r = run_reversal({});
  EXPECT_NEAR(r.effects.at(r.judged).taken_ms, 28.9, 0.3);
  EXPECT_EQ(r.effects.at(0).taken_ms, 0.0);
}

// The rate alone does not help: the offset starts and stops within a period.
TEST(Reversal, WithTheRateAloneTheDriveSaturates) {
  const ReversalResult r = run_reversal({});
  EXPECT_NEAR(r.effects.at(1).along_um, 37.0, 1.0);
  EXPECT_GT(r.effects.at(1).against_um, 200.0);
  EXPECT_NEAR(r.effects.at(2).along_um, 29.0, 1.0);
  EXPECT_NEAR(r.effects.at(2).against_um, 45.0, 1.0);
}

TEST(Reversal, MoreAccelerationThanToSpareIsTooMuch) {
  const ReversalResult r = run_reversal({});
  EXPECT_NEAR(r.effects.at(3).plan.acceleration, 0.5, 1e-12);
  EXPECT_GT(r.effects.at(3).along_um, 10.0);
}

TEST(Reversal, ThePeriodOfAFastBusCannotResolveTheAcceleration) {
  ReversalOptions options;
  options.period_us = 62.5;  // 0.78 nm per period and period
  EXPECT_THROW(static_cast<void>(run_reversal(options)), host::UserError);
}

TEST(Reversal, TheCriterionDecides) {
  ReversalOptions options;
  options.most_added_um = 0.0;
  EXPECT_FALSE(run_reversal(options).ok());
}

}  // namespace
}  // namespace volcomp::reversal
