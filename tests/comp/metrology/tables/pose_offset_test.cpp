// Holding the direction of a tool with two rotary axes: closed solutions and what happens where
// they lose their grip.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/machine/tilt.hpp"
#include "comp/metrology/tables/pose_offset.hpp"

namespace volcomp {
namespace {

constexpr double kError = 1e-4;

// The work turns about X (A) and then about Z (C), the tool moves along X, Y and Z.
MachineChain table_table(std::uint8_t orienting) {
  const auto joint = [](JointKind kind, Axis axis, std::uint8_t nc, char letter) {
    Joint j;
    j.kind = kind;
    j.axis = axis;
    j.nc_axis = nc;
    j.letter = letter;
    return j;
  };
  MachineDescription m;
  m.body_count = 6;
  m.body[1] = {1, joint(JointKind::rotary, Axis::x, 3, 'A'), {}};
  m.body[2] = {2, joint(JointKind::rotary, Axis::z, 4, 'C'), {}};
  m.body[3] = {1, joint(JointKind::prismatic, Axis::x, 0, 'X'), {}};
  m.body[4] = {4, joint(JointKind::prismatic, Axis::y, 1, 'Y'), {}};
  m.body[5] = {5, joint(JointKind::prismatic, Axis::z, 2, 'Z'), {}};
  m.work_body = 3;
  m.tool_body = 6;
  m.correcting = {0, 1, 2};
  m.correcting_count = 3;
  m.orienting = {3, 4};
  m.orienting_count = orienting;
  MachineChain chain;
  EXPECT_TRUE(MachineChain::build(m, chain).ok());
  return chain;
}

PoseOffset offset_at(const MachineChain& chain, const Pose& q, const Vec3& turn) {
  PoseOffset out;
  EXPECT_TRUE(pose_offset(chain, q, chain.tool_point(), Vec3::Zero(), turn, out).ok());
  return out;
}

// The table A turns against the tool: an error about X is taken away by A turning the same way.
TEST(PoseOffset, AboutAnAxisThatOrients) {
  const MachineChain chain = table_table(2);
  const Pose q{10, 20, 30, 0.5, 1.0};
  const PoseOffset o = offset_at(chain, q, {kError, 0, 0});
  EXPECT_NEAR(o.offset[3], kError, 1e-18);
  EXPECT_NEAR(o.offset[4], 0.0, 1e-18);
  EXPECT_LT(o.tilt_remainder.norm(), 1e-18);
  // The table turns under the tool, whose point goes with it: p moves by kError · (0, −30, 20)
  // against the work, and the slides bring that back. The tool has to follow the work.
  EXPECT_NEAR(o.offset[0], 0.0, 1e-15);
  // To second order: (20, 30) against where it would be with the work turned back.
  EXPECT_NEAR(o.offset[1], -kError * 30 + 0.5 * kError * kError * 20, 1e-10);
  EXPECT_NEAR(o.offset[2], kError * 20 + 0.5 * kError * kError * 30, 1e-10);
}

// With A at a, C stands at (0, −sin a, cos a): about Y only C helps, 1 / sin a times as much.
TEST(PoseOffset, SteepAxisTurnsMore) {
  const MachineChain chain = table_table(2);
  for (const double a : {0.2, 0.5, 1.0, -1.2}) {
    const PoseOffset o = offset_at(chain, {0, 0, 0, a, 0.3}, {0, kError, 0});
    EXPECT_NEAR(o.offset[4], -kError / std::sin(a), 1e-15) << a;
    EXPECT_NEAR(o.offset[3], 0.0, 1e-15) << a;
    EXPECT_LT(o.tilt_remainder.norm(), 1e-15) << a;
  }
}

// Round the tool's own axis nothing is seen.
TEST(PoseOffset, ErrorsAboutTheToolAreLeftAlone) {
  const PoseOffset o = offset_at(table_table(2), {1, 2, 3, 0.7, 0.3}, {0, 0, kError});
  for (const double offset : o.offset)
    EXPECT_NEAR(offset, 0.0, 1e-18);
  EXPECT_LT(o.tilt_remainder.norm(), 1e-18);
}

// Near a = 0 the turn of C fades to 0 in proportion to sin a instead of growing beyond all bounds,
// and nothing jumps where the fading begins.
TEST(PoseOffset, FadesWhereTheGripIsLost) {
  const MachineChain chain = table_table(2);
  const auto turn_of_c = [&](double sine) {
    return offset_at(chain, {0, 0, 0, std::asin(sine), 0}, {0, kError, 0}).offset[4];
  };
  EXPECT_NEAR(turn_of_c(0.0), 0.0, 1e-18);
  EXPECT_NEAR(turn_of_c(kMinTurning), -kError / kMinTurning, 1e-12);
  EXPECT_NEAR(turn_of_c(kMinTurning * (1 - 1e-9)), turn_of_c(kMinTurning * (1 + 1e-9)), 1e-11);
  for (double sine = -0.3; sine <= 0.3; sine += 0.001)
    EXPECT_LE(std::abs(turn_of_c(sine)), kError / kMinTurning * (1 + 1e-9)) << sine;
  EXPECT_NEAR(turn_of_c(0.05), -0.5 * kError / kMinTurning, 2e-2 * kError / kMinTurning);
}

// The axis that keeps its grip gives away a hundredth at most.
TEST(PoseOffset, TheOtherAxisGoesOnWhereOneIsLost) {
  const PoseOffset o = offset_at(table_table(2), {0, 0, 0, 0, 0}, {kError, kError, 0});
  EXPECT_NEAR(o.offset[3], kError, 0.01 * kError);
  EXPECT_NEAR(o.tilt_remainder.y(), kError, 1e-15) << "out of reach";
}

TEST(PoseOffset, OneAxisTakesWhatItCan) {
  const PoseOffset o = offset_at(table_table(1), {0, 0, 0, 0.4, 0}, {kError, kError, 0});
  EXPECT_NEAR(o.offset[3], kError, 1e-18);
  EXPECT_EQ(o.offset[4], 0.0);
  EXPECT_NEAR(o.tilt_remainder.y(), kError, 1e-18);
  EXPECT_NEAR(o.tilt_remainder.x(), 0.0, 1e-18);
}

TEST(PoseOffset, WithoutOrientingAxesItIsTheMotionOffset) {
  const MachineChain chain = table_table(0);
  const Pose q{1, 2, 3, 0.4, 0.5};
  const Vec3 error(0.01, -0.02, 0.03);
  PoseOffset pose;
  MotionOffset motion;
  ASSERT_TRUE(pose_offset(chain, q, chain.tool_point(), error, {1e-4, 0, 0}, pose).ok());
  ASSERT_TRUE(motion_offset(chain, q, chain.tool_point(), error, motion).ok());
  EXPECT_EQ(pose.offset, motion.offset);
  EXPECT_EQ(pose.tilt_remainder, Vec3(1e-4, 0, 0));
}

}  // namespace
}  // namespace volcomp
