// Offsets of the correcting axes: Δq = −J⁺ E.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/machine/inverse.hpp"
#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

constexpr double kArm = 173.7135;  // L_R of docs/papers/l300g.md

// base → X → Y → B(about +Y) → ball at (−L_R, 0, 0); base → A. B, X and Y correct.
MachineDescription grinder() {
  MachineDescription m;
  m.body_count = 5;
  const std::array<Axis, 4> axis{Axis::x, Axis::y, Axis::y, Axis::x};
  for (std::uint8_t k = 0; k < 4; ++k) {
    Body& body = m.body[k + 1U];
    body.lower = static_cast<std::uint8_t>(k == 3 ? 1 : k + 1);
    body.joint.kind = k < 2 ? JointKind::prismatic : JointKind::rotary;
    body.joint.axis = axis[k];
    body.joint.nc_axis = k;
  }
  m.tool_body = 4;
  m.work_body = 5;
  m.tool_point = {-kArm, 0.0, 0.0};
  m.correcting = {2, 0, 1};
  m.correcting_count = 3;
  return m;
}

// Position of the tool point relative to the work, base orientation, ideal chain, long double.
Vec3 column_by_difference(const MachineDescription& m, const Pose& q, std::size_t axis,
                          double step) {
  const Real3 tip = Eigen::Map<const Vec3>(m.tool_point.data()).cast<Real>();
  const auto pose = [&](int body, const Pose& at) {
    return body_pose(m, body, at, nullptr, RotationModel::rxryrz);
  };
  const auto on_work = [&](const Pose& at) -> Real3 {
    const Real44 T = pose(m.work_body, at);
    const Real3 p = transform(pose(m.tool_body, at), tip) - T.topRightCorner<3, 1>();
    return T.topLeftCorner<3, 3>().transpose() * p;
  };
  Pose ahead = q;
  Pose behind = q;
  ahead[axis] += step;
  behind[axis] -= step;
  const Real33 R = pose(m.work_body, q).topLeftCorner<3, 3>();
  return to_double(R * (on_work(ahead) - on_work(behind)) / (2 * static_cast<Real>(step)));
}

TEST(Jacobian, ColumnsEqualFiniteDifferencesOnAnyMachine) {
  Random random;
  for (int i = 0; i < 300; ++i) {
    MachineDescription m = random_machine(random, 0.0, 0.0);
    m.body[0].joint = {};  // the common frame: a moving trunk would turn the base itself
    std::uint8_t axes = 0;
    for (std::size_t k = 0; k < m.body_count; ++k) {
      if (m.body[k].joint.moves()) m.body[k].joint.nc_axis = axes++;
    }
    const MachineChain chain = chain_of(m);
    Pose q{};
    for (std::size_t a = 0; a < chain.axis_count(); ++a)
      q[a] = random.uniform(-3.0, 3.0);
    const Vec3 tip = chain.tool_point();
    // Column in the frame of the last common body; the finite difference is in the root frame.
    int common = 1;
    std::vector<int> ancestors;
    for (int k = m.work_body; k != 0; k = m.body[static_cast<std::size_t>(k - 1)].lower)
      ancestors.push_back(k);
    for (int k = m.tool_body; k != 0; k = m.body[static_cast<std::size_t>(k - 1)].lower) {
      if (std::find(ancestors.begin(), ancestors.end(), k) == ancestors.end()) continue;
      common = k;
      break;
    }
    const Real33 to_base =
        body_pose(m, common, q, nullptr, RotationModel::rxryrz).topLeftCorner<3, 3>().transpose();
    for (std::size_t a = 0; a < chain.axis_count(); ++a) {
      const Vec3 want = to_double(to_base * column_by_difference(m, q, a, 1e-5).cast<Real>());
      const Vec3 got = jacobian_column(chain, q, tip, a);
      ASSERT_LE((got - want).norm(), 1e-10 * (1000.0 + want.norm())) << "machine " << i;
    }
  }
}

TEST(MotionOffset, OfTheXyfzMachineIsMinusTheError) {
  const MachineChain chain = chain_of(xyfz_optimised({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
  MotionOffset out;
  ASSERT_TRUE(
      motion_offset(chain, {-400, -100, -300}, chain.tool_point(), {0.01, -0.02, 0.03}, out).ok());
  EXPECT_DOUBLE_EQ(out.offset[0], -0.01);
  EXPECT_DOUBLE_EQ(out.offset[1], 0.02);
  EXPECT_DOUBLE_EQ(out.offset[2], -0.03);
  EXPECT_DOUBLE_EQ(out.authority, 1.0);
  EXPECT_LE(out.remainder.norm(), 1e-17);
}

// The L300G (docs/papers/l300g.md): dB = −e_z/(L_R cos θ), dX = −e_x − L_R sin θ dB, dY = −e_y.
TEST(MotionOffset, OfTheGrinderFollowsTheClosedFormulas) {
  Random random;
  const MachineChain chain = chain_of(grinder());
  for (int i = 0; i < 500; ++i) {
    const double theta = random.uniform(-1.4, 1.4);
    const Pose q{random.uniform(0, 400), random.uniform(-200, 200), theta, random.uniform(-7, 7)};
    const Vec3 e = random.vector(0.05);
    MotionOffset out;
    ASSERT_TRUE(motion_offset(chain, q, chain.tool_point(), e, out).ok());
    const double dB = -e.z() / (kArm * std::cos(theta));
    EXPECT_NEAR(out.offset[2], dB, 1e-15);
    EXPECT_NEAR(out.offset[0], -e.x() - kArm * std::sin(theta) * dB, 1e-13);
    EXPECT_NEAR(out.offset[1], -e.y(), 1e-14);
    EXPECT_EQ(out.offset[3], 0.0);
    EXPECT_NEAR(out.authority, std::cos(theta), 1e-12);
    EXPECT_LE(out.remainder.norm(), 1e-15);
  }
}

// Moving by the offset moves the ideal tool point by −E, up to the curvature of the arc.
TEST(MotionOffset, ActuallyMovesTheToolPointByMinusTheError) {
  const MachineDescription m = grinder();
  const MachineChain chain = chain_of(m);
  const Vec3 e(0.011, -0.007, 0.013);
  const Pose q{120, 40, 0.6, 0.0};
  MotionOffset out;
  ASSERT_TRUE(motion_offset(chain, q, chain.tool_point(), e, out).ok());
  Pose moved = q;
  for (std::size_t a = 0; a < 3; ++a)
    moved[a] += out.offset[a];
  const auto tip = [&](const Pose& at) -> Real3 {
    return transform(body_pose(m, 4, at, nullptr, RotationModel::rxryrz), Real3(-kArm, 0, 0));
  };
  const double curvature = 0.5 * kArm * out.offset[2] * out.offset[2];
  EXPECT_LE((to_double(tip(moved) - tip(q)) + e).norm(), 1.01 * curvature + 1e-12);
}

TEST(MotionOffset, IsRefusedBelowAuthorityOneTenth) {
  const MachineChain chain = chain_of(grinder());
  MotionOffset out;
  out.authority = 7.0;
  const auto at = [&](double cosine) {
    return motion_offset(chain, {0, 0, std::acos(cosine), 0}, chain.tool_point(), {0, 0, 1e-3},
                         out);
  };
  for (const double cosine : {0.0999, 0.0, -0.0999}) {
    const Status status = at(cosine);
    EXPECT_EQ(status.reason, Reason::no_authority);
    EXPECT_NEAR(status.where.value, std::abs(cosine), 1e-12);
    EXPECT_EQ(out.authority, 7.0) << "written on refusal";
  }
  EXPECT_TRUE(at(0.1001).ok());
  EXPECT_TRUE(at(-0.1001).ok());
}

TEST(MotionOffset, IsRefusedForAxesThatCannotMoveTheTool) {
  MachineDescription m = grinder();
  m.correcting_count = 0;
  MotionOffset out;
  EXPECT_EQ(motion_offset(chain_of(m), {}, Vec3(-kArm, 0, 0), {}, out).reason,
            Reason::no_authority);
  m.body[2].joint.axis = Axis::x;  // X twice
  m.correcting = {0, 1, 2};
  m.correcting_count = 2;
  EXPECT_EQ(motion_offset(chain_of(m), {}, Vec3(-kArm, 0, 0), {}, out).reason,
            Reason::no_authority);
  m.correcting = {2, 0, 1};
  m.correcting_count = 1;  // B alone, tool point on its axis
  EXPECT_EQ(motion_offset(chain_of(m), {}, Vec3(0, 55, 0), {}, out).reason, Reason::no_authority);
}

// Fewer than three axes: least squares. What is left is orthogonal to everything they can move, and
// no other offset leaves less.
TEST(MotionOffset, OfTwoOrOneAxesLeavesTheOrthogonalRemainder) {
  Random random;
  for (int i = 0; i < 300; ++i) {
    MachineDescription m = grinder();
    m.correcting_count = static_cast<std::uint8_t>(random.integer(1, 2));
    const MachineChain chain = chain_of(m);
    const Pose q{10, 20, random.uniform(-1.2, 1.2), 1.0};
    const Vec3 e = random.vector(0.05);
    const Vec3 tip = chain.tool_point();
    MotionOffset out;
    ASSERT_TRUE(motion_offset(chain, q, tip, e, out).ok());
    Vec3 left = e;
    for (std::size_t a = 0; a < 4; ++a)
      left += jacobian_column(chain, q, tip, a) * out.offset[a];
    ASSERT_LE((left - out.remainder).norm(), 1e-14);
    for (std::size_t c = 0; c < m.correcting_count; ++c) {
      const Vec3 column = jacobian_column(chain, q, tip, m.correcting[c]);
      EXPECT_LE(std::abs(column.normalized().dot(out.remainder)), 1e-15);
      EXPECT_LT(out.remainder.norm(), (left + 1e-6 * column).norm() + 1e-15);
    }
    for (std::size_t c = m.correcting_count; c < 3; ++c)
      EXPECT_EQ(out.offset[m.correcting[c]], 0.0);
  }
}

// XYZ with only X and Y correcting: the whole of E_z is left.
TEST(MotionOffset, WithoutAVerticalAxisLeavesTheVerticalError) {
  MachineDescription m = xyfz_optimised({{}, {}, {}});
  m.correcting_count = 2;
  MotionOffset out;
  ASSERT_TRUE(motion_offset(chain_of(m), {}, Vec3::Zero(), {1, 2, 3}, out).ok());
  EXPECT_LE((out.remainder - Vec3(0, 0, 3)).norm(), 1e-15);
  EXPECT_EQ(out.offset[2], 0.0);
}

}  // namespace
}  // namespace volcomp::test
