// What traces, pitches, grades, maps and surfaces refuse, and the corners of their ranges.

#include <cmath>
#include <limits>
#include <vector>

#include "comp/machine/machine_chain.hpp"
#include "comp/metrology/faces/map_comparison.hpp"
#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_grade.hpp"
#include "comp/metrology/gears/gear_path.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "comp/metrology/tables/iso230.hpp"
#include "comp/strokes/spectral_line.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/l300g_machine.hpp"
#include "tests/oracle/paper_gear.hpp"

namespace volcomp::test {
namespace {

// --- traces, pitches and grades

TEST(TraceRefusal, UnequalListsAndNumbersThatAreNone) {
  const std::vector<double> at{1.0, 2.0, 3.0};
  const std::vector<double> two{0.0, 0.0};
  const std::vector<double> bad{0.0, kInfinite, 0.0};
  TraceDeviations figures;
  EXPECT_EQ(evaluate_trace(at, two, {0.0, 5.0}, figures).reason, Reason::length_mismatch);
  EXPECT_EQ(evaluate_trace(bad, at, {0.0, 5.0}, figures).where.index, 1);
  const Status s = evaluate_trace(at, bad, {0.0, 5.0}, figures);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 1);
}

TEST(Trace, OfOnePlaceHasNoSlope) {
  const std::vector<double> at{2.0, 2.0, 2.0};
  const std::vector<double> deviation{-1.0, 0.0, 4.0};
  TraceDeviations figures;
  ASSERT_TRUE(evaluate_trace(at, deviation, {0.0, 5.0}, figures).ok());
  EXPECT_NEAR(figures.slope, 0.0, 0.0);
  EXPECT_NEAR(figures.total, 5.0, 1e-15);
  EXPECT_NEAR(figures.form, 5.0, 1e-15);
}

TEST(PitchRefusal, OneToothAndInfinitePlaces) {
  const std::vector<double> one{0.0};
  std::vector<double> out{7.0};
  PitchDeviations whole;
  PartialPitch part;
  EXPECT_EQ(evaluate_pitch(one, whole).reason, Reason::too_few_points);
  EXPECT_EQ(single_pitches(one, {out.data(), 1}).reason, Reason::too_few_points);
  EXPECT_EQ(evaluate_partial_pitch(one, part).where.count, 1);
  EXPECT_EQ(out[0], 7.0);
  const std::vector<double> infinite{0.0, 1.0, -kInfinite};
  EXPECT_EQ(evaluate_partial_pitch(infinite, part).where.index, 2);
}

TEST(PitchRefusal, AnInfiniteMomentArm) {
  ToothAngles round;
  ASSERT_TRUE(ToothAngles::of(20, round).ok());
  EXPECT_STREQ(round.record(0, 1, 0.0, kInfinite).where.field, "moment_arm");
}

TEST(GearGrade, BeyondTheLastUnroundedLimitThereIsNone) {
  GearGrade grade;
  ASSERT_TRUE(grade_gear(GearStandard::iso1328_2013, LimitRounding::unrounded, {124.0, 4.0, 30.0},
                         GearDeviation::profile, 1e4, grade)
                  .ok());
  EXPECT_FALSE(grade.grade.has_value());
}

TEST(GearRow, BeyondTheTablesIsTheLast) {
  const GearRow row = gear_row({20000.0, 100.0, 5000.0});
  EXPECT_EQ(row.diameter.over, 8000.0);
  EXPECT_EQ(row.diameter.to, 10000.0);
  EXPECT_EQ(row.module.to, 70.0);
  EXPECT_EQ(row.width.to, 1000.0);
}

TEST(Iso230Refusal, DeviationsThatAreFewerThanTargets) {
  const std::vector<double> three{0.0, 1.0, 2.0};
  const std::vector<double> two{0.0, 0.0};
  Iso230Figures figures;
  EXPECT_EQ(iso230_figures({three, two}, {three, three}, figures).reason, Reason::too_few_points);
  EXPECT_EQ(iso230_figures({three, three}, {three, two}, figures).reason, Reason::too_few_points);
  EXPECT_TRUE(iso230_figures({three, three}, {three, three}, figures).ok());
}

TEST(SpectralLine, OfNothingIsZeroAndGapsAreLeftOut) {
  EXPECT_EQ(spectral_line(OrderLine()).amplitude, 0.0);
  EXPECT_EQ(spectral_line(TimeLine()).amplitude, 0.0);
  // Eight slots of which every second was never cut: order 1 is still known.
  std::vector<NodeSums> slots(8);
  for (std::size_t k = 0; k < slots.size(); k += 2)
    slots[k].add(3.0 * std::cos(2.0 * kPi * static_cast<double>(k) / 8.0));
  EXPECT_NEAR(order_around(slots, 1).amplitude, 3.0, 1e-14);
}

// --- maps

std::vector<SurfacePoint> points_at(const Vec3& place) {
  return std::vector<SurfacePoint>(kGridCells, SurfacePoint{place, Vec3::UnitX()});
}

ErrorMap constant_map(double value) {
  ErrorMap map;
  for (std::size_t i = 0; i < kGridCells; ++i)
    map.set(i / kGridColumns, i % kGridColumns, value);
  return map;
}

TEST(BadComparison, AFlankWithoutAMapOrWithANominalPointNowhere) {
  std::vector<SurfacePoint> nominal = points_at({1.0, 2.0, 3.0});
  const ErrorMap map = constant_map(1.0);
  FrameShare share;
  const std::array<ComparedFlank, 1> without{{{nullptr, nominal}}};
  EXPECT_EQ(frame_share(without, kWholeFrame, share).reason, Reason::length_mismatch);
  nominal[17].point.y() = kNan;
  const std::array<ComparedFlank, 1> nowhere{{{&map, nominal}}};
  const Status s = frame_share(nowhere, kWholeFrame, share);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 17);
}

TEST(BadComparison, NothingMeasuredAndNothingLookedFor) {
  const std::vector<SurfacePoint> nominal = points_at({1.0, 2.0, 3.0});
  const ErrorMap empty;
  FrameShare share;
  const std::array<ComparedFlank, 1> flanks{{{&empty, nominal}}};
  const Status s = frame_share(flanks, FrameMotions{}, share);
  EXPECT_EQ(s.reason, Reason::too_few_points);
  EXPECT_EQ(s.where.count, 0);
}

// Without a lever a turn shows nothing; without a difference there is nothing to explain.
TEST(FrameShare, OfPointsAtTheOriginIsTheirShift) {
  const std::vector<SurfacePoint> nominal = points_at(Vec3::Zero());
  const ErrorMap two = constant_map(2.0);
  const ErrorMap none = constant_map(0.0);
  FrameShare share;
  const std::array<ComparedFlank, 1> shifted{{{&two, nominal}}};
  ASSERT_TRUE(frame_share(shifted, kWholeFrame, share).ok());
  EXPECT_EQ(share.rank, 1);
  EXPECT_NEAR(share.shift.x(), 2.0, 1e-12);
  EXPECT_NEAR(share.turn.norm(), 0.0, 1e-12);
  EXPECT_NEAR(share.explained, 1.0, 1e-12);
  const std::array<ComparedFlank, 1> same{{{&none, nominal}}};
  ASSERT_TRUE(frame_share(same, kWholeFrame, share).ok());
  EXPECT_EQ(share.explained, 0.0);
}

// --- machine and gear

TEST(MachineRefusal, AnOffsetThatTurnsByNoNumber) {
  MachineDescription d = l300g_machine({}, {});
  d.body[0].joint.orientation[4] = kNan;
  MachineChain chain;
  const Status s = MachineChain::build(d, chain);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.body, 1);
}

TEST(SwingArm, ReachesNoHeightThatIsNoNumberOrBeyondItsLength) {
  const SwingArm arm;
  double B = 7.0;
  EXPECT_EQ(arm_angle(arm, kNan, B).reason, Reason::not_finite);
  EXPECT_EQ(arm_angle(arm, 1.01 * arm.length, B).reason, Reason::out_of_reach);
  EXPECT_EQ(B, 7.0);
  const InvoluteGear gear = gear_of_the_paper();
  Pose pose{};
  const FlankTouch touch{{FlankSide::left, 0}, 2.0 * arm.length, 0.0};
  EXPECT_EQ(touch_pose(arm, {}, gear, PathStyle::generate, touch, 1.5, pose).reason,
            Reason::out_of_reach);
}

TEST(InvoluteGearRefusal, SizesThatAreNoneAreNamed) {
  const auto field = [](auto change) {
    InvoluteGear gear = gear_of_the_paper();
    change(gear);
    const Status s = derive(gear);
    return s.ok() ? "accepted" : s.where.field;
  };
  EXPECT_STREQ(field([](InvoluteGear& g) { g.teeth = 1001; }), "teeth");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.module = kInfinite; }), "module");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.pressure_angle = 0.0; }), "pressure_angle");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.pressure_angle = 0.8; }), "pressure_angle");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.width = 0.0; }), "width");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.width = kInfinite; }), "width");
  EXPECT_STREQ(field([](InvoluteGear& g) { g.tip_diameter = kInfinite; }), "tip_diameter");
}

TEST(InvoluteGearRefusal, PointsThatAreNowhereHaveNoDistance) {
  const InvoluteGear gear = gear_of_the_paper();
  FlankDistance d;
  EXPECT_EQ(distance_from_flank(gear, {}, {kNan, 60.0}, 0.0, d).reason, Reason::not_finite);
  EXPECT_EQ(distance_from_flank(gear, {}, {60.0, 10.0}, kInfinite, d).reason, Reason::not_finite);
}

}  // namespace
}  // namespace volcomp::test
