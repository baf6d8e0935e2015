// Fixed bodies of a machine with rotary axes are part of the axis they hang on, and linear axes
// that nothing turns have one inverse for all poses: against 4×4 products in long double.

#include <algorithm>

#include "comp/tables/fixed_bodies.hpp"
#include "tests/oracle/exact_offsets.hpp"
#include "tests/oracle/table_table_machine.hpp"

namespace volcomp::test {
namespace {

std::array<double, 9> turned_by(double about_z, double about_x) {
  const double cz = std::cos(about_z);
  const double sz = std::sin(about_z);
  const double cx = std::cos(about_x);
  const double sx = std::sin(about_x);
  return {cz, -sz * cx, sz * sx, sz, cz * cx, -cz * sx, 0, sx, cx};
}

Joint fixed_joint(const std::array<double, 3>& offset, double about_z, double about_x) {
  Joint joint;
  joint.offset = offset;
  joint.orientation = turned_by(about_z, about_x);
  return joint;
}

Htm exact_frame(const Joint& joint) {
  Htm h;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      h.m[r][c] = static_cast<Real>(joint.orientation[3 * r + c]);
    h.m[r][3] = static_cast<Real>(joint.offset[r]) * 1e6L;
  }
  return h;
}

Htm exact_error(const SmallMotion& e) {
  return shifted({static_cast<Real>(e[0]), static_cast<Real>(e[1]), static_cast<Real>(e[2])}) *
         turned(0, static_cast<Real>(e[3])) * turned(1, static_cast<Real>(e[4])) *
         turned(2, static_cast<Real>(e[5]));
}

SmallMotion random_error(Random& random) {
  SmallMotion e;
  for (std::size_t c = 0; c < 6; ++c)
    e[c] = static_cast<float>(c < 3 ? random.in(-2e4, 2e4) : random.in(-1e-4, 1e-4));
  return e;
}

// nm, of points up to a metre away on each axis.
Real largest_difference(const Htm& a, const Htm& b) {
  Real largest = 0;
  for (const Real3& p : {Real3{1e9L, 0, 0}, Real3{0, 1e9L, 0}, Real3{0, 0, 1e9L},
                         Real3{-1e9L, 1e9L, -1e9L}, Real3{0, 0, 0}}) {
    const Real3 x = a.apply(p);
    const Real3 y = b.apply(p);
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs(x[i] - y[i]));
  }
  return largest;
}

// Third order: 1e-12 of a metre, 1e-3 nm. The last place of a float is up to 4e-3 nm of 2^16 nm and
// 7e-3 nm of an angle of 1e-4 with a lever of a metre; some ten of them add up.
constexpr Real kTolerance_nm = 0.05L;

TEST(FixedBodies, AnErrorIsTheSameMotionInTheFrameOfTheCarrier) {
  Random random(130);
  SCOPED_TRACE(random.trace());
  Real worst = 0;
  for (int n = 0; n < 2'000; ++n) {
    const Joint joint =
        fixed_joint({random.in(-300, 300), random.in(-300, 300), random.in(-300, 300)},
                    random.in(-3, 3), random.in(-3, 3));
    FixedFrame at;
    at.extend_by(joint);
    const SmallMotion e = random_error(random);
    const Htm H = exact_frame(joint);
    const Htm moved = exact_error(at.error_of_carrier(e));
    const Real off = largest_difference(moved * H, H * exact_error(e));
    worst = std::max(worst, off);
    ASSERT_LT(off, kTolerance_nm);
  }
  RecordProperty("worst_pm", static_cast<int>(worst * 1e3L));
}

TEST(FixedBodies, FramesOneOnAnotherAreTheirProduct) {
  Random random(131);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 200; ++n) {
    FixedFrame at;
    Htm exact;
    for (int k = 0; k < 3; ++k) {
      const Joint joint =
          fixed_joint({random.in(-300, 300), random.in(-300, 300), random.in(-300, 300)},
                      random.in(-3, 3), random.in(-3, 3));
      at.extend_by(joint);
      exact = exact * exact_frame(joint);
    }
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(at.R[3 * r + c], static_cast<double>(exact.m[r][c]), 1e-6);
      ASSERT_NEAR(at.t_nm[r], static_cast<double>(exact.m[r][3]), 300.0);  // of up to 1.6e9
    }
  }
}

TEST(FixedBodies, OneErrorAfterAnotherIsTheirProduct) {
  Random random(132);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 2'000; ++n) {
    const SmallMotion e = random_error(random);
    const SmallMotion f = random_error(random);
    SmallMotion both = e;
    act_after(both, f, true);
    ASSERT_LT(largest_difference(exact_error(both), exact_error(e) * exact_error(f)),
              kTolerance_nm);
  }
}

// A row holds a value and the difference to the next one.
TEST(FixedBodies, WhatIsInterpolatedStaysInterpolated) {
  Random random(133);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 2'000; ++n) {
    const SmallMotion here = random_error(random);
    const SmallMotion next = random_error(random);
    const SmallMotion f = random_error(random);
    SmallMotion value = here;
    SmallMotion difference;
    for (std::size_t c = 0; c < 6; ++c)
      difference[c] = next[c] - here[c];
    SmallMotion at_next = next;
    act_after(value, f, true);
    act_after(difference, f, false);
    act_after(at_next, f, true);
    for (std::size_t c = 0; c < 6; ++c)
      ASSERT_NEAR(value[c] + difference[c], at_next[c], c < 3 ? 0.02 : 3e-11) << c;
  }
}

// --- in a machine --------------------------------------------------------------------------------

std::uint8_t hang(MachineDescription& d, Body body, std::uint8_t lower) {
  body.lower = lower;
  d.body[d.body_count] = body;
  return ++d.body_count;
}

Body fixed_body(const Joint& joint, const std::array<double, 6>& error) {
  Body body;
  body.joint = joint;
  body.constant_error = error;
  return body;
}

Body askew(Axis axis, JointKind kind, int sign, std::uint8_t nc, char letter,
           const std::array<double, 3>& offset, double about_z, double about_x) {
  Body body = moving_body(0, kind, axis, sign, nc, letter, offset);
  body.joint.orientation = turned_by(about_z, about_x);
  return body;
}

// Y, A and C carry the work, X and Z the tool, every joint built in askew. Fixed bodies with errors
// on the bed below both branches, between the axes, two of them one on the other, and at the tips.
MachineDescription machine_of_fixed_bodies() {
  constexpr JointKind kLinear = JointKind::prismatic;
  constexpr JointKind kTurns = JointKind::rotary;
  MachineDescription d;
  d.body_count = 1;
  const auto foot = hang(
      d, fixed_body(fixed_joint({5, 6, 7}, 0.1, -0.05), {2e-3, -1e-3, 3e-3, 2e-5, -3e-5, 4e-5}), 1);
  const auto y = hang(d, askew(Axis::y, kLinear, -1, 1, 'Y', {0, 10, 0}, 0.2, 0.1), foot);
  const auto lower = hang(
      d, fixed_body(fixed_joint({-90, 80, 70}, -0.3, 0.2), {-4e-3, 2e-3, 1e-3, -3e-5, 5e-5, 1e-5}),
      y);
  const auto upper = hang(
      d, fixed_body(fixed_joint({30, -20, 110}, 0.4, 0.3), {1e-3, 3e-3, -2e-3, 5e-5, -2e-5, 6e-5}),
      lower);
  const auto a = hang(d, askew(Axis::x, kTurns, -1, 3, 'A', {50, 20, 180}, -0.5, 0.2), upper);
  const auto plain = hang(d, fixed_body(fixed_joint({4, 5, 6}, 0.2, 0.0), {}), a);
  const auto c = hang(d, askew(Axis::z, kTurns, -1, 4, 'C', {0.1, 3, 60}, 0.1, -0.4), plain);
  d.work_body = hang(
      d, fixed_body(fixed_joint({1, 2, 60}, 0.7, 0.6), {1e-3, 1e-3, -2e-3, 4e-5, 2e-5, -5e-5}), c);
  const auto column =
      hang(d, fixed_body(fixed_joint({0, 500, 0}, -0.2, 0.1), {0, 2e-3, 0, 3e-5, 1e-5, 2e-5}), 1);
  const auto x = hang(d, askew(Axis::x, kLinear, 1, 0, 'X', {40, 30, 700}, 0.1, 0.2), column);
  const auto z = hang(d, askew(Axis::z, kLinear, 1, 2, 'Z', {0, -15, 80}, -0.1, 0.1), x);
  d.tool_body = hang(
      d, fixed_body(fixed_joint({3, -2, -40}, 0.9, -0.3), {1e-3, 0, 5e-3, -2e-5, 6e-5, 3e-5}), z);
  d.tool_point = {2, -3, -220};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

TEST(FixedBodies, OnlyThoseOnTheBedAreStepsOfAWalk) {
  const RuntimeChain chain = make_runtime_chain(machine_of_fixed_bodies());
  ASSERT_EQ(chain.steps, 5 + 2);
  EXPECT_EQ(chain.tool_steps, 3);
  EXPECT_EQ(chain.step[2].kind, JointKind::fixed);
  EXPECT_EQ(chain.step[3].kind, JointKind::fixed);
  EXPECT_EQ(chain.inverse.form, InverseForm::constant);
}

TEST(FixedBodies, OffsetsAreThoseOfTheExactChain) {
  const MachineDescription d = machine_of_fixed_bodies();
  Random random(134);
  SCOPED_TRACE(random.trace());
  MachineTables tables;
  tables.machine = d;
  for (std::size_t a = 0; a < 3; ++a) {
    tables.axis[a] = random_table(-250'000'000, 33'333'333, 16, 8e3, 30e-6, random);
    tables.directions[a] =
        Vec3(random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5));
  }
  tables.axis[3] = random_table(-kTurn * 110 / 360, kTurn * 10 / 360, 23, 8e3, 30e-6, random);
  tables.axis[4] = whole_turn(37, 8e3, 30e-6, random);
  for (AxisTable& t : tables.axis)
    t.value[1] = t.value[0];  // by position only; directions have their own tests
  LoadedRunner runner(d);
  ASSERT_TRUE(runner.start(tables).ok());
  MachineModel model(tables, d.tool_point);
  const std::array<Real3, 3> J = jacobian(d);
  double worst = 0.0;
  for (int n = 0; n < kManyPoints / 20; ++n) {
    const std::array<std::int64_t, kMaxAxes> q{
        random.integer(-280'000'000, 280'000'000), random.integer(-280'000'000, 280'000'000),
        random.integer(-280'000'000, 280'000'000), random.integer(-kTurn / 3, kTurn / 3),
        random.integer(-8 * kTurn, 8 * kTurn)};
    runner.tick({q[0], q[1], q[2], q[3], q[4]});
    model.stand_at(q, {});
    const Real3 want = cancelling(J, model.exact());
    for (std::size_t c = 0; c < 3; ++c) {
      const Real off = static_cast<Real>(runner.out.offset[c]) - want[c];
      worst = std::max(worst, static_cast<double>(std::abs(off)));
    }
    ASSERT_LT(worst, 1.0) << "point " << n;
  }
  RecordProperty("worst_pm", static_cast<int>(worst * 1e3));
}

// Two axes along one line correct nothing that the third does not: refused before it runs.
TEST(FixedBodies, AxesWithoutAuthorityAreRefusedWithTheTables) {
  MachineDescription d = table_table();
  d.body[5].joint.axis = Axis::y;  // Z lies along Y
  MachineTables tables;
  tables.machine = d;
  Random random(135);
  for (std::size_t a = 0; a < 4; ++a)
    tables.axis[a] = random_table(-kTurn / 4, kTurn / 36, 19, 0, 0, random);
  for (std::size_t a = 0; a < 3; ++a)
    tables.axis[a] = random_table(-250'000'000, 33'333'333, 16, 0, 0, random);
  tables.axis[4] = whole_turn(36, 0, 0, random);
  LoadedRunner runner(d);
  EXPECT_EQ(runner.start(tables).reason, Reason::no_authority);
}

}  // namespace
}  // namespace volcomp::test
