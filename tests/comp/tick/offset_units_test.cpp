// Acceleration of an offset from seconds to ticks: a = floor(alpha·T²/unit), for units of 1 nm and
// 2^-32 turn.

#include "comp/tick/offset_units.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace volcomp {
namespace {

std::int32_t units_of(bool rotary, double acceleration, double period_s) {
  std::int32_t units = -1;
  EXPECT_TRUE(acceleration_in_units(rotary, acceleration, period_s, units).ok());
  return units;
}

Status refusal_of(double acceleration, double period_s) {
  std::int32_t units = 77;
  const Status status = acceleration_in_units(false, acceleration, period_s, units);
  EXPECT_EQ(units, 77) << "as before";
  return status;
}

// 0.2 m/s² are 200 nm at 1 ms, 12.5 at 250 µs, 3.125 at 125 µs.
TEST(OffsetUnits, AccelerationIsRoundedDown) {
  EXPECT_EQ(units_of(false, 200.0, 1e-3), 200);
  EXPECT_EQ(units_of(false, 200.0, 250e-6), 12);
  EXPECT_EQ(units_of(false, 200.0, 125e-6), 3);
  EXPECT_EQ(units_of(false, 200.0, 2e-3), 800);
  EXPECT_EQ(units_of(false, 500.0, 1e-3), 500);
}

// 2 rad/s² · 1e-6 s² · 2^32 / 2π = 1367.13; a unit is 1.463 nrad.
TEST(OffsetUnits, OfARotaryAxisItCountsInPartsOfATurn) {
  EXPECT_EQ(units_of(true, 2.0, 1e-3), 1367);
  EXPECT_EQ(units_of(true, 2.0, 125e-6), 21);
}

// Numbers that are whole in decimals are whole, although their product misses it as a double.
TEST(OffsetUnits, WholeNumbersStayWhole) {
  for (int n = 1; n <= 2000; ++n)
    ASSERT_EQ(units_of(false, n, 1e-3), n);
  for (int n = 1; n <= 2000; ++n)
    ASSERT_EQ(units_of(false, 100.0 * n, 1e-4), n);
}

TEST(OffsetUnits, NoneStaysNone) { EXPECT_EQ(units_of(false, 0.0, 1e-3), 0); }

// 0.78 nm per tick and tick. 0 would mean none, the opposite of what was stated.
TEST(OffsetUnits, LessThanAUnitIsRefused) {
  const Status status = refusal_of(200.0, 62.5e-6);
  EXPECT_EQ(status.reason, Reason::acceleration_too_small);
  EXPECT_STREQ(status.where.field, "acceleration");
  EXPECT_EQ(refusal_of(0.999, 1e-3).reason, Reason::acceleration_too_small);
  EXPECT_EQ(units_of(false, 1.0, 1e-3), 1);
}

TEST(OffsetUnits, WhatIsNoAccelerationOrPeriodIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan, std::numeric_limits<double>::infinity(), 1.1e9}) {
    EXPECT_EQ(refusal_of(bad, 1e-3).reason, Reason::bad_setting);
    EXPECT_STREQ(refusal_of(bad, 1e-3).where.field, "acceleration");
  }
  for (const double bad : {0.0, -1e-3, nan, 0.9e-6, 1.1}) {
    EXPECT_EQ(refusal_of(200.0, bad).reason, Reason::bad_setting);
    EXPECT_STREQ(refusal_of(200.0, bad).where.field, "period");
  }
}

TEST(OffsetUnits, TheLargestSaturates) { EXPECT_EQ(units_of(false, 1e9, 1.0), INT32_MAX); }

}  // namespace
}  // namespace volcomp
