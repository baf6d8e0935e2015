// Verdicts on touches of face gears, one for every kind of bad input.

#include "comp/probe/face_touch.hpp"

#include <limits>

#include "tests/not_numbers.hpp"
#include "tests/oracle/face_gears.hpp"

namespace volcomp::test {
namespace {

constexpr FaceProbing kProbing{0.3, 0.1};

class FaceTouchTest : public ::testing::Test {
 protected:
  // The ball that far from a node of the commanded flank.
  [[nodiscard]] Vec3 ball(const FaceGridNode& node, double distance) const {
    const FacePoint on = on_flank(node, flank);
    return on.point + distance * on.normal;
  }
  [[nodiscard]] FaceTouch judge(const Vec3& q, const FaceProbing& probing = kProbing) const {
    return judge_touch(gear, flank, probing, q);
  }

  FaceGear gear = face_gear_of_table_3();
  FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  FaceFlank flank = flank_of(gear, -1, 40);
};

TEST_F(FaceTouchTest, OfTheCommandedFlank) {
  for (const auto& row : grid) {
    for (const FaceGridNode& node : row) {
      const FaceTouch touch = judge(ball(node, 0.305));
      EXPECT_EQ(touch.verdict, Reason::ok);
      EXPECT_NEAR(touch.deviation, 0.005, 3e-6);  // excess; the relief in closed form
      EXPECT_GT(touch.other, 1.0);
    }
  }
}

TEST_F(FaceTouchTest, TheGateIsInclusiveOnBothSides) {
  const FaceGridNode& node = grid[4][7];
  EXPECT_EQ(judge(ball(node, 0.3999)).verdict, Reason::ok);
  EXPECT_EQ(judge(ball(node, 0.2001)).verdict, Reason::ok);
  EXPECT_EQ(judge(ball(node, 0.4001)).verdict, Reason::nothing_touched);
  EXPECT_EQ(judge(ball(node, 0.1999)).verdict, Reason::ball_in_metal);
}

TEST_F(FaceTouchTest, OfTheOppositeFlank) {
  const FacePoint on = on_flank(grid[4][7], flank_of(gear, 1, 40));
  const FaceTouch touch = judge(on.point + 0.3 * on.normal);
  EXPECT_EQ(touch.verdict, Reason::opposite_flank);
  EXPECT_NEAR(touch.other, 0.3, 1e-12);
}

TEST_F(FaceTouchTest, ABallTooBigForTheSlot) {
  const Vec3 q = from_flank(flank, {172.0, 0.0, 52.0});
  const double to_both = judge(q).distance;
  EXPECT_NEAR(judge(q).other, to_both, 1e-12);
  EXPECT_EQ(judge(q, {to_both, 0.1}).verdict, Reason::two_flanks);
}

TEST_F(FaceTouchTest, InTheMetal) {
  EXPECT_EQ(judge(ball(grid[4][7], -0.5)).verdict, Reason::ball_in_metal);
  // The ball of the next slot: behind the flank of this one.
  const FacePoint next = on_flank(grid[4][7], flank_of(gear, -1, 39));
  EXPECT_EQ(judge(next.point + 0.3 * next.normal).verdict, Reason::ball_in_metal);
}

TEST_F(FaceTouchTest, InTheAir) {
  EXPECT_EQ(judge(from_flank(flank, {172.0, 0.0, 50.0})).verdict, Reason::nothing_touched);
}

TEST_F(FaceTouchTest, BeyondTheTipTheFlankDoesNotCount) {
  const FacePoint on = face_point(gear, flank, {0.15, 0.42});
  ASSERT_LT(on.point.z(), gear.z_tip);
  const double behind = relief_at(gear.relief, on.point.z()).depth;
  const FaceTouch touch = judge(on.point + (0.3 - behind) * on.normal);
  EXPECT_EQ(touch.verdict, Reason::bad_point);
  EXPECT_EQ(touch.foot.reason, Reason::above_tip);
}

// A relieved tip is still a flank: the foot is judged before the relief is added.
TEST_F(FaceTouchTest, ARelievedTipIsAFlankDownToTheEdge) {
  FaceGridPlan plan = face_grid_of_table_3();
  plan.tip_depths[0] = gear.z_tip + 0.03;
  const FaceTouch touch = judge(ball(grid_of(gear, plan)[0][7], 0.3));
  EXPECT_EQ(touch.verdict, Reason::ok);
  EXPECT_GT(touch.distance - touch.foot.distance, 0.05);
}

TEST_F(FaceTouchTest, UnusablePoints) {
  const FaceTouch touch = judge({kNan, 0.0, 50.0});
  EXPECT_EQ(touch.verdict, Reason::bad_point);
  EXPECT_EQ(touch.foot.reason, Reason::not_finite);
  EXPECT_TRUE(std::isnan(touch.distance));
  EXPECT_TRUE(std::isnan(touch.deviation));
  EXPECT_EQ(judge({100.0, 0.0, 50.0}).foot.reason, Reason::inside_gear_base);
  const Vec3 good = ball(grid[4][7], 0.3);
  for (const FaceProbing& probing :
       {FaceProbing{0.0, 0.1}, FaceProbing{-0.3, 0.1}, FaceProbing{0.3, 0.0},
        FaceProbing{kNan, 0.1}, FaceProbing{0.3, kNan}})
    EXPECT_EQ(judge(good, probing).verdict, Reason::bad_point);
}

}  // namespace
}  // namespace volcomp::test
