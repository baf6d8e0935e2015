// Pitch of a face gear: rounds whose deviations are known beforehand.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/face_gear.hpp"

namespace volcomp::test {
namespace {

constexpr int kTeeth = 86;
constexpr double kPitchRadius = 172.0;      // mm
constexpr double kUm = 1e3 * kPitchRadius;  // rad to µm along the pitch circle

// The axis of the gear 5 µm beside that of its teeth.
std::vector<double> eccentric_round(double um = 5.0) {
  std::vector<double> angle;
  for (int k = 0; k < kTeeth; ++k)
    angle.push_back(um / kUm * std::sin(2.0 * kPi * k / kTeeth));
  return angle;
}

// The same, read-only.
const std::vector<double>& eccentric() {
  static const std::vector<double> round = eccentric_round();
  return round;
}

TEST(FacePitch, OfAPerfectGearIsZero) {
  const std::vector<double> round(kTeeth, 0.0);
  PitchDeviations d;
  ASSERT_TRUE(evaluate_pitch(round, d, kUm).ok());
  EXPECT_EQ(d.total, 0.0);
  EXPECT_EQ(d.single, 0.0);
}

TEST(FacePitch, OfAnEccentricGear) {
  const std::vector<double> round = eccentric_round();
  PitchDeviations d;
  ASSERT_TRUE(evaluate_pitch(round, d, kUm).ok());
  EXPECT_NEAR(d.total, 9.993, 5e-4);
  EXPECT_NEAR(d.single, 0.365, 5e-4);
  double ten = 0.0;
  ASSERT_TRUE(cumulative_pitch(round, 10, ten, kUm).ok());
  EXPECT_NEAR(ten, 3.572, 5e-4);
}

TEST(FacePitch, OneDisplacedToothIsOnePitchUpAndOneDown) {
  std::vector<double> round(kTeeth, 0.0);
  round[40] = 10.0 / kUm;
  PitchDeviations d;
  ASSERT_TRUE(evaluate_pitch(round, d, kUm).ok());
  EXPECT_NEAR(d.single_signed, 10.0, 1e-9);
  EXPECT_EQ(d.tooth, 40U);
  EXPECT_NEAR(d.total, 10.0, 1e-9);
  std::vector<double> single(kTeeth);
  ASSERT_TRUE(single_pitches(round, single, kUm).ok());
  EXPECT_NEAR(single[40], 10.0, 1e-9);
  EXPECT_NEAR(single[41], -10.0, 1e-9);
  EXPECT_NEAR(std::accumulate(single.begin(), single.end(), 0.0), 0.0, 1e-9);  // closed
}

// A sum from tooth 1 only, as printed, would miss a step that lies elsewhere.
TEST(FacePitch, CumulativePitchIsLookedForAllAround) {
  std::vector<double> round(kTeeth, 0.0);
  for (std::size_t k = 0; k < 5; ++k)
    round[k] = round[kTeeth - 1 - k] = 4.0 / kUm;  // across the end of the list
  round[kTeeth - 6] = -3.0 / kUm;
  double sum = 0.0;
  ASSERT_TRUE(cumulative_pitch(round, 10, sum, kUm).ok());
  EXPECT_NEAR(sum, 7.0, 1e-9);
}

TEST(FacePitch, CumulativePitchEndsBeforeTheRoundCloses) {
  EXPECT_EQ(largest_pitch_span(86), 10U);
  EXPECT_EQ(largest_pitch_span(5), 1U);
  double sum = 5.0;
  const Status s = cumulative_pitch(eccentric(), 86, sum, kUm);
  EXPECT_EQ(s.reason, Reason::bad_setting);
  EXPECT_STREQ(s.where.field, "k");
  EXPECT_EQ(cumulative_pitch(eccentric(), 0, sum, kUm).reason, Reason::bad_setting);
  EXPECT_EQ(sum, 5.0);
}

// Normal to the flank everything is smaller by C/r₁, the cosine of the pressure angle.
TEST(FacePitch, InTheDirectionOfTheNormalItIsTheCosineOfThePressureAngle) {
  const reference::FaceGear gear;
  PitchDeviations arc;
  PitchDeviations normal;
  ASSERT_TRUE(evaluate_pitch(eccentric(), arc, kUm).ok());
  ASSERT_TRUE(evaluate_pitch(eccentric(), normal, kUm * gear.arm() / kPitchRadius).ok());
  EXPECT_NEAR(normal.total / arc.total, std::cos(gear.pressure_angle), 1e-12);
}

// Ball centres on displaced teeth, each touched at another place: the angles come back exactly.
TEST(ToothAngles, AreThoseOfTheTeethWhereverTheyWereTouched) {
  const reference::FaceGear gear;
  const auto grid = reference::table_3_grid(gear);
  const std::vector<double> truth = eccentric_round();
  constexpr double kBall = 0.5;
  ToothAngles round;
  ASSERT_TRUE(ToothAngles::of(kTeeth, round).ok());
  for (int k = 0; k < kTeeth; ++k) {
    const SurfacePoint& p = grid[static_cast<std::size_t>(k + 9)];
    const Vec3 touched = Eigen::AngleAxisd(truth[static_cast<std::size_t>(k)], Vec3::UnitZ()) *
                         Vec3(p.point + kBall * p.normal);
    const double deviation = reference::distance(gear, touched, 1, 0) - kBall;
    ASSERT_TRUE(round.record(k, 1, deviation, gear.arm()).ok());
  }
  for (std::size_t k = 0; k < round.angles().size(); ++k)
    EXPECT_NEAR(round.angles()[k], truth[k], 1e-12);
}

// The scale of a turntable with 1.8" steps is 1.5 µm at the pitch circle, in every pitch.
TEST(FacePitch, CannotBeFinerThanTheTurntable) {
  const double step = 1.8 / 3600.0 * kPi / 180.0;
  EXPECT_NEAR(step * kUm, 1.50, 0.005);
  std::vector<double> round = eccentric_round();
  for (double& angle : round)
    angle = step * std::round(angle / step);
  PitchDeviations d;
  ASSERT_TRUE(evaluate_pitch(round, d, kUm).ok());
  EXPECT_NEAR(d.single, 1.50, 0.005);  // instead of 0.365
  EXPECT_NEAR(d.total, 9.993, 1.50);
}

// --- gaps

TEST(PartialPitch, IsThatOfNeighboursThatAreThereAndHasNoTotal) {
  std::vector<double> round = eccentric_round();
  round[21] = round[22] = round[60] = kNan;
  PartialPitch p;
  ASSERT_TRUE(evaluate_partial_pitch(round, p, kUm).ok());
  EXPECT_EQ(p.no_total, Reason::partial);
  EXPECT_EQ(p.missing, 3U);
  EXPECT_EQ(p.pitches, 81U);
  EXPECT_NEAR(p.single, 0.365, 5e-4);
  PitchDeviations kept;
  kept.total = 7.0;
  const Status s = evaluate_pitch(round, kept, kUm);
  EXPECT_EQ(s.reason, Reason::incomplete);
  EXPECT_EQ(s.where.index, 21);
  EXPECT_EQ(s.where.count, 3);
  EXPECT_EQ(kept.total, 7.0);
  double sum = 0.0;
  EXPECT_EQ(cumulative_pitch(round, 3, sum, kUm).reason, Reason::incomplete);
  std::vector<double> single(kTeeth);
  ASSERT_TRUE(single_pitches(round, single, kUm).ok());
  EXPECT_TRUE(std::isnan(single[23]));
  EXPECT_FALSE(std::isnan(single[24]));
}

TEST(PartialPitch, OfACompleteRoundWithholdsNothing) {
  PartialPitch p;
  ASSERT_TRUE(evaluate_partial_pitch(eccentric(), p, kUm).ok());
  EXPECT_EQ(p.no_total, Reason::ok);
  EXPECT_EQ(p.pitches, 86U);
}

TEST(PartialPitch, WithoutNeighboursThereIsNone) {
  std::vector<double> round(kTeeth, kNan);
  round[3] = round[7] = 0.0;
  PartialPitch p;
  EXPECT_EQ(evaluate_partial_pitch(round, p).reason, Reason::too_few_points);
}

// --- refusals

TEST(BadPitch, TeethSidesAndNumbersThatCannotBe) {
  ToothAngles round;
  for (const int teeth : {-1, 0, 1, 257})
    EXPECT_EQ(ToothAngles::of(teeth, round).reason, Reason::bad_setting) << teeth;
  ASSERT_TRUE(ToothAngles::of(256, round).ok());
  ASSERT_TRUE(ToothAngles::of(kTeeth, round).ok());
  const auto field = [&](int tooth, int side, double deviation, double arm) {
    const Status s = round.record(tooth, side, deviation, arm);
    return s.reason == Reason::bad_setting ? s.where.field : code(s.reason);
  };
  EXPECT_STREQ(field(86, 1, 0.0, 156.0), "tooth");
  EXPECT_STREQ(field(-1, 1, 0.0, 156.0), "tooth");
  EXPECT_STREQ(field(0, 0, 0.0, 156.0), "side");
  EXPECT_STREQ(field(0, 1, 0.0, 0.0), "moment_arm");
  EXPECT_STREQ(field(0, 1, kNan, 156.0), "not_finite");
  EXPECT_TRUE(std::isnan(round.angles()[0]));
  std::vector<double> infinite(kTeeth, 0.0);
  infinite[12] = -std::numeric_limits<double>::infinity();
  PitchDeviations d;
  EXPECT_EQ(evaluate_pitch(infinite, d).where.index, 12);
  std::vector<double> single(kTeeth - 1);
  EXPECT_EQ(single_pitches(eccentric(), single).reason, Reason::length_mismatch);
}

}  // namespace
}  // namespace volcomp::test
