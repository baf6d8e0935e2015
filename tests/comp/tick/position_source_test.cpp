// Where E is taken: target mode at command + last offset, actual mode at the position itself.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

MachineTables steep_tables(Random& random) {
  MachineTables t = xyfz_tables(60e3, 8e-5, random);
  for (AxisTable& axis : t.axis)
    axis.value[1] = axis.value[0];
  return t;
}

// Error in nm at integer positions.
Real3 error_at(MachineModel& model, const LoadedRunner::Positions& q) {
  model.stand_at({q[0], q[1], q[2]}, {});
  return model.first_order();
}

LoadedRunner::Positions corrected(const LoadedRunner& runner, LoadedRunner::Positions q) {
  for (std::size_t a = 0; a < 3; ++a)
    q[a] += runner.out.offset[a];
  return q;
}

TEST(PositionSource, ActualModeSubtractsTheErrorAtThePosition) {
  Random random(70);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = steep_tables(random);
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(tables).ok());
  MachineModel model(tables, kXyfzMachine.tool_point);
  const LoadedRunner::Positions q{-222'222'222, -111'111'111, -333'333'333, 0, 0};
  for (int n = 0; n < 5; ++n) {
    runner.tick(q);
    const Real3 e = error_at(model, q);
    for (std::size_t a = 0; a < 3; ++a)
      ASSERT_LT(std::abs(static_cast<double>(runner.out.offset[a] + e[a])), 1.0) << "tick " << n;
  }
}

// Standing still, the offset solves q_c + E(q_c) = p: what is left is arithmetic and rounding.
TEST(PositionSource, TargetModeSettlesOnTheFixedPoint) {
  Random random(71);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = steep_tables(random);
  LoadedRunner runner(kXyfzMachine);
  auto settings = open_settings<5>();
  settings.source = PositionSource::target;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  MachineModel model(tables, kXyfzMachine.tool_point);
  double one_shot = 0.0;
  for (int n = 0; n < 500; ++n) {
    const LoadedRunner::Positions p{random.integer(-490'000'000, -10'000'000),
                                    random.integer(-290'000'000, -10'000'000),
                                    random.integer(-390'000'000, -10'000'000), 0, 0};
    for (int settle = 0; settle < 4; ++settle)
      runner.tick(p);
    const Real3 e = error_at(model, corrected(runner, p));
    const Real3 uncorrected = error_at(model, p);
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_LT(std::abs(static_cast<double>(runner.out.offset[a] + e[a])), 1.0) << "point " << n;
      one_shot = std::max(one_shot, std::abs(static_cast<double>(uncorrected[a] - e[a])));
    }
  }
  EXPECT_GT(one_shot, 10.0) << "the tables must tell target mode from actual mode";
}

// In motion the residual is at most ‖J‖·‖E_k − E_(k−1)‖, plus rounding.
TEST(PositionSource, TargetModeTracksWithinTheBound) {
  Random random(72);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = steep_tables(random);
  LoadedRunner runner(kXyfzMachine);
  auto settings = open_settings<5>();
  settings.source = PositionSource::target;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  MachineModel model(tables, kXyfzMachine.tool_point);
  const double contraction = runner.compensator->fold_report().contraction;
  ASSERT_GT(contraction, 0.0);
  LoadedRunner::Positions p{-450'000'000, -270'000'000, -350'000'000, 0, 0};
  for (int settle = 0; settle < 4; ++settle)
    runner.tick(p);
  Real3 before = error_at(model, corrected(runner, p));
  for (int n = 0; n < 250; ++n) {  // 1.6 m/s at 1 ms
    p[0] += 1'600'000;
    p[1] += 900'000;
    p[2] += 1'200'000;
    runner.tick(p);
    const Real3 e = error_at(model, corrected(runner, p));
    double change = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      change += std::abs(static_cast<double>(e[a] - before[a]));
    for (std::size_t a = 0; a < 3; ++a) {
      const double residual = std::abs(static_cast<double>(runner.out.offset[a] + e[a]));
      ASSERT_LE(residual, 3.0 * contraction * change + 1.0) << "tick " << n;
    }
    before = e;
  }
}

// The sign that decides everything: the corrected machine is where it was commanded to be.
TEST(PositionSource, MotionSubtractsTheError) {
  MachineTables tables;
  tables.machine = kXyfzMachine;
  for (std::size_t a = 0; a < 3; ++a) {
    tables.axis[a].q0 = -100'000'000;
    tables.axis[a].pitch = 100'000'000;
    tables.axis[a].knots = 2;
    for (auto& column : tables.axis[a].value)
      column[0][a] = column[1][a] = 7'000.0F;  // body moves 7 µm too far along its axis
  }
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(tables).ok());
  runner.tick({0, 0, 0, 0, 0});
  // a workpiece 7 µm too far along +X leaves the tool 7 µm short: NC X has to go on by 7 µm
  EXPECT_EQ(runner.out.offset[0], 7'000);
  EXPECT_EQ(runner.out.offset[1], 7'000);
  EXPECT_EQ(runner.out.offset[2], -7'000);
}

// A rotary correcting axis: its offset is fed back in 2^-32 turn, not in run-time units.
TEST(PositionSource, RotaryFeedbackIsInTheRightUnit) {
  MachineTables t;
  MachineDescription& d = t.machine;
  d.body_count = 2;
  d.body[1] = moving_body(1, JointKind::rotary, Axis::y, 1, 0, 'B');
  d.tool_body = 2;
  d.work_body = 1;
  d.tool_point = {-200, 0, 0};
  d.correcting = {0};
  d.correcting_count = 1;
  t.axis[0].q0 = -kTurn / 8;
  t.axis[0].pitch = kTurn / 64;
  t.axis[0].knots = 17;
  for (auto& column : t.axis[0].value) {
    for (std::uint32_t i = 0; i < 17; ++i)
      column[i][4] = 1e-4F * static_cast<float>(i);  // 100 µrad per 5.6°: 1.0 mrad/rad
  }
  LoadedRunner runner(d);
  auto settings = open_settings<5>();
  settings.source = PositionSource::target;
  ASSERT_TRUE(runner.start(t, settings).ok());
  for (int n = 0; n < 10; ++n)
    runner.tick({kTurn / 50, 0, 0, 0, 0});
  // EB(q + dB) = −dB with EB = slope·(q − q0)
  const double rad = 2.0 * 3.14159265358979323846;
  const double slope = 1e-4 / (rad / 64);
  const double q = rad / 50;
  const double dB = -slope * (q + rad / 8) / (1.0 + slope);
  const double second_order = 0.5 * std::pow(1e-4 * 9.3, 2);  // rotation against displacement
  EXPECT_NEAR(runner.out.offset[0], dB / rad * 4294967296.0,
              1.0 + second_order / rad * 4294967296.0 * 2e-3);
}

}  // namespace
}  // namespace volcomp::test
