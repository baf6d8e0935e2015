// The direction of an axis is that of its position with the offset that its drive has, and a
// reversal never leads to another one for ever.

#include <algorithm>

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr LoadedRunner::Positions kMiddle{-250'000'000, -150'000'000, -200'000'000, 0, 0};

// The same values at all knots of an axis: EXX forward and backward for X; EXY falls by 20 µm over
// the travel of Y.
MachineTables tables_that_push_x(float forward_nm, float backward_nm) {
  Random random(300);
  MachineTables t = xyfz_tables(0.0, 0.0, random);
  t.directions.fill(Vec3::Zero());
  for (std::size_t i = 0; i < 11; ++i) {
    t.axis[0].value[0][i][0] = forward_nm;
    t.axis[0].value[1][i][0] = backward_nm;
    for (auto& column : t.axis[1].value)
      column[i][0] = -2'000.0F * static_cast<float>(i);
  }
  return t;
}

CompensatorSettings<5> target_settings(std::int32_t hysteresis) {
  auto settings = open_settings<5>();
  settings.source = PositionSource::target;
  for (AxisLimits& l : settings.axis)
    l.hysteresis = hysteresis;
  return settings;
}

// X comes forward and stands; Y then moves, and its straightness takes X back by more than the
// hysteresis, on the other flank of the screw. The offset has to be that of a motion backward.
class AnotherAxisMovesIt : public ::testing::Test {
 protected:
  // The offset of X after Y has moved, less what it is by the straightness of Y.
  static std::int32_t offset_of_x(PositionSource source, std::int32_t hysteresis) {
    // X carries the work: its offset is +EXX, and that of a lost motion of 4 µm goes along.
    const MachineTables tables = tables_that_push_x(4'000.0F, 0.0F);
    LoadedRunner runner(kXyfzMachine);
    auto settings = target_settings(hysteresis);
    settings.source = source;
    EXPECT_TRUE(runner.start(tables, settings).ok());
    LoadedRunner::Positions q = kMiddle;
    for (int n = 0; n < 20; ++n)
      runner.tick(q = {q[0] + 10'000, q[1], q[2], 0, 0});
    const std::int32_t before = runner.out.offset[0];
    for (int n = 0; n < 120; ++n)
      runner.tick(q = {q[0], q[1] + 1'000'000, q[2], 0, 0});
    EXPECT_LT(runner.out.offset[0], before - 5'000) << "Y takes X back";
    return runner.out.offset[0] - before;
  }
};

TEST_F(AnotherAxisMovesIt, AStandingAxisHasTurnedWhereTheOffsetTookItBack) {
  const std::int32_t turned = offset_of_x(PositionSource::target, 2'000);
  const std::int32_t not_turned = offset_of_x(PositionSource::target, 100'000);
  EXPECT_NEAR(turned - not_turned, -4'000, 2);
}

// An encoder shows what the offset did to the axis: nothing is added to its position.
TEST_F(AnotherAxisMovesIt, PositionsOfAnEncoderCountAsTheyAre) {
  EXPECT_NEAR(
      offset_of_x(PositionSource::actual, 2'000) - offset_of_x(PositionSource::actual, 100'000), 0,
      2);
}

// The own correction takes the axis forward by more than the hysteresis when it has turned
// backward: it must not turn forward by that, and back, for ever.
TEST(OffsetDirection, AReversalAgainstTheMotionIsNoReversal) {
  const MachineTables tables = tables_that_push_x(0.0F, 9'000.0F);
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(tables, target_settings(2'000)).ok());
  EXPECT_EQ(runner.compensator->fold_report().reversal_nm[0], 9'002) << "and 2 nm of rounding";
  LoadedRunner::Positions q = kMiddle;
  for (int n = 0; n < 20; ++n)
    runner.tick(q = {q[0] + 10'000, q[1], q[2], 0, 0});
  const std::int32_t forward = runner.out.offset[0];
  for (int n = 0; n < 20; ++n) {
    runner.tick({q[0] - 3'000, q[1], q[2], 0, 0});
    ASSERT_EQ(runner.out.offset[0], forward) << "within the hysteresis it needs, tick " << n;
  }
  runner.tick(q = {q[0] - 10'000, q[1], q[2], 0, 0});
  for (int n = 0; n < 20; ++n) {
    runner.tick(q);
    ASSERT_EQ(runner.out.offset[0], forward + 9'000) << "tick " << n;
  }
}

// Whatever tables and wherever the axes stop: with targets at rest the offsets come to rest, to the
// nanometre of rounding. `Run` has the machine.
template <class Run>
void expect_rest(Run& runner, const MachineDescription& machine, Random& random) {
  for (int set = 0; set < 60; ++set) {
    SCOPED_TRACE("tables " + std::to_string(set));
    MachineTables tables = xyfz_tables(random.in(0.0, 10e3), random.in(0.0, 1e-5), random, machine);
    typename std::decay_t<decltype(*runner.compensator)>::Settings settings;
    settings.ramp_ticks = 1;
    for (AxisLimits& l : settings.axis) {
      l = {{4'194'303, 1'000'000'000, 1'000'000'000, 0}, 0, 0};
      l.rate = static_cast<std::int32_t>(random.chance(0.5) ? 1'000'000'000
                                                            : random.integer(200, 5'000));
      l.soft_rate = l.rate;
      l.hysteresis = static_cast<std::int32_t>(random.integer(0, 5'000));
    }
    ASSERT_TRUE(runner.start(tables, settings).ok());
    for (int stop = 0; stop < 20; ++stop) {
      auto q = runner.in.axis;
      for (int n = 0; n < 40; ++n) {
        for (std::size_t a = 0; a < 3; ++a) {
          q[a].position = kMiddle[a] + random.integer(-100'000, 100'000);
          if (random.chance(0.5)) q[a].position = runner.in.axis[a].position;
        }
        runner.in.axis = q;
        runner.tick();
      }
      for (int n = 0; n < 1'000; ++n)
        runner.tick();
      const auto rest = runner.out.offset;
      for (int n = 0; n < 100; ++n) {
        runner.tick();
        for (std::size_t a = 0; a < 3; ++a)
          ASSERT_LE(std::abs(runner.out.offset[a] - rest[a]), 1)
              << "axis " << a << " stop " << stop;
      }
    }
  }
}

TEST(OffsetDirection, OffsetsComeToRestWithTheTargets) {
  Random random(301);
  SCOPED_TRACE(random.trace());
  LoadedRunner folded(kXyfzMachine);
  expect_rest(folded, kXyfzMachine, random);
  XyfzRunner compiled;
  expect_rest(compiled, kXyfzMachine, random);
}

}  // namespace
}  // namespace volcomp::test
