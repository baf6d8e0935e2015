// Deviations against analytic traces, limits of ISO 1328-1 for the gear of docs/papers/l300g.md.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/gears/pitch.hpp"

namespace volcomp::test {
namespace {

constexpr GearSize kPaper{124.0, 4.0, 30.0};

// f_pt, F_p, F_α, f_fα, f_Hα, F_β, f_fβ, f_Hβ.
using Row = std::array<double, 8>;

void expect_limits(GearStandard standard, int grade, const Row& wanted) {
  const GearLimits limits = gear_limits(standard, kPaper, grade);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(limits.rounded[i], wanted[i], 1e-9) << "grade " << grade << ", deviation " << i;
}

TEST(GearLimits, OfThePapersGear) {
  using S = GearStandard;
  expect_limits(S::iso1328_1995, 3, {3.2, 9.5, 4.8, 3.7, 3.0, 4.2, 3.0, 3.0});
  expect_limits(S::iso1328_1995, 4, {4.6, 14, 6.5, 5.0, 4.3, 6.0, 4.3, 4.3});
  expect_limits(S::iso1328_1995, 7, {13, 39, 19, 15, 12, 17, 12, 12});
  expect_limits(S::iso1328_1995, 8, {18, 55, 27, 21, 17, 24, 17, 17});
  expect_limits(S::iso1328_2013, 4, {4.8, 15, 6.5, 5.0, 4.0, 7.0, 5.0, 4.6});
  expect_limits(S::iso1328_2013, 7, {13, 42, 18, 14, 11, 19, 14, 13});
  expect_limits(S::iso1328_2013, 8, {19, 60, 26, 20, 16, 27, 20, 18});
}

TEST(GearLimits, GradeIsTheSmallestThatIsKept) {
  const auto grade = [](double um) {
    return grade_of(GearStandard::iso1328_1995, kPaper, GearDeviation::profile, um);
  };
  EXPECT_EQ(grade(6.5), 4);
  EXPECT_EQ(grade(-6.5), 4);
  EXPECT_EQ(grade(6.51), 5);
  EXPECT_EQ(grade(20.57), 8);
  EXPECT_FALSE(grade(1000.0));
}

TEST(GearLimits, SizesOutsideTheStandardAreNamed) {
  EXPECT_TRUE(check_size(GearStandard::iso1328_1995, kPaper).ok());
  const Status status = check_size(GearStandard::iso1328_1995, {4.9, 4.0, 30.0});
  EXPECT_EQ(status.reason, Reason::out_of_standard);
  EXPECT_STREQ(status.where.field, "diameter");
  EXPECT_TRUE(check_size(GearStandard::iso1328_2013, {12000.0, 4.0, 30.0}).ok());
  EXPECT_FALSE(check_size(GearStandard::iso1328_1995, {12000.0, 4.0, 30.0}).ok());
}

// A line and a sine of whole periods, symmetric about the middle: their figures are known.
TEST(GearTrace, LineAndCosine) {
  constexpr double kRise = 0.004;
  constexpr double kWave = 0.002;
  std::vector<double> at;
  std::vector<double> f;
  for (int i = 0; i <= 400; ++i) {
    const double u = i / 400.0;
    at.push_back(10.0 + 20.0 * u);
    f.push_back(kRise * u + kWave * std::cos(4.0 * kPi * u));
  }
  TraceDeviations d;
  ASSERT_TRUE(evaluate_trace(at, f, {10.0, 30.0}, d).ok());
  EXPECT_EQ(d.used, 401U);
  EXPECT_NEAR(d.slope, kRise, 1e-12);
  EXPECT_NEAR(d.form, 2.0 * kWave, 1e-12);
}

TEST(GearTrace, OnlyTheRangeCounts) {
  const std::vector<double> at{0.0, 1.0, 2.0, 3.0, 4.0};
  const std::vector<double> f{100.0, 0.0, 1.0, 2.0, -100.0};
  TraceDeviations d;
  ASSERT_TRUE(evaluate_trace(at, f, {1.0, 3.0}, d).ok());
  EXPECT_EQ(d.used, 3U);
  EXPECT_NEAR(d.total, 2.0, 1e-12);
  EXPECT_NEAR(d.form, 0.0, 1e-12);
  const Status status = evaluate_trace(at, f, {1.0, 2.0}, d);
  EXPECT_EQ(status.reason, Reason::too_few_points);
  EXPECT_EQ(status.where.count, 2);
}

TEST(GearPitch, ClosesAroundTheGear) {
  const std::vector<double> position{0.0, 0.002, 0.001, -0.004};
  PitchDeviations d;
  ASSERT_TRUE(evaluate_pitch(position, d).ok());
  EXPECT_NEAR(d.total, 0.006, 1e-15);
  EXPECT_NEAR(d.single_signed, -0.005, 1e-15);
  EXPECT_EQ(d.tooth, 3U);
}

}  // namespace
}  // namespace volcomp::test
