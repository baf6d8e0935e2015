// Rotary axes that hold the direction of the tool: against 4×4 products in long double, against the
// same solution in double, and what happens when such an axis cannot turn as it should.

#include <algorithm>
#include <vector>

#include "comp/core/units.hpp"
#include "comp/machine/tilt.hpp"
#include "comp/metrology/tables/pose_offset.hpp"
#include "comp/tables/image.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr Real kRadPerUnit = 2 * 3.14159265358979323846264338327950288L / 4294967296.0L;
constexpr std::size_t kA = 3;
constexpr std::size_t kC = 4;

// Y, A and C carry the work, X and Z the tool, a little askew in its holder.
MachineDescription trunnion() {
  MachineDescription d;
  d.body_count = 7;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::y, -1, 1, 'Y', {0, 10, 0});
  d.body[2] = moving_body(2, JointKind::rotary, Axis::x, -1, kA, 'A', {50, 20, 180});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::z, -1, kC, 'C', {0.1, 3, 60});
  d.body[4] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X', {40, 30, 700});
  d.body[5] = moving_body(5, JointKind::prismatic, Axis::z, 1, 2, 'Z', {0, -15, 80});
  d.body[6].lower = 6;
  d.body[6].joint.offset = {1, 2, -3};
  d.body[6].joint.orientation = {1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8};
  d.work_body = 4;
  d.tool_body = 7;
  d.tool_point = {2, -3, -220};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  d.orienting = {kA, kC};
  d.orienting_count = 2;
  return d;
}

MachineTables tables_of(const MachineDescription& machine, Random& random) {
  MachineTables t;
  t.machine = machine;
  for (std::size_t a = 0; a < 3; ++a) {
    t.axis[a] = random_table(-250'000'000, 33'333'333, 16, 8e3, 30e-6, random);
    t.directions[a] = Vec3(random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5));
  }
  t.axis[kA] = random_table(-kTurn * 110 / 360, kTurn * 10 / 360, 23, 8e3, 30e-6, random);
  t.axis[kC] = random_table(kTurn / 7, kTurn / 37, 37, 8e3, 30e-6, random);
  t.axis[kC].periodic = true;
  for (AxisTable& axis : t.axis)
    axis.value[1] = axis.value[0];  // by position only; directions have their own tests
  return t;
}

using Positions = std::array<std::int64_t, kMaxAxes>;

Positions somewhere(Random& random) {
  return {random.integer(-240'000'000, 240'000'000), random.integer(-240'000'000, 240'000'000),
          random.integer(-240'000'000, 240'000'000), random.integer(-kTurn / 4, kTurn / 4),
          random.integer(-8 * kTurn, 8 * kTurn)};
}

void tick_at(OrientingRunner& runner, const Positions& q) {
  runner.tick({q[0], q[1], q[2], q[3], q[4]});
}

Pose pose_of(const Positions& q) {
  Pose pose{};
  for (std::size_t a = 0; a < 3; ++a)
    pose[a] = static_cast<double>(q[a]) * 1e-6;
  for (const std::size_t a : {kA, kC})
    pose[a] = static_cast<double>(static_cast<Real>(q[a]) / 256 * kRadPerUnit);
  return pose;
}

Real distance(const Real3& a, const Real3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// What is left at the tool where the axes stand, their offsets included.
struct Left {
  Real point_nm;
  Real tilt_rad;
};
Left left_at(MachineModel& model, const Positions& q, const OrientingRunner& runner) {
  model.stand_at(q, {});
  const MachineModel::Tool found = model.tool_in_work(1);
  for (std::size_t a = 0; a < 5; ++a)
    model.displace(a, -static_cast<Real>(runner.out.offset[a]) * (a < 3 ? 1 : kRadPerUnit));
  const MachineModel::Tool wanted = model.tool_in_work(0);
  for (std::size_t a = 0; a < 5; ++a)
    model.displace(a, 0);
  return {distance(found.point, wanted.point), distance(found.axis, wanted.axis)};
}

// The smaller of the two turns by which the tool answers, as in comp/machine/tilt.hpp.
double grip_at(const MachineChain& chain, const Pose& q) {
  const Vec3 tool = tool_axis(chain, q);
  const Vec3 a = turning_column(chain, q, kA).cross(tool);
  const Vec3 c = turning_column(chain, q, kC).cross(tool);
  return a.cross(c).norm();
}

MachineChain chain_of(const MachineDescription& machine) {
  MachineChain chain;
  EXPECT_TRUE(MachineChain::build(machine, chain).ok());
  return chain;
}

// What is left is of second order: for the direction the square of the turns, for the point their
// products with each other.
TEST(Orienting, PointAndDirectionOfTheToolAreHeld) {
  Random random(60);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = tables_of(trunnion(), random);
  OrientingRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  MachineModel model(tables, tables.machine.tool_point);
  const MachineChain chain = chain_of(tables.machine);
  constexpr Real kLever_nm = 700e6L;
  int held = 0;
  for (int n = 0; n < kManyPoints / 50; ++n) {
    const Positions q = somewhere(random);
    if (grip_at(chain, pose_of(q)) < kMinTurning) continue;
    ++held;
    tick_at(runner, q);
    const Real a = kRadPerUnit * std::abs(static_cast<Real>(runner.out.offset[kA]));
    const Real c = kRadPerUnit * std::abs(static_cast<Real>(runner.out.offset[kC]));
    const Left left = left_at(model, q, runner);
    ASSERT_LT(left.tilt_rad, (a + c + 2e-4L) * (a + c + 2e-4L)) << "point " << n;
    ASSERT_LT(left.point_nm, 1.5L + a * (c + 1e-4L) * kLever_nm) << "point " << n;
  }
  EXPECT_GT(held, kManyPoints / 100);
}

// Orientation to the first order of the model: the odd part of its turns.
Vec3 orientation_of(MachineModel& model, const MachineChain& chain, const Positions& q) {
  const Real3 plus = model.tool_in_work(1).axis;
  const Real3 minus = model.tool_in_work(-1).axis;
  Vec3 across;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    across(i) = static_cast<double>((plus[at] - minus[at]) / 2);
  }
  const Mat3 work = chain.ideal(chain.work(), pose_of(q)).R;
  return tool_axis(chain, pose_of(q)).cross(work * across);  // ω × k, turned back to ω across k
}

TEST(Orienting, TickIsTheSolutionInDouble) {
  Random random(61);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = tables_of(trunnion(), random);
  OrientingRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  MachineModel model(tables, tables.machine.tool_point);
  const MachineChain chain = chain_of(tables.machine);
  Real worst_nm = 0;
  Real worst_rad = 0;
  int faded = 0;
  for (int n = 0; n < kManyPoints / 50; ++n) {
    const Positions q = somewhere(random);
    tick_at(runner, q);
    model.stand_at(q, {});
    const Real3 e = model.exact();
    const Vec3 position(static_cast<double>(e[0]) * 1e-6, static_cast<double>(e[1]) * 1e-6,
                        static_cast<double>(e[2]) * 1e-6);
    PoseOffset wanted;
    ASSERT_TRUE(pose_offset(chain, pose_of(q), chain.tool_point(), position,
                            orientation_of(model, chain, q), wanted)
                    .ok());
    faded += grip_at(chain, pose_of(q)) < kMinTurning ? 1 : 0;
    for (std::size_t a = 0; a < 5; ++a) {
      const Real got = static_cast<Real>(runner.out.offset[a]) * (a < 3 ? 1 : kRadPerUnit);
      const Real off = std::abs(got - static_cast<Real>(wanted.offset[a]) * (a < 3 ? 1e6L : 1));
      (a < 3 ? worst_nm : worst_rad) = std::max(a < 3 ? worst_nm : worst_rad, off);
    }
    ASSERT_LT(worst_nm, 1.0L) << "point " << n;
    ASSERT_LT(worst_rad, 2.5e-9L) << "point " << n;  // 2^-32 turn is 1.5e-9
  }
  EXPECT_GT(faded, kManyPoints / 1000);
  RecordProperty("worst_pm", static_cast<int>(worst_nm * 1e3L));
}

// Nothing changes for machines that do not orient, not one bit.
TEST(Orienting, MachinesWithoutAreTickedAsBefore) {
  Random random(62);
  SCOPED_TRACE(random.trace());
  MachineDescription machine = trunnion();
  machine.orienting_count = 0;
  const MachineTables tables = tables_of(machine, random);
  OrientingRunner with(machine);
  LoadedRunner without(machine);
  ASSERT_TRUE(with.start(tables).ok());
  ASSERT_TRUE(without.start(tables).ok());
  for (int n = 0; n < 1000; ++n) {
    const Positions q = somewhere(random);
    tick_at(with, q);
    without.tick({q[0], q[1], q[2], q[3], q[4]});
    ASSERT_EQ(with.out.offset, without.out.offset);
    ASSERT_EQ(with.out.status, without.out.status);
  }
}

class OneAxisTrouble : public testing::Test {
 protected:
  OneAxisTrouble() : tables(tables_of(trunnion(), random)), runner(tables.machine) {}

  void start(std::int32_t limit_of_c = 4'194'303) {
    auto settings = open_settings<5>();
    settings.axis[kC].limit = limit_of_c;
    ASSERT_TRUE(runner.start(tables, settings).ok());
    tick_at(runner, q);
    tick_at(runner, q);
  }
  // Off its place in spite of the correcting axes, nm.
  Real point_off() { return left_at(model, q, runner).point_nm; }

  Random random{63};
  MachineTables tables;
  OrientingRunner runner;
  MachineModel model{tables, tables.machine.tool_point};
  const Positions q{100'000'000, -150'000'000, 50'000'000, kTurn / 7, kTurn / 5};
};

TEST_F(OneAxisTrouble, LimitedTurnIsReckonedWith) {
  start();
  const std::int32_t free = runner.out.offset[kC];
  ASSERT_GT(std::abs(free), 2000);
  const std::uint16_t before = runner.compensator->diagnostics().began[kC][bit_of(kClamped)];
  OrientingRunner limited(tables.machine);
  std::swap(runner, limited);
  start(1000);
  for (int n = 0; n < 10; ++n) {
    tick_at(runner, q);
    EXPECT_EQ(std::abs(runner.out.offset[kC]), 1000);
    EXPECT_NE(runner.out.status[kC] & kClamped, 0);
    EXPECT_EQ(runner.out.status[kC] & kValid, 0);
  }
  EXPECT_LT(point_off(), 30.0L);
  EXPECT_EQ(before, 0);
  EXPECT_EQ(runner.compensator->diagnostics().began[kC][bit_of(kClamped)], 1) << "began once";
}

TEST_F(OneAxisTrouble, UnreferencedAxisTurnsNothingAndThePointIsHeld) {
  start();
  runner.in.axis[kC].homed = false;
  for (int n = 0; n < 3; ++n)
    tick_at(runner, q);
  EXPECT_EQ(runner.out.offset[kC], 0);
  EXPECT_NE(runner.out.status[kC] & kNotHomed, 0);
  EXPECT_NE(runner.out.offset[kA], 0) << "the other goes on";
  EXPECT_LT(point_off(), 30.0L);
}

TEST_F(OneAxisTrouble, SilentAxisIsHeldAndThePointIsHeld) {
  start();
  const std::int32_t before = runner.out.offset[kC];
  runner.in.axis[kC].valid = false;
  for (int n = 0; n < 3; ++n)
    tick_at(runner, q);
  EXPECT_EQ(runner.out.offset[kC], before);
  EXPECT_NE(runner.out.status[kC] & kStale, 0);
  EXPECT_LT(point_off(), 30.0L);
}

// All offsets go along the same ramp.
TEST(Orienting, ComesInAlongTheRampWithTheOthers) {
  Random random(64);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = tables_of(trunnion(), random);
  const Positions q{100'000'000, -150'000'000, 50'000'000, kTurn / 7, kTurn / 5};
  OrientingRunner at_once(tables.machine);
  OrientingRunner ramped(tables.machine);
  auto settings = open_settings<5>();
  ASSERT_TRUE(at_once.start(tables, settings).ok());
  settings.ramp_ticks = 100;
  ASSERT_TRUE(ramped.start(tables, settings).ok());
  tick_at(at_once, q);
  for (int n = 0; n < 50; ++n)
    tick_at(ramped, q);
  for (std::size_t a = 0; a < 5; ++a) {
    EXPECT_NEAR(ramped.out.offset[a], at_once.out.offset[a] / 2.0, 1.0) << "axis " << a;
    EXPECT_NE(ramped.out.status[a] & kRamping, 0);
  }
  for (int n = 0; n < 60; ++n)
    tick_at(ramped, q);
  EXPECT_EQ(ramped.out.offset, at_once.out.offset);
}

TEST(Orienting, BuildsWithoutItRefuseTheTables) {
  Random random(65);
  const MachineTables tables = tables_of(trunnion(), random);
  LoadedRunner runner(tables.machine);
  EXPECT_EQ(runner.start(tables).reason, Reason::cannot_orient);
}

TEST(Orienting, TravelsWithTheImage) {
  Random random(66);
  const auto tables = std::make_unique<MachineTables>(tables_of(trunnion(), random));
  std::vector<std::uint8_t> bytes(image_size(*tables));
  std::size_t written = 0;
  ASSERT_TRUE(encode_image(*tables, {bytes.data(), bytes.size()}, written).ok());
  const auto back = std::make_unique<MachineTables>();
  ASSERT_TRUE(decode_image({bytes.data(), written}, kDefaultKnots, *back).ok());
  EXPECT_EQ(back->machine.orienting_count, 2);
  EXPECT_EQ(back->machine.orienting, tables->machine.orienting);
}

TEST(Orienting, OnlyAxesThatTurnAndAreFree) {
  struct Case {
    char axis;
    std::uint8_t correcting;
    std::array<std::uint8_t, 2> orienting;
  };
  for (const Case& c : {Case{'Z', 2, {2, kC}}, Case{'C', 3, {kC, kC}}}) {
    Random random(67);
    MachineDescription machine = trunnion();
    machine.correcting_count = c.correcting;
    machine.orienting = c.orienting;
    OrientingRunner runner(machine);
    const Status refusal = runner.start(tables_of(machine, random));
    EXPECT_EQ(refusal.reason, Reason::cannot_orient) << c.axis;
    EXPECT_EQ(refusal.where.axis, c.axis);
  }
  Random random(68);
  MachineDescription both = trunnion();
  both.correcting = {0, kA, 2};
  OrientingRunner runner(both);
  EXPECT_EQ(runner.start(tables_of(both, random)).where.axis, 'A');

  MachineChain chain;
  MachineDescription none = trunnion();
  none.orienting[1] = 5;
  EXPECT_EQ(MachineChain::build(none, chain).reason, Reason::cannot_orient);
  MachineDescription three = trunnion();
  three.orienting_count = 3;
  EXPECT_EQ(MachineChain::build(three, chain).reason, Reason::cannot_orient);
}

}  // namespace
}  // namespace volcomp::test
