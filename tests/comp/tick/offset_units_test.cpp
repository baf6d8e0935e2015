// What is stated in seconds, in ticks: a = floor(alpha·T²/unit), v = floor(nu·T/unit), for units of
// 1 nm and 2^-32 turn; times to the nearest tick.

#include "comp/tick/offset_units.hpp"

#include <limits>
#include <string>

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

TEST(OffsetUnits, ARotaryAccelerationEndsAtAMillion) {
  std::int32_t units = 0;
  EXPECT_TRUE(acceleration_in_units(true, 1e6, 1e-3, units).ok());
  EXPECT_EQ(acceleration_in_units(true, 1.1e6, 1e-3, units).reason, Reason::bad_setting);
}

TEST(OffsetUnits, TheLargestSaturates) { EXPECT_EQ(units_of(false, 1e9, 1.0), INT32_MAX); }

std::int32_t rate_of(bool rotary, double rate, double period_s) {
  std::int32_t units = -1;
  EXPECT_TRUE(rate_in_units("rate", rotary, rate, period_s, units).ok());
  return units;
}

// 10 000 nm per tick are 10 mm/s at 1 ms and 80 mm/s at 125 µs.
TEST(OffsetUnits, TheSameRateIsFewerUnitsInAShorterTick) {
  EXPECT_EQ(rate_of(false, 10.0, 1e-3), 10'000);
  EXPECT_EQ(rate_of(false, 10.0, 250e-6), 2'500);
  EXPECT_EQ(rate_of(false, 10.0, 125e-6), 1'250);
  EXPECT_EQ(rate_of(false, 80.0, 125e-6), 10'000);
  EXPECT_EQ(rate_of(false, 10.0, 62.5e-6), 625);
}

// 0.1 rad/s · 1e-3 s · 2^32 / 2π = 68 356.
TEST(OffsetUnits, ARateIsRoundedDown) {
  EXPECT_EQ(rate_of(true, 0.1, 1e-3), 68'356);
  EXPECT_EQ(rate_of(true, 0.1, 125e-6), 8'544);
  EXPECT_EQ(rate_of(false, 0.0019, 1e-3), 1);
  for (int n = 1; n <= 2000; ++n)
    ASSERT_EQ(rate_of(false, 1e-3 * n, 1e-3), n);
}

TEST(OffsetUnits, RatesThatNoCompensatorTakesAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::int32_t units = 77;
  const auto refused = [&units](double rate, double period_s) {
    const Status status = rate_in_units("soft_rate", false, rate, period_s, units);
    EXPECT_EQ(status.reason, Reason::bad_setting) << rate << " " << period_s;
    return std::string(status.where.field);
  };
  for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 1.1e9, 9e-4})
    EXPECT_EQ(refused(bad, 1e-3), "soft_rate");
  EXPECT_EQ(refused(1'001.0, 1.0), "soft_rate") << "more than 1e9 units";
  for (const double bad : {0.0, -1e-3, nan, 0.9e-6, 1.1})
    EXPECT_EQ(refused(10.0, bad), "period");
  EXPECT_EQ(units, 77) << "as before";
  EXPECT_EQ(rate_of(false, 1'000.0, 1.0), 1'000'000'000);
}

// 1 m/s moves by 1 mm in 1 ms; pi rad/s by half a turn in 1 s.
TEST(OffsetUnits, StepsOfAnAxisCountInUnitsOfItsPosition) {
  std::int64_t units = 77;
  EXPECT_TRUE(step_in_units(false, 1'000.0, 1e-3, units).ok());
  EXPECT_EQ(units, 1'000'000);
  EXPECT_TRUE(step_in_units(true, kPi, 1.0, units).ok());
  EXPECT_EQ(units, kUnitsPerTurn / 2);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), 1.1e9, 4e-4})
    EXPECT_STREQ(step_in_units(false, bad, 1e-3, units).where.field, "max_speed");
  EXPECT_STREQ(step_in_units(false, 1.0, 1.1, units).where.field, "period");
  EXPECT_EQ(units, kUnitsPerTurn / 2) << "as before";
  EXPECT_TRUE(step_in_units(false, 0.0, 1e-3, units).ok());
  EXPECT_EQ(units, 0) << "any";
}

TEST(OffsetUnits, TimesAreTheNearestNumberOfTicks) {
  std::uint32_t ticks = 0;
  const auto of = [&ticks](double seconds, double period_s) {
    EXPECT_TRUE(ticks_in("ramp", seconds, period_s, 1U << 24, ticks).ok());
    return ticks;
  };
  EXPECT_EQ(of(0.2, 1e-3), 200U);
  EXPECT_EQ(of(0.2, 250e-6), 800U);
  EXPECT_EQ(of(0.2, 125e-6), 1'600U);
  EXPECT_EQ(of(0.2, 62.5e-6), 3'200U);
  EXPECT_EQ(of(0.0024, 1e-3), 2U);
  EXPECT_EQ(of(0.0026, 1e-3), 3U);
  EXPECT_EQ(of(0.0, 1e-3), 0U);
  EXPECT_EQ(of(16'777.216, 1e-3), 1U << 24);
}

TEST(OffsetUnits, TimesThatAreNoneAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t ticks = 77;
  const auto refused = [&ticks](double seconds, double period_s) {
    const Status status = ticks_in("ramp", seconds, period_s, 1U << 24, ticks);
    EXPECT_EQ(status.reason, Reason::bad_setting) << seconds << " " << period_s;
    return std::string(status.where.field);
  };
  for (const double bad : {-1e-3, nan, std::numeric_limits<double>::infinity(), 16'777.3})
    EXPECT_EQ(refused(bad, 1e-3), "ramp");
  for (const double bad : {0.0, nan, 1.1})
    EXPECT_EQ(refused(0.2, bad), "period");
  EXPECT_EQ(ticks, 77U) << "as before";
}

}  // namespace
}  // namespace volcomp
