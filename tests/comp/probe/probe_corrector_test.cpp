// Points beside an independent long double model of the machine, its tables and its probe.

#include "comp/probe/probe_corrector.hpp"

#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

using Runner5 = Runner<LoadedCompensator>;

// The tables are active, every axis is known.
void start(Runner5& runner, const MachineTables& tables) {
  ASSERT_TRUE(runner.start(tables).ok());
  runner.tick({100'000'000, 230'000'000, 0, 0, 0});
  runner.tick();
  ASSERT_TRUE(runner.compensator->active());
}

// The ball centre as the model sees it, base frame.
Vec3 model_centre(const MachineTables& tables, const Touch& touch) {
  MachineModel model(tables, tables.machine.tool_point);
  std::array<std::int64_t, kMaxAxes> q{};
  std::array<int, kMaxAxes> travel{};
  for (std::size_t a = 0; a < 4; ++a) {
    q[a] = touch.latched[a].position;
    travel[a] = static_cast<int>(touch.latched[a].direction);
  }
  model.stand_at(q, travel);
  return vec(model.nominal()) + vec(model.exact());
}

TEST(ProbeCorrector, CentreIsWithinANanometreOfTheModel) {
  Random random(10);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = probing_tables(4e3, 7e-5, random);
  Runner5 runner(tables.machine);
  start(runner, tables);
  const ProbeCorrector corrector = probing_corrector();
  double worst = 0.0;
  for (int i = 0; i < kManyPoints / 100; ++i) {
    Touch touch = touch_at(random_probing_pose(random));
    for (LatchedAxis& axis : touch.latched)
      axis.direction = static_cast<Direction>(random.integer(0, 2));
    const PoseError error = runner.compensator->error_at(touch.latched);
    ASSERT_TRUE(error.known && error.within);
    const ProbePoint point = corrector.correct(touch, {}, error);
    EXPECT_EQ(point.verdict, TouchVerdict::centre);
    worst =
        std::max(worst, (vec(point.machine) - model_centre(tables, touch)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 1.0);
  EXPECT_GT(worst, 0.0);
}

// A folded machine has the levers in its tables.
TEST(ProbeCorrector, WorksOnLinearMachinesToo) {
  Random random(11);
  const MachineTables tables = xyfz_tables(5e3, 2e-5, random);
  Runner5 runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  runner.tick({-1'000'000, -1'000'000, -1'000'000, 0, 0});
  runner.tick();
  const ProbeCorrector corrector = corrector_of(tables.machine);
  for (int i = 0; i < 1000; ++i) {
    Touch touch;
    std::array<std::int64_t, kMaxAxes> q{random.integer(-500'000'000, 0),
                                         random.integer(-300'000'000, 0),
                                         random.integer(-400'000'000, 0)};
    for (std::size_t a = 0; a < 3; ++a)
      touch.latched[a] = {q[a], 0.0, Direction::backward};
    MachineModel model(tables, tables.machine.tool_point);
    model.stand_at(q, {1, 1, 1});
    const ProbePoint point =
        corrector.correct(touch, {}, runner.compensator->error_at(touch.latched));
    EXPECT_LT((vec(point.machine) - vec(model.nominal()) - vec(model.first_order()))
                  .cwiseAbs()
                  .maxCoeff(),
              1.0);
  }
}

TEST(ProbeCorrector, RadiusGoesAlongTheNormalOfThePart) {
  Random random(12);
  ProbeCorrector corrector = probing_corrector();
  corrector.settings.radius.coefficient[0] = 1.4935e6;
  for (int i = 0; i < 200; ++i) {
    const Touch touch = touch_at(random_probing_pose(random));
    const Vec3 n = Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)).normalized();
    ProbeFeature feature{7, n};
    const ProbePoint centre = corrector.correct(touch, {}, {});
    const ProbePoint point = corrector.correct(touch, feature, {});
    EXPECT_LT((vec(point.workpiece) - vec(centre.workpiece) + 1.4935e6 * n).norm(), 1.8);
    EXPECT_NEAR((vec(point.machine) - vec(centre.machine)).norm(), 1.4935e6, 1.8);
    EXPECT_EQ(point.feature, 7U);
  }
}

// The part turned and shifted on the table: the same material point has the same coordinates.
TEST(ProbeCorrector, WorkpieceFrameFollowsThePart) {
  Random random(13);
  ProbeCorrector corrector = probing_corrector();
  const Touch touch = touch_at(random_probing_pose(random));
  const Vec3 work = vec(corrector.correct(touch, {}, {}).workpiece);
  corrector.settings.workpiece.R = axis_rotation(Axis::z, 0.3) * axis_rotation(Axis::x, -1.1);
  corrector.settings.workpiece.t = {4e6, -5e6, 6e6};
  const Vec3 part = vec(corrector.correct(touch, {}, {}).workpiece);
  EXPECT_LT((corrector.settings.workpiece.apply(part) - work).norm(), 1.8);
}

// Turning the gear by an angle turns the point with it.
TEST(ProbeCorrector, ThePointTurnsWithTheGear) {
  Random random(14);
  const ProbeCorrector corrector = probing_corrector();
  auto q = random_probing_pose(random);
  const Vec3 before = vec(corrector.correct(touch_at(q), {}, {}).workpiece);
  q[3] += kUnitsPerTurn / 12;
  const Vec3 after = vec(corrector.correct(touch_at(q), {}, {}).workpiece);
  EXPECT_LT((axis_rotation(Axis::x, -kPi / 6.0) * before - after).norm(), 1.8);
}

// --- verdicts

Touch moving(double mm_per_s, const Vec3& direction) {
  Random random(15);
  auto q = random_probing_pose(random);
  q[3] = 0;
  Touch touch = touch_at(q);
  touch.latched[0].velocity = mm_per_s * kNmPerMm * direction.x();
  touch.latched[1].velocity = mm_per_s * kNmPerMm * direction.y();
  return touch;
}

TEST(ProbeCorrector, RetractingIsTold) {
  const ProbeCorrector corrector = probing_corrector();
  const PoseError fine{Vec3::Zero(), true, true};
  const ProbeFeature face{1, Vec3(0.0, 1.0, 0.0)};
  EXPECT_EQ(corrector.correct(moving(5.0, {0, -1, 0}), face, fine).verdict, TouchVerdict::point);
  EXPECT_EQ(corrector.correct(moving(5.0, {0, 1, 0}), face, fine).verdict,
            TouchVerdict::retracting);
  EXPECT_EQ(corrector.correct(moving(5.0, {1, 0, 0}), face, fine).verdict,
            TouchVerdict::retracting);
  EXPECT_EQ(corrector.correct(moving(0.0, {1, 0, 0}), face, fine).verdict,
            TouchVerdict::retracting);
  EXPECT_EQ(corrector.correct(moving(5.0, {0, 1, 0}), {}, fine).verdict, TouchVerdict::centre);
}

TEST(ProbeCorrector, TablesThatDoNotReachAreTold) {
  Random random(16);
  const MachineTables tables = probing_tables(4e3, 7e-5, random);
  const ProbeCorrector corrector = probing_corrector();
  Runner5 runner(tables.machine);
  Touch touch = touch_at(random_probing_pose(random));
  EXPECT_EQ(corrector.correct(touch, {}, runner.compensator->error_at(touch.latched)).verdict,
            TouchVerdict::uncorrected);
  start(runner, tables);
  touch.latched[0].position = 300'000'000;
  const ProbePoint end = corrector.correct(touch, {}, runner.compensator->error_at(touch.latched));
  EXPECT_EQ(end.verdict, TouchVerdict::centre);
  touch.latched[0].position = 300'000'100;
  const ProbePoint beyond =
      corrector.correct(touch, {}, runner.compensator->error_at(touch.latched));
  EXPECT_EQ(beyond.verdict, TouchVerdict::uncertified);
  EXPECT_NEAR(static_cast<double>(beyond.machine[0] - end.machine[0]), 100.0, 1.0);
}

}  // namespace
}  // namespace volcomp::test
