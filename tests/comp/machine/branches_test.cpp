// From the array to two branches: what lies on them, what cancels, and which signs they carry.

#include <gtest/gtest.h>

#include "comp/machine/inverse.hpp"
#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

std::vector<int> bodies(const BodyPath& path) {
  std::vector<int> numbers;
  for (const std::uint8_t body : path)
    numbers.push_back(body + 1);
  return numbers;
}

Joint linear(Axis axis, std::uint8_t nc_axis, int sign) {
  Joint joint;
  joint.kind = JointKind::prismatic;
  joint.axis = axis;
  joint.nc_axis = nc_axis;
  joint.sign = static_cast<std::int8_t>(sign);
  return joint;
}

// bed 1 – carriage 2 – {column 3 – head 4, table 5 – pallet 6}, and a door 7 on nothing of interest
MachineDescription forked() {
  MachineDescription m;
  m.body_count = 7;
  const std::array<std::uint8_t, 7> lower{0, 1, 2, 3, 2, 5, 1};
  for (std::size_t k = 0; k < 7; ++k)
    m.body[k].lower = lower[k];
  m.body[1].joint = linear(Axis::x, 0, 1);
  m.body[3].joint = linear(Axis::z, 1, 1);
  m.body[5].joint = linear(Axis::y, 2, -1);
  m.body[6].joint = linear(Axis::y, 3, 1);
  m.tool_body = 4;
  m.work_body = 6;
  m.tool_point = {10, 20, 30};
  return m;
}

TEST(Branches, BeginAfterTheLastCommonBody) {
  const MachineChain chain = chain_of(forked());
  EXPECT_EQ(bodies(chain.tool()), (std::vector<int>{3, 4}));
  EXPECT_EQ(bodies(chain.work()), (std::vector<int>{5, 6}));
  EXPECT_EQ(chain.joint(3).branch, Branch::tool);
  EXPECT_EQ(chain.joint(5).branch, Branch::work);
  EXPECT_EQ(chain.joint(1).branch, Branch::none);
  EXPECT_EQ(chain.joint(6).branch, Branch::none);
}

TEST(Branches, WorkOnTheRootAndToolOnTheRoot) {
  MachineDescription m = forked();
  m.work_body = 1;
  EXPECT_EQ(bodies(chain_of(m).tool()), (std::vector<int>{2, 3, 4}));
  EXPECT_TRUE(bodies(chain_of(m).work()).empty());
  m = forked();
  m.tool_body = 2;  // on the path of the work
  EXPECT_TRUE(bodies(chain_of(m).tool()).empty());
  EXPECT_EQ(bodies(chain_of(m).work()), (std::vector<int>{5, 6}));
}

// A body in the common trunk, or beside both branches, moves nothing relative to anything.
TEST(Branches, TrunkAndDoorHaveNoErrorAndNoAuthority) {
  const MachineChain chain = chain_of(forked());
  ErrorSet errors = zero_errors();
  errors[0] << 1, 2, 3, 1e-3, 2e-3, 3e-3;
  errors[3] << 4, 5, 6, 4e-3, 5e-3, 6e-3;
  const Pose q{100, 200, 300, 400};
  const PointPair points = ideal_points(chain, q, chain.tool_point());
  const VolumetricError exact =
      exact_error(chain, q, errors, Vec3::Zero(), RotationModel::rxryrz, points);
  EXPECT_EQ(exact.position_base, Vec3::Zero());
  EXPECT_EQ(exact.position_work, Vec3::Zero());
  EXPECT_LE(exact.orientation_base.norm(), 1e-15);
  for (const std::size_t axis : {0U, 3U})
    EXPECT_EQ(jacobian_column(chain, q, chain.tool_point(), axis), Vec3::Zero());
}

// s = −1 makes a positive NC coordinate of a workpiece-carrying axis move the workpiece backwards,
// so that the tool moves forwards relative to it.
TEST(Branches, PositiveCoordinateMovesTheToolForwardRelativeToTheWork) {
  const MachineChain chain = chain_of(xyfz_optimised({{}, {}, {}}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Pose q{};
    q[axis] = 7.0;
    const Vec3 moved =
        ideal_points(chain, q, Vec3::Zero()).work - ideal_points(chain, Pose{}, Vec3::Zero()).work;
    EXPECT_EQ(moved, 7.0 * Vec3::Unit(static_cast<Eigen::Index>(axis)));
    EXPECT_EQ(jacobian_column(chain, q, Vec3::Zero(), axis),
              Vec3(Vec3::Unit(static_cast<Eigen::Index>(axis))));
  }
}

// The sign belongs to the coordinate, never to an error: the same body error with s = ±1 displaces
// the tool the same way.
TEST(Branches, JointSignNeverTouchesAnError) {
  for (const int sign : {1, -1}) {
    MachineDescription m;
    m.body_count = 2;
    m.body[1].lower = 1;
    m.body[1].joint = linear(Axis::x, 0, sign);
    m.work_body = 1;
    m.tool_body = 2;
    const MachineChain chain = chain_of(m);
    ErrorSet errors = zero_errors();
    errors[0] << 0.01, 0.02, 0.03, 0, 0, 0;
    const PointPair points = ideal_points(chain, Pose{}, Vec3::Zero());
    EXPECT_EQ(first_order_error(chain, Pose{}, errors, Vec3::Zero(), points).position_base,
              Vec3(0.01, 0.02, 0.03));
  }
}

// Body convention: a workpiece-carrying body displaced by +δ moves the tool by −δ relative to it.
TEST(Branches, WorkBranchErrorsCountNegative) {
  const MachineChain chain = chain_of(xyfz_optimised({{}, {}, {}}));
  ErrorSet errors = zero_errors();
  errors[0](2) = 0.005;  // X slide, with the workpiece, rises
  const PointPair points = ideal_points(chain, Pose{}, Vec3::Zero());
  EXPECT_EQ(first_order_error(chain, Pose{}, errors, Vec3::Zero(), points).position_base,
            Vec3(0, 0, -0.005));
}

}  // namespace
}  // namespace volcomp::test
