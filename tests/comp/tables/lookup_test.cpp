// Quantised tables at the edge of what the integer lookup can represent: accepted means usable.

#include "comp/core/units.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "comp/tables/image.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

Joint joint_of(JointKind kind) {
  Joint joint;
  joint.kind = kind;
  joint.letter = kind == JointKind::rotary ? 'C' : 'X';
  return joint;
}

ErrorTable rising(double q0, double pitch, std::size_t knots) {
  ErrorTable t;
  t.q0 = q0;
  t.pitch = pitch;
  t.knots = knots;
  for (std::size_t i = 0; i < knots; ++i) {
    t.forward[i] = ErrorMotion::Constant(1e-6 * static_cast<double>(i));
    t.backward[i] = t.forward[i];
  }
  return t;
}

// One rotary axis about Z under the tool, one error channel.
MachineTables one_rotary(std::int64_t q0, std::int64_t pitch, std::uint32_t knots) {
  MachineTables t;
  MachineDescription& d = t.machine;
  d.body_count = 2;
  d.body[1] = moving_body(1, JointKind::rotary, Axis::z, 1, 0, 'C');
  d.tool_body = 2;
  d.work_body = 1;
  d.tool_point = {100, 0, 0};
  d.correcting = {0};
  d.correcting_count = 1;
  t.axis[0].q0 = q0;
  t.axis[0].pitch = pitch;
  t.axis[0].knots = knots;
  for (auto& column : t.axis[0].value) {
    for (std::uint32_t i = 0; i < knots; ++i)
      column[i][2] = static_cast<float>(1'000 * i);  // EZ: no rotation can move it
  }
  return t;
}

// Whether staged tables, if they are accepted, interpolate EZ over the whole table.
void expect_refused_or_usable(const MachineTables& t) {
  LoadedRunner runner(t.machine);
  if (!runner.start(t).ok()) return;
  const AxisTable& axis = t.axis[0];
  for (int k = 0; k <= 40; ++k) {
    const std::int64_t segments = axis.knots - 1;
    const std::int64_t q = axis.q0 + (axis.pitch * segments / 40) * k;
    runner.tick({q, 0, 0, 0, 0});
    const double want =
        1'000.0 * static_cast<double>(q - axis.q0) / static_cast<double>(axis.pitch);
    const double slack = 1'000.0 * 256.0 * axis.knots / static_cast<double>(axis.pitch) + 0.01;
    EXPECT_NEAR(static_cast<double>(runner.compensator->last_error_nm()[2]), want, slack) << k;
    EXPECT_EQ(runner.out.status[0] & kOutOfRange, 0) << k;
  }
}

// An image has room for three correcting axes; what stands behind the last in use may be anything.
TEST(RotaryLookup, WhatStandsBehindTheCorrectingAxesIsNotRead) {
  MachineTables t = one_rotary(0, kTurn / 10, 11);
  t.machine.correcting = {0, 102, 255};
  const RuntimeChain chain = make_runtime_chain(t.machine);
  for (const std::uint8_t axis : chain.correcting)
    EXPECT_LT(axis, chain.axes);
  expect_refused_or_usable(t);
}

TEST(RotaryLookup, OrdinaryTable) {
  expect_refused_or_usable(one_rotary(-kTurn / 5, kTurn / 50, 20));
}

TEST(RotaryLookup, NearlyAWholeTurn) {
  expect_refused_or_usable(one_rotary(0, (kTurn - 1) / 10, 11));
}

TEST(RotaryLookup, AWholeTurnThatIsNotPeriodic) {
  expect_refused_or_usable(one_rotary(0, kTurn / 4, 5));
}

TEST(RotaryLookup, MoreThanATurn) { expect_refused_or_usable(one_rotary(-kTurn, kTurn / 4, 9)); }

// 255 units of 2^-40 turn are less than one unit of the lookup.
TEST(RotaryLookup, PitchBelowTheResolution) { expect_refused_or_usable(one_rotary(0, 255, 5)); }

TEST(Quantise, RefusesARotaryTableOfMoreThanATurn) {
  auto out = std::make_unique<AxisTable>();
  const Status status =
      quantise(rising(-2.0 * kPi, kPi / 4, 17), joint_of(JointKind::rotary), 128, *out);
  EXPECT_EQ(status.reason, Reason::travel_too_long);
  EXPECT_EQ(status.where.axis, 'C');
}

TEST(Quantise, RefusesALinearTableBeyond4_29Metres) {
  auto out = std::make_unique<AxisTable>();
  const Joint x = joint_of(JointKind::prismatic);
  EXPECT_EQ(quantise(rising(0.0, 2200.0, 3), x, 128, *out).reason, Reason::travel_too_long);
  EXPECT_TRUE(quantise(rising(0.0, 2147.483, 3), x, 128, *out).ok());
}

TEST(Quantise, RefusesWhatIsNoTable) {
  auto out = std::make_unique<AxisTable>();
  const Joint x = joint_of(JointKind::prismatic);
  EXPECT_EQ(quantise(rising(0.0, 10.0, 1), x, 128, *out).reason, Reason::too_few_knots);
  EXPECT_EQ(quantise(rising(0.0, 10.0, 129), x, 128, *out).reason, Reason::too_many_knots);
  EXPECT_EQ(quantise(rising(0.0, 0.0, 5), x, 128, *out).reason, Reason::pitch_not_positive);
  EXPECT_EQ(quantise(rising(0.0, -1.0, 5), x, 128, *out).reason, Reason::pitch_not_positive);
  EXPECT_EQ(quantise(rising(0.0, 1e-8, 5), x, 128, *out).reason, Reason::pitch_not_positive);
  EXPECT_EQ(quantise(rising(std::nan(""), 1.0, 5), x, 128, *out).reason, Reason::not_finite);
  ErrorTable bad = rising(0.0, 10.0, 5);
  bad.backward[3](4) = std::nan("");
  const Status status = quantise(bad, x, 128, *out);
  EXPECT_EQ(status.reason, Reason::not_finite);
  EXPECT_EQ(status.where.index, 3);
  EXPECT_EQ(status.where.channel, 4);
}

TEST(Quantise, AFullTurnBecomesPeriodicAndMustClose) {
  auto out = std::make_unique<AxisTable>();
  const Joint c = joint_of(JointKind::rotary);
  ErrorTable turn = rising(0.0, kPi / 18, 37);
  EXPECT_EQ(quantise(turn, c, 128, *out).reason, Reason::not_periodic);
  turn.forward[36] = turn.backward[36] = turn.forward[0];
  ASSERT_TRUE(quantise(turn, c, 128, *out).ok());
  EXPECT_TRUE(out->periodic);
  EXPECT_EQ(out->knots, 36U);
  EXPECT_LT(kTurn - out->pitch * 36, 36);
  EXPECT_GE(kTurn - out->pitch * 36, 0);
}

// Whatever quantise accepts, the image accepts as well, and the other way round.
TEST(Quantise, RoundTripsThroughDouble) {
  auto once = std::make_unique<AxisTable>();
  auto twice = std::make_unique<AxisTable>();
  auto table = std::make_unique<ErrorTable>();
  const Joint x = joint_of(JointKind::prismatic);
  ASSERT_TRUE(quantise(rising(-123.4567891, 7.7777777, 77), x, 128, *once).ok());
  dequantise(*once, x, *table);
  ASSERT_TRUE(quantise(*table, x, 128, *twice).ok());
  EXPECT_EQ(once->q0, twice->q0);
  EXPECT_EQ(once->pitch, twice->pitch);
  EXPECT_EQ(once->knots, twice->knots);
  EXPECT_EQ(once->value, twice->value);
}

}  // namespace
}  // namespace volcomp::test
