// The lower-body array and every reason to refuse a machine.

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "comp/machine/xyfz.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

Status check(std::vector<std::uint8_t> lower) {
  return check_lower_body({lower.data(), lower.size()});
}

MachineDescription xyfz() {
  return xyfz_optimised({{-200, -150, 180}, {20, 520, 1130}, {30, -380, -300}});
}

Status build(const MachineDescription& machine) {
  MachineChain chain;
  return MachineChain::build(machine, chain);
}

TEST(LowerBodyArray, AcceptsEveryTree) {
  EXPECT_TRUE(check({0}).ok());
  EXPECT_TRUE(check({0, 1, 2, 3}).ok());
  EXPECT_TRUE(check({0, 1, 1, 1}).ok());
  EXPECT_TRUE(check({0, 1, 2, 1, 4, 5}).ok());
}

TEST(LowerBodyArray, RefusesAParentThatIsNotLowerAndNamesTheFirstSuchBody) {
  struct Refused {
    std::vector<std::uint8_t> lower;
    int body;
  };
  for (const Refused& e : {Refused{{1}, 1}, Refused{{0, 2}, 2}, Refused{{0, 1, 4, 3}, 3},
                           Refused{{0, 1, 2, 255, 9}, 4}}) {
    const Status status = check(e.lower);
    EXPECT_EQ(status.reason, Reason::parent_not_lower);
    EXPECT_EQ(status.where.body, e.body);
  }
}

TEST(LowerBodyArray, RefusesNoneAndTwoRoots) {
  EXPECT_EQ(check({}).reason, Reason::not_one_root);
  EXPECT_EQ(check({0, 0}).reason, Reason::not_one_root);
  EXPECT_EQ(check({0, 1, 0}).reason, Reason::not_one_root);
}

TEST(MachineRefusal, TooManyBodies) {
  MachineDescription m = xyfz();
  m.body_count = kMaxBodies + 1;
  const Status status = build(m);
  EXPECT_EQ(status.reason, Reason::too_many_bodies);
  EXPECT_EQ(status.where.count, 17);
}

TEST(MachineRefusal, ArrayErrorsNameTheBody) {
  MachineDescription m = xyfz();
  m.body[2].lower = 3;
  const Status status = build(m);
  EXPECT_EQ(status.reason, Reason::parent_not_lower);
  EXPECT_EQ(status.where.body, 3);
  m = xyfz();
  m.body[3].lower = 0;
  EXPECT_EQ(build(m).reason, Reason::not_one_root);
}

TEST(MachineRefusal, WorkOrToolBodyThatDoesNotExist) {
  for (const int number : {0, 5, 255}) {
    const auto body = static_cast<std::uint8_t>(number);
    MachineDescription m = xyfz();
    m.work_body = body;
    EXPECT_EQ(build(m).reason, Reason::bad_body) << number;
    m = xyfz();
    m.tool_body = body;
    EXPECT_EQ(build(m).reason, Reason::bad_body) << number;
  }
}

TEST(MachineRefusal, BadSignOrAxisNamesBodyAndLetter) {
  for (const int sign : {0, 2, -2, 127}) {
    MachineDescription m = xyfz();
    m.body[2].joint.sign = static_cast<std::int8_t>(sign);
    const Status status = build(m);
    EXPECT_EQ(status.reason, Reason::bad_joint);
    EXPECT_EQ(status.where.body, 3);
    EXPECT_EQ(status.where.axis, 'X');
  }
  MachineDescription m = xyfz();
  m.body[3].joint.axis = static_cast<Axis>(3);
  EXPECT_EQ(build(m).reason, Reason::bad_joint);
}

TEST(MachineRefusal, NotFiniteOffsetOrConstantError) {
  MachineDescription m = xyfz();
  m.body[3].joint.offset[1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(build(m).reason, Reason::not_finite);
  EXPECT_EQ(build(m).where.body, 4);
  m = xyfz();
  m.body[0].constant_error[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(build(m).reason, Reason::not_finite);
  EXPECT_EQ(build(m).where.body, 1);
}

TEST(MachineRefusal, OrientationThatIsNoRotation) {
  MachineDescription m = xyfz();
  m.body[1].joint.orientation = {1, 0, 0, 0, 1, 1e-6, 0, 0, 1};  // sheared
  EXPECT_EQ(build(m).reason, Reason::not_a_rotation);
  EXPECT_EQ(build(m).where.body, 2);
  m.body[1].joint.orientation = {1, 0, 0, 0, 1, 0, 0, 0, -1};  // mirrored
  EXPECT_EQ(build(m).reason, Reason::not_a_rotation);
  m.body[1].joint.orientation = {0, -1, 0, 1, 0, 0, 0, 0, 1};  // a quarter turn
  EXPECT_TRUE(build(m).ok());
}

TEST(MachineRefusal, AxisNumbersWithGapOrRepetition) {
  MachineDescription m = xyfz();
  m.body[3].joint.nc_axis = 0;  // X has it already
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
  EXPECT_EQ(build(m).where.body, 4);
  m.body[3].joint.nc_axis = 3;  // 0, 1, 3
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
  m.body[3].joint.nc_axis = 8;
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
}

TEST(MachineRefusal, CorrectingAxesThatDoNotExist) {
  MachineDescription m = xyfz();
  m.correcting = {0, 3, 2};
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
  EXPECT_EQ(build(m).where.index, 1);
  m = xyfz();
  m.correcting_count = 4;
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
  m = xyfz();
  m.correcting = {0, 2, 0};  // the same axis twice
  EXPECT_EQ(build(m).reason, Reason::bad_axis_index);
  EXPECT_EQ(build(m).where.index, 2);
}

TEST(MachineRefusal, NineAxes) {
  MachineDescription m;
  m.body_count = 10;
  m.work_body = 1;
  m.tool_body = 10;
  for (std::uint8_t k = 1; k < 10; ++k) {
    m.body[k].lower = k;
    m.body[k].joint.kind = JointKind::rotary;
    m.body[k].joint.nc_axis = static_cast<std::uint8_t>(k - 1);
  }
  EXPECT_EQ(build(m).reason, Reason::too_many_axes);
  EXPECT_EQ(build(m).where.body, 10);
  m.body[9].joint.kind = JointKind::fixed;
  EXPECT_TRUE(build(m).ok());
}

TEST(MachineRefusal, LeavesTheOldMachineInPlace) {
  MachineChain chain = chain_of(xyfz());
  MachineDescription bad = xyfz();
  bad.tool_body = 9;
  bad.tool_point = {1, 2, 3};
  ASSERT_FALSE(MachineChain::build(bad, chain).ok());
  EXPECT_EQ(chain.tool_point(), Vec3(30, -380, -300));
  EXPECT_EQ(chain.axis_count(), 3U);
}

// The header: "nc_axis … unused when fixed". Any value must be harmless (the sanitizer build sees a
// read beyond the pose).
TEST(MachineRefusal, AxisNumberOfAFixedBodyIsNeverRead) {
  MachineDescription m = xyfz();
  m.body[0].joint.nc_axis = 255;
  MachineDescription trunk = m;
  trunk.body_count = 5;
  trunk.body[4].lower = 4;
  trunk.body[4].joint.nc_axis = 200;
  trunk.tool_body = 5;
  const MachineChain chain = chain_of(trunk);
  EXPECT_EQ(chain.ideal(chain.tool(), Pose{}).t, Vec3(20, 520, 1130));
}

}  // namespace
}  // namespace volcomp::test
