// The ideal machine in double beside the chain of commissioning and beside finite differences.

#include "comp/probe/nominal_chain.hpp"

#include "comp/machine/inverse.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

Pose to_pose(const NominalChain& chain, const LatchedPose& q) {
  Pose pose{};
  for (std::size_t a = 0; a < chain.axes(); ++a)
    pose[a] = q[a] / (chain.rotary(a) ? kUnitsPerRad : kNmPerMm);
  return pose;
}

LatchedPose to_latched(const std::array<std::int64_t, kMaxAxes>& q) {
  LatchedPose out{};
  for (std::size_t a = 0; a < kMaxAxes; ++a)
    out[a] = static_cast<double>(q[a]);
  return out;
}

// A pedestal turned out of the axes, two rotary axes on the work, all kinds of signs.
MachineDescription skewed_machine() {
  MachineDescription m;
  m.body_count = 6;
  m.body[1] = moving_body(1, JointKind::prismatic, Axis::x, -1, 0, 'X', {-200.0, 30.0, 80.0});
  m.body[2] = moving_body(2, JointKind::rotary, Axis::x, -1, 3, 'A', {10.0, 20.0, 30.0});
  m.body[3] = moving_body(3, JointKind::rotary, Axis::z, 1, 4, 'C', {0.0, -40.0, 25.0});
  m.body[4] = moving_body(1, JointKind::prismatic, Axis::y, 1, 1, 'Y', {5.0, 500.0, 0.0});
  m.body[5] = moving_body(5, JointKind::prismatic, Axis::z, 1, 2, 'Z', {0.0, 0.0, 900.0});
  const double s = 0.6;
  const double c = 0.8;
  m.body[5].joint.orientation = {1, 0, 0, 0, c, -s, 0, s, c};
  m.body[2].joint.orientation = {c, 0, s, 0, 1, 0, -s, 0, c};
  m.work_body = 4;
  m.tool_body = 6;
  m.tool_point = {3.0, -4.0, -120.0};
  m.correcting = {0, 1, 2};
  m.correcting_count = 3;
  return m;
}

void expect_same_machine(const MachineDescription& machine, std::uint64_t offset) {
  Random random(offset);
  SCOPED_TRACE(random.trace());
  MachineChain reference;
  ASSERT_TRUE(MachineChain::build(machine, reference).ok());
  const NominalChain chain(machine);
  ASSERT_EQ(chain.axes(), reference.axis_count());
  const Vec3 tool = tool_nm(machine);
  for (int i = 0; i < 200; ++i) {
    LatchedPose q{};
    for (std::size_t a = 0; a < chain.axes(); ++a)
      q[a] = chain.rotary(a) ? random.in(-5e11, 5e11) : random.in(-4e8, 4e8);
    const Pose pose = to_pose(chain, q);
    NominalPoint got;
    chain.at(q, tool, {}, got);
    const PointPair wanted = ideal_points(reference, pose, reference.tool_point());
    EXPECT_LT((got.part - wanted.work * kNmPerMm).norm(), 1e-5);
    EXPECT_LT((got.tool_to_base * got.tool_to_base.transpose() - Mat3::Identity()).norm(), 1e-14);
    for (std::size_t a = 0; a < chain.axes(); ++a) {
      const Vec3 base = jacobian_column(reference, pose, reference.tool_point(), a);
      const double unit = chain.rotary(a) ? kNmPerMm : 1.0;
      EXPECT_LT((got.column[a] - base * unit).norm(), 1e-6 * unit) << a;
    }
  }
}

TEST(NominalChain, IsTheChainOfCommissioning) {
  expect_same_machine(probing_machine(), 1);
  expect_same_machine(kXyfzMachine, 2);
  expect_same_machine(skewed_machine(), 3);
}

TEST(NominalChain, AnglesKnowNoTurns) {
  const NominalChain chain(probing_machine());
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const LatchedPose q = to_latched(random_probing_pose(random));
    LatchedPose turned = q;
    turned[3] -= static_cast<double>(kUnitsPerTurn);
    NominalPoint once;
    NominalPoint again;
    chain.at(q, Vec3::Zero(), {}, once);
    chain.at(turned, Vec3::Zero(), {}, again);
    EXPECT_LT((once.part_to_base - again.part_to_base).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace volcomp::test
