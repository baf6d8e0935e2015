// Sine and cosine of latched angles, beside those of the C library in long double.

#include "comp/geometry/fine_trig.hpp"

#include <algorithm>
#include <cmath>

#include "tests/unit/realtime/support.hpp"

namespace volcomp::test {
namespace {

constexpr double kTurn = 1099511627776.0;  // 2^40

void expect_close(double units) {
  const long double angle = static_cast<long double>(units) / kTurn * 2.0L * std::acos(-1.0L);
  const FineSineCosine got = fine_sine_cosine(units);
  EXPECT_NEAR(got.sine, static_cast<double>(std::sin(angle)), 3e-16) << units;
  EXPECT_NEAR(got.cosine, static_cast<double>(std::cos(angle)), 3e-16) << units;
}

TEST(FineTrig, AgreesWithTheLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kManyPoints / 10; ++i)
    expect_close(random.in(-2.0 * kTurn, 2.0 * kTurn));
  for (int eighth = -16; eighth <= 16; ++eighth) {
    for (const double beside : {-1.0, -0.5, 0.0, 0.5, 1.0})
      expect_close(eighth * kTurn / 8.0 + beside);
  }
}

TEST(FineTrig, QuarterTurnsAreExact) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const FineSineCosine got = fine_sine_cosine(quarter * kTurn / 4.0);
    const int q = (quarter % 4 + 4) % 4;
    EXPECT_EQ(got.sine, q == 1 ? 1.0 : (q == 3 ? -1.0 : 0.0)) << quarter;
    EXPECT_EQ(got.cosine, q == 0 ? 1.0 : (q == 2 ? -1.0 : 0.0)) << quarter;
  }
}

// Radians, any number of turns: what is lost is the last bit of the angle itself.
TEST(FineTrig, RadiansAgreeWithTheLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kManyPoints / 10; ++i) {
    const double angle = random.in(-60.0, 60.0);
    const FineSineCosine got = fine_sine_cosine(units_within_a_turn(angle));
    const double tolerance = 4e-16 * std::max(1.0, std::abs(angle));
    EXPECT_NEAR(got.sine, static_cast<double>(std::sin(static_cast<long double>(angle))), tolerance)
        << angle;
    EXPECT_NEAR(got.cosine, static_cast<double>(std::cos(static_cast<long double>(angle))),
                tolerance)
        << angle;
  }
}

}  // namespace
}  // namespace volcomp::test
