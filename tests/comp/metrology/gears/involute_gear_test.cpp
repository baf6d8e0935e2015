// Flanks of the master gear of docs/papers/l300g.md and of a helical one.

#include <cmath>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/gears/involute_gear.hpp"
#include "tests/oracle/paper_gear.hpp"

namespace volcomp::test {
namespace {

TEST(InvoluteGear, FiguresOfThePapersGear) {
  const InvoluteGear g = gear_of_the_paper();
  EXPECT_NEAR(g.r, 62.0, 1e-12);
  EXPECT_NEAR(g.r_b, 58.260942489, 1e-9);
  EXPECT_NEAR(g.eta_b, 0.065575233, 1e-9);
  EXPECT_NEAR(g.roll_begin, 9.510031, 1e-6);
  EXPECT_NEAR(g.roll_end, 31.010685, 1e-6);
}

TEST(InvoluteGear, PointsOfAFlankHaveNoDistanceFromIt) {
  for (const double beta : {0.0, 0.3, -0.3}) {
    const InvoluteGear g = gear_of_the_paper(beta);
    for (const FlankSide side : {FlankSide::left, FlankSide::right}) {
      for (const int tooth : {0, 7, 30}) {
        for (double s = 1.0; s < 31.0; s += 2.5) {
          const Flank flank{side, tooth};
          const double x = 0.8 * s - 10.0;
          const FlankPoint on = flank_at(g, flank, s, x);
          const Transverse off{on.point.y + 0.3 * on.normal.y, on.point.z + 0.3 * on.normal.z};
          FlankDistance d;
          ASSERT_TRUE(distance_from_flank(g, flank, on.point, x, d).ok());
          EXPECT_NEAR(d.distance, 0.0, 1e-13);
          EXPECT_NEAR(d.roll_length, s, 1e-12);
          ASSERT_TRUE(distance_from_flank(g, flank, off, x, d).ok());
          EXPECT_NEAR(d.distance, 0.3, 1e-12);
          EXPECT_NEAR(d.foot.y, on.point.y, 1e-11);
          EXPECT_NEAR(d.foot.z, on.point.z, 1e-11);
        }
      }
    }
  }
}

TEST(InvoluteGear, ABallThatTouchesHasNoDeviation) {
  const InvoluteGear g = gear_of_the_paper();
  for (const FlankSide side : {FlankSide::left, FlankSide::right}) {
    for (double s = 5.0; s < 31.0; s += 4.0) {
      const Flank flank{side, 3};
      const Transverse centre = ball_centre_at(g, flank, s, 1.4935);
      FlankDistance d;
      ASSERT_TRUE(distance_from_flank(g, flank, centre, 0.0, d).ok());
      EXPECT_NEAR(deviation_of(g, d.distance, 1.4935), 0.0, 1e-13);
      EXPECT_NEAR(d.roll_length, s, 1e-12);
    }
  }
}

// A helical flank is a screw surface: the normal distance in space is the transverse one times
// cos β_b. Checked by brute force over the surface.
TEST(InvoluteGear, NormalDistanceOfAHelicalFlank) {
  const InvoluteGear g = gear_of_the_paper(0.35);
  const Flank flank{FlankSide::left, 0};
  const FlankPoint on = flank_at(g, flank, 20.0, 0.0);
  constexpr double kOff = 0.05;
  const Transverse point{on.point.y + kOff * on.normal.y, on.point.z + kOff * on.normal.z};
  FlankDistance d;
  ASSERT_TRUE(distance_from_flank(g, flank, point, 0.0, d).ok());
  double least = 1.0;
  for (double s = 19.8; s < 20.2; s += 0.0005) {
    for (double x = -0.1; x < 0.1; x += 0.0005) {
      const FlankPoint p = flank_at(g, flank, s, x);
      least = std::min(least, std::hypot(p.point.y - point.y, p.point.z - point.z, x));
    }
  }
  EXPECT_NEAR(deviation_of(g, d.distance, 0.0), least, 1e-5);
}

TEST(InvoluteGear, UnusableFiguresAreNamed) {
  const auto refused = [](auto change) {
    InvoluteGear g = gear_of_the_paper();
    change(g);
    const Status status = derive(g);
    EXPECT_FALSE(status.ok());
    return std::string(status.where.field);
  };
  EXPECT_EQ(refused([](InvoluteGear& g) { g.teeth = 2; }), "teeth");
  EXPECT_EQ(refused([](InvoluteGear& g) { g.module = NAN; }), "module");
  EXPECT_EQ(refused([](InvoluteGear& g) { g.pressure_angle = 20.0; }), "pressure_angle");
  EXPECT_EQ(refused([](InvoluteGear& g) { g.helix_angle = 15.0; }), "helix_angle");
  EXPECT_EQ(refused([](InvoluteGear& g) { g.tip_diameter = 66.0; }), "tip_diameter");
}

}  // namespace
}  // namespace volcomp::test
