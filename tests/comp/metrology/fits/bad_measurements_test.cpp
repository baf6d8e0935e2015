// Bad measurements are refused with a reason and its place, and everything stays as it was.

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/fits/effective_radius.hpp"
#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/involute_gear.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/axis_identification.hpp"
#include "tests/oracle/l300g_machine.hpp"
#include "tests/oracle/paper_gear.hpp"

namespace volcomp::test {
namespace {

// --- probe calibration

struct Touches {
  std::vector<double> y;
  std::vector<double> z;
  CircleFit fit;
};

Touches arc(double radius, double degrees) {
  Touches t;
  for (int i = 0; i <= 40; ++i) {
    const double a = (i / 40.0 - 0.5) * degrees * kPi / 180.0;
    t.y.push_back(168.8 + radius * std::cos(a));
    t.z.push_back(radius * std::sin(a));
  }
  EXPECT_TRUE(fit_circle(t.y, t.z, t.fit).ok());
  return t;
}

constexpr MandrelRules kRules{15.0, 1.5};

TEST(EffectiveRadius, IsTheCircleLessTheMandrel) {
  const Touches t = arc(16.4935, 160.0);
  EffectiveRadius radius;
  ASSERT_TRUE(effective_radius(t.y, t.z, t.fit, kRules, radius).ok());
  EXPECT_NEAR(radius.rc, 1.4935, 1e-9);
  EXPECT_NEAR(radius.arc, 160.0 * kPi / 180.0, 1e-9);
  EXPECT_FALSE(radius.short_arc);
}

// Eq. 9 as printed takes the ball away and leaves the mandrel.
TEST(EffectiveRadius, PrintedEquationIsRefused) {
  const Touches t = arc(16.4935, 160.0);
  EffectiveRadius kept{1.4, 1.0, false};
  const Status s = effective_radius(t.y, t.z, t.fit, {1.5, 1.5}, kept);
  EXPECT_EQ(s.reason, Reason::implausible_radius);
  EXPECT_NEAR(s.where.value, 14.9935, 1e-9);
  EXPECT_EQ(kept.rc, 1.4);
}

TEST(EffectiveRadius, ACircleSmallerThanTheMandrelIsRefused) {
  const Touches t = arc(14.9, 160.0);
  EffectiveRadius radius;
  EXPECT_EQ(effective_radius(t.y, t.z, t.fit, kRules, radius).reason, Reason::implausible_radius);
}

TEST(EffectiveRadius, NamesThePointThatSpoiltTheFit) {
  Touches t = arc(16.4935, 160.0);
  t.y[7] += 0.3;
  ASSERT_TRUE(fit_circle(t.y, t.z, t.fit).ok());
  EffectiveRadius radius;
  const Status s = effective_radius(t.y, t.z, t.fit, kRules, radius);
  EXPECT_EQ(s.reason, Reason::residuals_too_large);
  EXPECT_EQ(s.where.index, 7);
  EXPECT_NEAR(s.where.value, t.fit.rms, 0.0);
}

TEST(EffectiveRadius, AShortArcIsMarkedAndItsUncertaintyShows) {
  const Touches t = arc(16.4935, 25.0);
  EffectiveRadius radius;
  ASSERT_TRUE(effective_radius(t.y, t.z, t.fit, kRules, radius).ok());
  EXPECT_TRUE(radius.short_arc);
  EXPECT_GT(t.fit.cofactors(2, 2), 50.0 * arc(16.4935, 160.0).fit.cofactors(2, 2));
}

// --- identification

constexpr std::size_t kNodes = 2;

struct AxisOfX {
  MachineChain chain;
  std::vector<double> nodes{0.0, 100.0};
  std::vector<Vec3> position{{-60, -60, 0}, {60, -60, 0}, {60, 60, 0},
                             {-60, 60, 0},  {0, 0, 80},   {50, 0, 90}};
  std::vector<Vec3> measured;
  std::vector<ErrorMotion> motion{kNodes, ErrorMotion::Constant(7.0)};

  AxisOfX() {
    EXPECT_TRUE(MachineChain::build(l300g_machine({}, {}), chain).ok());
    const Joint& x = chain.axis(0);
    for (const double q : nodes) {
      const Frame moving = joint_offset(x) * joint_motion(x, q);
      for (const Vec3& p : position)
        measured.push_back(moving.apply(p));
    }
  }
  Status identify(double sigma = 0.0) {
    return identify_axis({}, chain.axis(0), {nodes, position, measured, sigma},
                         {motion.data(), motion.size()});
  }
  [[nodiscard]] bool untouched() const {
    return motion[0] == ErrorMotion::Constant(7.0) && motion[1] == motion[0];
  }
};

TEST(BadTargets, MetresOrDegreesAreNoMillimetres) {
  AxisOfX axis;
  axis.measured[8] *= 1e-3;
  const Status s = axis.identify();
  EXPECT_EQ(s.reason, Reason::unit_suspected);
  EXPECT_EQ(s.where.target, 1);
  EXPECT_EQ(s.where.index, 2);
  EXPECT_TRUE(axis.untouched());
}

TEST(BadTargets, AnOutlierIsNamed) {
  AxisOfX axis;
  axis.measured[9].z() += 0.05;
  const Status s = axis.identify(0.3e-3);
  EXPECT_EQ(s.reason, Reason::outlier);
  EXPECT_EQ(s.where.target, 1);
  EXPECT_TRUE(axis.untouched());
  EXPECT_TRUE(axis.identify().ok()) << "nobody said how good the targets are";
}

TEST(BadTargets, ThreeOnALineAreFiveOfSix) {
  AxisOfX axis;
  axis.position = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};
  axis.measured = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {100, 0, 0}, {110, 0, 0}, {120, 0, 0}};
  const Joint bare{JointKind::prismatic, Axis::x, 1, Branch::tool, 0, 'X'};
  const Status s = identify_axis({}, bare, {axis.nodes, axis.position, axis.measured},
                                 {axis.motion.data(), axis.motion.size()});
  EXPECT_EQ(s.reason, Reason::rank_deficient);
  EXPECT_EQ(s.where.count, 5);
  EXPECT_TRUE(axis.untouched());
}

TEST(BadTargets, OneNodeWithFewerTargetsIsRefused) {
  AxisOfX axis;
  axis.measured.pop_back();
  EXPECT_EQ(axis.identify().reason, Reason::length_mismatch);
}

// X carries Y carries B; A stands by itself.
TEST(Order, AnAxisThatHasMovedMustBeKnown) {
  const AxisOfX axis;
  const Pose reference{};
  const Pose moved{100.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(check_order(axis.chain, 0, 0, moved, reference).ok());
  const Status s = check_order(axis.chain, 2, 0, moved, reference);
  EXPECT_EQ(s.reason, Reason::parent_not_identified);
  EXPECT_EQ(s.where.axis, 'X');
  EXPECT_TRUE(check_order(axis.chain, 2, 0, reference, reference).ok()) << "nothing has moved";
  EXPECT_TRUE(check_order(axis.chain, 2, 0b001, moved, reference).ok()) << "X is known";
  EXPECT_TRUE(check_order(axis.chain, 3, 0, moved, reference).ok()) << "A does not hang on X";
}

// --- gear

TEST(BadFlank, ThePointOfAnotherToothIsRefused) {
  const InvoluteGear gear = gear_of_the_paper();
  const FlankPoint other = flank_at(gear, {FlankSide::left, 1}, 20.0, 0.0);
  double deviation = 7.0;
  double roll = 7.0;
  const Vec3 point(0.0, other.point.y, other.point.z);
  const Status s = deviation_from_flank(gear, {FlankSide::left, 0}, point, deviation, roll);
  EXPECT_EQ(s.reason, Reason::wrong_flank);
  EXPECT_NEAR(std::abs(s.where.deviation), 2.0 * kPi * gear.r_b / gear.teeth, 1e-9) << "base pitch";
  EXPECT_EQ(deviation, 7.0);
  EXPECT_TRUE(deviation_from_flank(gear, {FlankSide::left, 1}, point, deviation, roll).ok());
  EXPECT_NEAR(deviation, 0.0, 1e-12);
  EXPECT_NEAR(roll, 20.0, 1e-9);
}

TEST(BadFlank, InsideTheBaseCircleThereIsNone) {
  const InvoluteGear gear = gear_of_the_paper();
  double deviation = 0.0;
  double roll = 0.0;
  EXPECT_EQ(deviation_from_flank(gear, {}, Vec3(0.0, 58.0, 0.0), deviation, roll).reason,
            Reason::inside_base_circle);
}

TEST(BadPitch, MissingTeethAreNamedAndThereIsNoFp) {
  std::vector<double> position(31, 0.0);
  position[4] = position[20] = kNan;
  PitchDeviations kept;
  kept.total = 9.0;
  const Status s = evaluate_pitch(position, kept);
  EXPECT_EQ(s.reason, Reason::incomplete);
  EXPECT_EQ(s.where.index, 4);
  EXPECT_EQ(s.where.count, 2);
  EXPECT_EQ(kept.total, 9.0);
}

TEST(BadTrace, TooFewPointsInTheRangeAreCounted) {
  const std::vector<double> at{1.0, 2.0, 3.0, 10.0};
  const std::vector<double> deviation{0.0, 0.0, 0.0, 0.0};
  TraceDeviations figures;
  const Status s = evaluate_trace(at, deviation, {2.5, 10.5}, figures);
  EXPECT_EQ(s.reason, Reason::too_few_points);
  EXPECT_EQ(s.where.count, 2);
}

}  // namespace
}  // namespace volcomp::test
