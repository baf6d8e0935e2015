// Grades against those of Table 4 (docs/papers/internal-helical.md), and pitch and profile of
// internal gears.

#include <cmath>
#include <limits>
#include <vector>

#include "comp/metrology/gears/gear_grade.hpp"
#include "comp/metrology/gears/internal_gear_deviations.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

// Table 4 of the paper: value in µm and the grade it prints.
struct Printed {
  GearDeviation deviation;
  double um;
  int grade;
};
constexpr GearDeviation kTotal = GearDeviation::total_pitch;
constexpr GearDeviation kSingle = GearDeviation::single_pitch;
constexpr GearDeviation kProfile = GearDeviation::profile;
constexpr std::array<Printed, 10> kTable4{{{kTotal, 28.8, 6},
                                           {kTotal, 24.1, 5},
                                           {kTotal, 27.4, 6},
                                           {kTotal, 17.2, 4},
                                           {kSingle, 7.9, 6},
                                           {kSingle, 6.2, 5},
                                           {kSingle, 5.8, 5},
                                           {kSingle, 3.6, 4},
                                           {kProfile, 11.3, 7},
                                           {kProfile, 7.3, 5}}};
constexpr GearSize kPaper{163.573637, 2.0, 45.0};
constexpr GearSize kNextRow{163.573637, 2.070552, 45.0};  // as if the transverse module counted

void expect_grades(GearStandard standard, LimitRounding rounding, const GearSize& size,
                   const std::array<int, 10>& wanted, int agree) {
  int same = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    GearGrade g;
    ASSERT_TRUE(grade_gear(standard, rounding, size, kTable4[i].deviation, kTable4[i].um, g).ok());
    EXPECT_EQ(g.grade, wanted[i]) << kTable4[i].um << " um";
    if (g.grade == kTable4[i].grade) ++same;
  }
  EXPECT_EQ(same, agree);
}

// No edition reproduces all ten grades of the paper, and none is bent until it does.
TEST(PapersGrades, AgreeAsFarAsSection11Says) {
  using S = GearStandard;
  using R = LimitRounding;
  expect_grades(S::iso1328_1995, R::rounded, kPaper, {6, 6, 6, 5, 6, 6, 5, 4, 7, 6}, 6);
  expect_grades(S::iso1328_1995, R::unrounded, kPaper, {6, 5, 6, 4, 6, 6, 5, 4, 7, 6}, 8);
  expect_grades(S::iso1328_1995, R::rounded, kNextRow, {6, 5, 6, 4, 6, 5, 5, 4, 6, 5}, 9);
  expect_grades(S::iso1328_2013, R::rounded, kPaper, {6, 6, 6, 5, 6, 6, 5, 4, 7, 5}, 7);
  expect_grades(S::iso1328_2013, R::unrounded, kPaper, {6, 6, 6, 5, 6, 6, 5, 4, 7, 5}, 7);
}

TEST(PapersGrades, ClassFiveAndSixLimits) {
  const auto limit = [](GearStandard standard, const GearSize& size, int grade,
                        GearDeviation deviation) {
    return gear_limits(standard, size, grade).rounded[static_cast<std::size_t>(deviation)];
  };
  const auto old = GearStandard::iso1328_1995;
  EXPECT_NEAR(limit(old, kPaper, 5, kTotal), 24.0, 1e-9);
  EXPECT_NEAR(limit(old, kPaper, 6, kTotal), 35.0, 1e-9);
  EXPECT_NEAR(limit(old, kPaper, 5, kSingle), 6.0, 1e-9);
  EXPECT_NEAR(limit(old, kPaper, 6, kSingle), 8.5, 1e-9);
  EXPECT_NEAR(limit(old, kPaper, 5, kProfile), 7.0, 1e-9);
  EXPECT_NEAR(limit(old, kPaper, 6, kProfile), 10.0, 1e-9);
  EXPECT_NEAR(limit(old, kNextRow, 5, kTotal), 25.0, 1e-9);
  const auto recent = GearStandard::iso1328_2013;
  EXPECT_NEAR(limit(recent, kPaper, 5, kTotal), 21.0, 1e-9);
  EXPECT_NEAR(limit(recent, kPaper, 6, kTotal), 29.0, 1e-9);
  EXPECT_NEAR(limit(recent, kPaper, 6, kProfile), 11.0, 1e-9);
}

TEST(GearGrade, CarriesWhatDecidedIt) {
  GearGrade g;
  ASSERT_TRUE(
      grade_gear(GearStandard::iso1328_1995, LimitRounding::rounded, kPaper, kSingle, 7.9, g).ok());
  EXPECT_EQ(g.row.diameter.over, 125.0);
  EXPECT_EQ(g.row.diameter.to, 280.0);
  EXPECT_EQ(g.row.module.over, 0.5);
  EXPECT_EQ(g.row.module.to, 2.0);
  EXPECT_EQ(g.row.width.over, 40.0);
  EXPECT_EQ(g.row.width.to, 80.0);
  EXPECT_EQ(g.value_um, 7.9);
  ASSERT_TRUE(
      grade_gear(GearStandard::iso1328_1995, LimitRounding::rounded, kPaper, kSingle, 500.0, g)
          .ok());
  EXPECT_FALSE(g.grade) << "worse than the last is none, not 13";
}

TEST(GearGradeRefusal, ValuesAndSizes) {
  GearGrade g;
  const auto reason = [&](const GearSize& size, double um) {
    return grade_gear(GearStandard::iso1328_1995, LimitRounding::rounded, size, kSingle, um, g)
        .reason;
  };
  EXPECT_EQ(reason(kPaper, 0.0), Reason::no_deviation);
  EXPECT_EQ(reason(kPaper, -3.0), Reason::no_deviation);
  EXPECT_EQ(reason(kPaper, std::nan("")), Reason::not_finite);
  EXPECT_EQ(reason({4.0, 2.0, 45.0}, 5.0), Reason::out_of_standard);
  EXPECT_EQ(reason({163.0, 0.4, 45.0}, 5.0), Reason::out_of_standard);
  EXPECT_EQ(reason({163.0, 2.0, 3.0}, 5.0), Reason::out_of_standard);
}

// EXC + EYC constant is a run-out e of the work: pitch arc e/cos α_t · sin(φ ∓ α_t), so F_p is
// 2 e/cos α_t on both sides and their phases differ by 2 α_t.
TEST(InternalPitch, OfARunOutGear) {
  constexpr double kRunOut = 0.007;
  const InternalGear gear = paper_gear();
  std::array<double, 2> phase{};
  for (const FlankSide side : kBothSides) {
    std::vector<double> position;
    double cosines = 0.0;
    double sines = 0.0;
    for (int k = 0; k < gear.teeth; ++k) {
      const double angle = 2.0 * kPi * k / gear.teeth;
      const SpaceFlankPoint at = space_flank_at(gear, side, gear.r, 0.0);
      const Vec3 n = axis_rotation(Axis::z, angle) * at.n;
      position.push_back(pitch_arc_towards_plus(gear, side, n.dot(Vec3(kRunOut, 0.0, 0.0))));
      cosines += position.back() * std::cos(angle);
      sines += position.back() * std::sin(angle);
    }
    PitchDeviations pitch;
    ASSERT_TRUE(evaluate_pitch(position, pitch).ok());
    EXPECT_NEAR(pitch.total, 2.0 * kRunOut / std::cos(gear.alpha_t), 1e-5);
    std::vector<double> single(position.size());
    ASSERT_TRUE(single_pitches(position, single).ok());
    double sum = 0.0;
    for (const double f : single)
      sum += f;
    EXPECT_NEAR(sum, 0.0, 1e-15) << "the circle closes";
    double half_turn = 0.0;
    ASSERT_TRUE(cumulative_pitch(position, 39, half_turn).ok());
    EXPECT_NEAR(half_turn, pitch.total, 1e-5);
    phase[side == FlankSide::left ? 0 : 1] = std::atan2(sines, cosines);
  }
  // The two flanks of a space also stand a space's width apart.
  const double apart = 2.0 * gear.alpha_t - 2.0 * space_half_angle(gear, gear.r);
  EXPECT_NEAR(std::abs(std::remainder(phase[0] - phase[1], 2.0 * kPi)), std::abs(apart), 0.05);
}

TEST(InternalProfile, MaterialThatGrowsTowardsTheTipIsPositive) {
  const InternalGear gear = paper_gear();
  std::vector<double> roll;
  std::vector<double> dn;
  for (int i = 0; i <= 40; ++i) {
    const double radius = gear.r_tip + 4.0 * i / 40.0;
    roll.push_back(roll_length(gear, radius));
    dn.push_back(0.006 * (gear.r + gear.module - radius));  // more at the tip
  }
  TraceDeviations d;
  ASSERT_TRUE(evaluate_internal_profile(roll, dn, d).ok());
  EXPECT_GT(d.slope, 0.0);
  EXPECT_NEAR(d.slope, d.total, 0.05 * d.total);
}

TEST(InternalDeviationRefusal, NamesWhatIsMissing) {
  std::vector<double> two{1.0, 2.0};
  TraceDeviations d;
  EXPECT_EQ(evaluate_internal_profile(two, two, d).reason, Reason::too_few_points);
  EXPECT_EQ(evaluate_internal_profile({}, {}, d).reason, Reason::too_few_points);
}

}  // namespace
}  // namespace volcomp::test
