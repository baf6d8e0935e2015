// Sine, cosine, square root and arc tangent, beside those of the C library.

#include "comp/machine/fine_trig.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr double kFullTurn = 1099511627776.0;  // 2^40

void expect_close(double units) {
  const long double angle = static_cast<long double>(units) / kFullTurn * 2.0L * std::acos(-1.0L);
  const FineSineCosine got = fine_sine_cosine(units);
  EXPECT_NEAR(got.sine, static_cast<double>(std::sin(angle)), 3e-16) << units;
  EXPECT_NEAR(got.cosine, static_cast<double>(std::cos(angle)), 3e-16) << units;
}

TEST(FineTrig, AgreesWithTheLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kManyPoints / 10; ++i)
    expect_close(random.in(-2.0 * kFullTurn, 2.0 * kFullTurn));
  for (int eighth = -16; eighth <= 16; ++eighth) {
    for (const double beside : {-1.0, -0.5, 0.0, 0.5, 1.0})
      expect_close(eighth * kFullTurn / 8.0 + beside);
  }
}

TEST(FineTrig, QuarterTurnsAreExact) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const FineSineCosine got = fine_sine_cosine(quarter * kFullTurn / 4.0);
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

// At most one unit in the last place from the correctly rounded root.
void expect_root(double x) {
  const double wanted = std::sqrt(x);
  const double ulp = std::nextafter(wanted, 2.0 * wanted) - wanted;
  EXPECT_LE(std::abs(fine_root(x) - wanted), ulp) << x;
}

TEST(FineRoot, AgreesWithTheLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kManyPoints / 10; ++i) {
    expect_root(random.in(0.0, 1000.0));
    const auto exponent = static_cast<int>(random.in(-1073.0, 1024.0));
    expect_root(std::ldexp(random.in(0.5, 1.0), exponent));
  }
}

TEST(FineRoot, EdgesOfTheRange) {
  using Limits = std::numeric_limits<double>;
  EXPECT_EQ(fine_root(0.0), 0.0);
  EXPECT_EQ(fine_root(4.0), 2.0);
  EXPECT_EQ(fine_root(2.25e-60), 1.5e-30);
  for (const double x : {Limits::denorm_min(), 3.0 * Limits::denorm_min(), Limits::min(),
                         0.999 * Limits::min(), 1e-30, 1e30, Limits::max()})
    expect_root(x);
  EXPECT_EQ(fine_root(Limits::infinity()), Limits::infinity());
  EXPECT_TRUE(std::isnan(fine_root(-1.0)));
  EXPECT_TRUE(std::isnan(fine_root(Limits::quiet_NaN())));
}

void expect_angle(double y, double x) {
  const long double wanted = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
  const double error = std::abs(static_cast<double>(fine_arc_tangent(y, x) - wanted));
  EXPECT_LE(error, 4e-16 * static_cast<double>(std::abs(wanted))) << y << ' ' << x;
}

TEST(FineArcTangent, AgreesWithTheLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kManyPoints / 10; ++i) {
    const double x = random.in(-200.0, 200.0);
    expect_angle(random.in(-200.0, 200.0), x);
    expect_angle(random.in(-1e-3, 1e-3), x);
    expect_angle(x, random.in(-1e-3, 1e-3));
  }
  // Where the way changes.
  for (const double ratio : {0.195, 0.40625, 0.664, 1.0}) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double beside : {-1e-15, 0.0, 1e-15}) {
        expect_angle(sign * (ratio + beside), 1.0);
        expect_angle(sign * (ratio + beside), -1.0);
        expect_angle(1.0, sign * (ratio + beside));
      }
    }
  }
}

TEST(FineArcTangent, OnTheAxes) {
  EXPECT_EQ(fine_arc_tangent(0.0, 0.0), 0.0);
  EXPECT_EQ(fine_arc_tangent(0.0, 3.0), 0.0);
  EXPECT_EQ(fine_arc_tangent(3.0, 0.0), kPi / 2.0);
  EXPECT_EQ(fine_arc_tangent(-3.0, 0.0), -kPi / 2.0);
  EXPECT_EQ(fine_arc_tangent(0.0, -3.0), kPi);
  EXPECT_EQ(fine_arc_tangent(2.0, 2.0), kPi / 4.0);
  EXPECT_TRUE(std::isnan(fine_arc_tangent(std::numeric_limits<double>::quiet_NaN(), 1.0)));
  EXPECT_TRUE(std::isnan(fine_arc_tangent(1.0, std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace volcomp::test
