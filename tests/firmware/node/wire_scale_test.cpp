// Drive units and run-time units against exact arithmetic in 128 bits.

#include "firmware/node/wire_scale.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::node {
namespace {

using test::Random;
__extension__ using Wide = __int128;

constexpr std::int64_t kTurn = std::int64_t{1} << 40U;
constexpr int kPoints = test::kManyPoints / 10;

// value / divisor to the nearest, halves to even; divisor > 0.
Wide nearest(Wide value, Wide divisor) {
  Wide quotient = value / divisor;
  Wide rest = value % divisor;
  if (rest < 0) {
    rest += divisor;
    --quotient;
  }
  if (2 * rest > divisor || (2 * rest == divisor && quotient % 2 != 0)) ++quotient;
  return quotient;
}

std::int32_t saturated(Wide value) {
  if (value > INT32_MAX) return INT32_MAX;
  if (value < INT32_MIN) return INT32_MIN;
  return static_cast<std::int32_t>(value);
}

std::int64_t any_integer(Random& random, unsigned bits) {
  const std::int64_t most = (std::int64_t{1} << random.integer(1, bits)) - 1;
  return random.integer(-most - 1, most);
}

std::int32_t any_int32(Random& random) {
  return static_cast<std::int32_t>(any_integer(random, 31));
}

WireScale any_scale(Random& random) {
  const auto factor = [&random] {
    return static_cast<std::uint32_t>(random.integer(1, std::int64_t{1} << random.integer(0, 20)));
  };
  return {factor(), factor(), random.chance(0.5)};
}

TEST(WireScale, OffsetsAreExactToTheNearestInBothDirections) {
  Random random(311);
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kPoints; ++i) {
    const WireScale s = any_scale(random);
    const Wide fine = s.rotary ? 256 : 1;  // 2^-32 turn in 2^-40 turn
    const std::int32_t offset = any_int32(random);
    ASSERT_EQ(offset_to_wire(offset, s),
              saturated(nearest(Wide{offset} * fine * s.denominator, s.numerator)));
    ASSERT_EQ(offset_from_wire(offset, s),
              saturated(nearest(Wide{offset} * s.numerator, fine * s.denominator)));
  }
}

TEST(WireScale, HalvesGoToTheEvenNeighbour) {
  const WireScale two_nm_per_unit{2, 1, false};
  EXPECT_EQ(offset_to_wire(1, two_nm_per_unit), 0);
  EXPECT_EQ(offset_to_wire(3, two_nm_per_unit), 2);
  EXPECT_EQ(offset_to_wire(5, two_nm_per_unit), 2);
  EXPECT_EQ(offset_to_wire(-1, two_nm_per_unit), 0);
  EXPECT_EQ(offset_to_wire(-3, two_nm_per_unit), -2);
}

// A promise may be exceeded, never missed.
TEST(WireScale, LimitsOfStepsAreRoundedDown) {
  EXPECT_EQ(step_to_wire(1500, {1000, 1, false}), 1);
  EXPECT_EQ(step_to_wire(9996, {10, 1, false}), 999);
  EXPECT_EQ(step_to_wire(400, {1000, 1, false}), 0);
  EXPECT_EQ(step_to_wire(400, {1, 3, false}), 1200);
  EXPECT_EQ(step_to_wire(INT32_MAX, {1, 1000, false}), INT32_MAX);
  Random random(315);
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kPoints; ++i) {
    const WireScale s = any_scale(random);
    const auto step = static_cast<std::int32_t>(random.integer(1, 1'000'000'000));
    const std::int32_t wire = step_to_wire(step, s);
    if (wire == INT32_MAX) continue;
    const Wide fine = s.rotary ? 256 : 1;
    ASSERT_LE(Wide{wire} * s.numerator, Wide{step} * fine * s.denominator);
    ASSERT_GT((Wide{wire} + 1) * s.numerator, Wide{step} * fine * s.denominator);
  }
}

TEST(WireScale, WhatDoesNotFitSaturates) {
  EXPECT_EQ(offset_to_wire(INT32_MAX, {1, 1000, false}), INT32_MAX);
  EXPECT_EQ(offset_to_wire(INT32_MIN, {1, kMostScale, true}), INT32_MIN);
  EXPECT_EQ(offset_from_wire(INT32_MIN, {kMostScale, 1, false}), INT32_MIN);
}

// A drive unit that is not coarser than the run-time unit loses nothing.
TEST(WireScale, ThereAndBackIsExactForFineDrives) {
  Random random(312);
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kPoints; ++i) {
    const auto denominator = static_cast<std::uint32_t>(random.integer(1, 1000));
    const auto numerator = static_cast<std::uint32_t>(random.integer(1, denominator));
    const auto offset = static_cast<std::int32_t>(random.integer(-4'000'000, 4'000'000));
    const WireScale s{numerator, denominator, false};
    if (Wide{offset} * denominator / numerator > INT32_MAX ||
        Wide{offset} * denominator / numerator < INT32_MIN)
      continue;
    ASSERT_EQ(offset_from_wire(offset_to_wire(offset, s), s), offset)
        << numerator << '/' << denominator;
  }
}

TEST(WirePosition, LinearPositionsAreTheNearestAndKeepNoState) {
  Random random(313);
  SCOPED_TRACE(random.trace());
  WirePosition position;
  for (int i = 0; i < kPoints; ++i) {
    WireScale s = any_scale(random);
    s.rotary = false;
    const std::int32_t wire = any_int32(random);
    const Wide exact = nearest(Wide{wire} * s.numerator, s.denominator);
    ASSERT_EQ(Wide{position.update(wire, s)}, exact);
  }
}

// 2^31 units per turn on the wire: every bit of the count is 512 units of the run time, for ever.
TEST(WirePosition, RotaryAxisIsCountedThroughOverManyTurns) {
  const WireScale s{512, 1, true};
  WirePosition position;
  std::uint32_t wire = 0;
  std::int64_t expected = 0;
  ASSERT_EQ(position.update(0, s), 0);
  constexpr std::uint32_t kStep = 0x3001'2345;  // 0.375 turn
  for (int i = 0; i < 100'000; ++i) {
    wire += kStep;
    expected += std::int64_t{kStep} * 512;
    ASSERT_EQ(position.update(static_cast<std::int32_t>(wire), s), expected);
  }
  EXPECT_GT(expected / kTurn, 37'000);
  for (int i = 0; i < 200'000; ++i) {
    wire -= kStep;
    expected -= std::int64_t{kStep} * 512;
    ASSERT_EQ(position.update(static_cast<std::int32_t>(wire), s), expected);
  }
}

// After 2^23 turns the count wraps: to the same angle, as 2^64 is a whole number of turns.
TEST(WirePosition, TheCountWrapsByWholeTurns) {
  const WireScale s{kMostScale, 1, true};
  constexpr std::uint32_t kStep = 0x4000'0123;  // 1024 turns and a bit
  WirePosition position;
  std::uint32_t wire = 0;
  std::uint64_t expected = 0;
  ASSERT_EQ(position.update(0, s), 0);
  for (int i = 0; i < 20'000; ++i) {
    wire += kStep;
    expected += std::uint64_t{kStep} * kMostScale;
    ASSERT_EQ(position.update(static_cast<std::int32_t>(wire), s),
              static_cast<std::int64_t>(expected));
  }
}

// Run-time units per drive unit that no decimal fraction can express: nothing is lost on the way,
// the sum of all movements is rounded down once.
TEST(WirePosition, RationalScalesNeverDrift) {
  Random random(314);
  SCOPED_TRACE(random.trace());
  for (int run = 0; run < 20; ++run) {
    WireScale s = any_scale(random);
    s.rotary = true;
    WirePosition position;
    std::uint32_t wire = 0;
    Wide moved = 0;
    for (int i = 0; i < kPoints / 20; ++i) {
      const std::int32_t step = any_int32(random);
      wire += static_cast<std::uint32_t>(step);
      moved += step;
      const Wide product = moved * s.numerator;
      const Wide floor = product / s.denominator - (product % s.denominator < 0 ? 1 : 0);
      ASSERT_EQ(Wide{position.update(static_cast<std::int32_t>(wire), s)}, floor)
          << s.numerator << '/' << s.denominator;
    }
  }
}

TEST(WirePosition, StartsAtTheReadingAfterAReset) {
  const WireScale s{512, 1, true};
  WirePosition position;
  EXPECT_EQ(position.update(1000, s), 512'000);
  EXPECT_EQ(position.update(INT32_MAX, s), std::int64_t{INT32_MAX} * 512);
  EXPECT_EQ(position.update(INT32_MIN, s), (std::int64_t{INT32_MAX} + 1) * 512);
  position.reset();
  EXPECT_EQ(position.update(INT32_MIN, s), std::int64_t{INT32_MIN} * 512);
}

}  // namespace
}  // namespace volcomp::node
