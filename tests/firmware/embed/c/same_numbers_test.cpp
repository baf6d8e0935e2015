// What comes out of volcomp.h is what the C++ classes compute, bit for bit, and what an independent
// model of the machine gives.

#include "tests/firmware/embed/c/support.hpp"

namespace volcomp::test {
namespace {

// Samples as a bad day brings them.
void disturb(AxisSample& sample, Random& random) {
  sample.position += random.integer(-40'000'000, 40'000'000);
  sample.valid = !random.chance(0.02);
  sample.homed = !random.chance(0.01);
}

TEST(CInterface, EveryTickIsThatOfTheClass) {
  Random random(1);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = random_l300g(2);
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables, {}).ok());
  CInstance c;
  ASSERT_EQ(c.stage(encode(tables)).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
  volcomp_input in{};
  volcomp_output out{};
  std::array<std::int64_t, VOLCOMP_AXES> largest{};
  for (int n = 0; n < 50'000; ++n) {
    for (std::size_t a = 0; a < 4; ++a) {
      AxisSample& sample = runner.in.axis[a];
      if (n % 100 == 0) disturb(sample, random);
      sample.position += random.integer(-20'000, 21'000);
      in.axis[a] = {sample.position, sample.valid, sample.homed};
    }
    if (n == 20'000) {
      runner.compensator->deactivate();
      volcomp_deactivate(c.get());
    }
    if (n == 30'000) {
      ASSERT_TRUE(runner.swap(tables).ok());
      ASSERT_EQ(c.stage(encode(tables)).reason, VOLCOMP_OK);
      ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
    }
    runner.tick();
    volcomp_tick(c.get(), &in, &out);
    for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
      ASSERT_EQ(out.offset[a], runner.out.offset[a]) << "tick " << n << ", axis " << a;
      ASSERT_EQ(out.status[a], runner.out.status[a]) << "tick " << n << ", axis " << a;
      largest[a] = std::max<std::int64_t>(largest[a], std::abs(std::int64_t{out.offset[a]}));
    }
  }
  volcomp_diagnostics d;
  volcomp_diagnose(c.get(), &d);
  const auto expected = runner.compensator->diagnostics();
  EXPECT_EQ(d.ticks, 50'000U);
  EXPECT_EQ(d.activations, 2U);
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    EXPECT_EQ(d.largest[a], largest[a]);
    EXPECT_EQ(volcomp_direction(c.get(), a), static_cast<int>(runner.compensator->direction(a)));
    for (std::size_t bit = 0; bit < VOLCOMP_STATUS_BITS; ++bit)
      EXPECT_EQ(d.began[a][bit], expected.began[a][bit]);
  }
}

volcomp_touch c_touch(const Touch& touch) {
  volcomp_touch t{};
  t.sequence = touch.sequence;
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    const LatchedAxis& l = touch.latched[a];
    t.axis[a] = {l.position, l.velocity, static_cast<int>(l.direction)};
  }
  return t;
}

Vec3 base(const volcomp_point& point) {
  return {static_cast<double>(point.machine[0]), static_cast<double>(point.machine[1]),
          static_cast<double>(point.machine[2])};
}

// The ball centre of a tool, to the nanometre that points are rounded to.
TEST(CInterface, TouchedPointsAreThoseOfTheModelWithEitherTool) {
  Random random(3);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = random_l300g(4);
  const std::array<double, 3> longer{1.0, -2.0, -230.5};
  CInstance c;
  c.start(tables);
  for (const bool changed : {false, true}) {
    const std::array<double, 3> tool = changed ? longer : tables.machine.tool_point;
    if (changed) {
      ASSERT_EQ(c.stage(encode(tables), tool.data()).reason, VOLCOMP_OK);
      ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
    }
    c.tick(random_probing_pose(random));
    c.tick(random_probing_pose(random));
    MachineModel model(tables, tool);
    for (int i = 0; i < 1'000; ++i) {
      Touch touch = touch_at(random_probing_pose(random));
      touch.sequence = static_cast<std::uint32_t>(i);
      std::array<std::int64_t, kMaxAxes> q{};
      for (std::size_t a = 0; a < 4; ++a)
        q[a] = touch.latched[a].position;
      model.stand_at(q, {});
      const volcomp_touch latched = c_touch(touch);
      const volcomp_feature centre{9, {0.0, 0.0, 0.0}};
      volcomp_point point;
      ASSERT_EQ(volcomp_correct_touch(c.get(), &latched, &centre, &point).reason, VOLCOMP_OK);
      EXPECT_EQ(point.verdict, VOLCOMP_CENTRE);
      EXPECT_EQ(point.sequence, touch.sequence);
      EXPECT_EQ(point.feature, 9U);
      const Vec3 expected = vec(model.nominal()) + vec(model.exact());
      ASSERT_LT((base(point) - expected).cwiseAbs().maxCoeff(), 1.0);
    }
  }
}

// Delays, lobing, the frame of the part and the uncertainty, as the corrector has them.
TEST(CInterface, EveryPointIsThatOfTheClass) {
  Random random(5);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = random_l300g(6);
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  CInstance c;
  c.start(tables);
  const auto q = random_probing_pose(random);
  for (int n = 0; n < 2; ++n) {
    runner.tick({q[0], q[1], q[2], q[3], 0});
    c.tick(q);
  }
  ProbeCorrector corrector = probing_corrector();
  ProbeSettings& s = corrector.settings;
  volcomp_probe_settings cs;
  volcomp_default_probe_settings(&cs);
  s.probe_delay_s = cs.delay_s = 1.2e-4;
  for (std::size_t k = 0; k < VOLCOMP_RADIUS_TERMS; ++k)
    s.radius.coefficient[k] = cs.radius[k] = k == 0 ? 1.5e6 : random.in(-300.0, 300.0);
  s.workpiece.R = axis_rotation(Axis::y, 0.7) * axis_rotation(Axis::z, -0.2);
  for (int r = 0; r < 3; ++r) {
    s.workpiece.t[r] = cs.translation[r] = random.in(-1e7, 1e7);
    for (int k = 0; k < 3; ++k)
      cs.rotation[3 * r + k] = s.workpiece.R(r, k);
  }
  cs.uncertainty = {50.0, 300.0, 0.5, 120.0, 200.0, 1e-3, 1e-6, {}, {}};
  s.uncertainty = {50.0, 300.0, 0.5, 120.0, 200.0, 1e-3, 1e-6, {}, {}};
  for (std::size_t a = 0; a < 4; ++a) {
    s.latch_delay_s[a] = cs.latch_delay_s[a] = random.in(0.0, 1e-5);
    s.uncertainty.position[a] = cs.uncertainty.position[a] = a < 2 ? 20.0 : 1e-6;
    s.uncertainty.latch_delay_s[a] = cs.uncertainty.latch_delay_s[a] = 1e-7;
  }
  ASSERT_EQ(volcomp_configure_probe(c.get(), &cs).reason, VOLCOMP_OK);
  int retracting = 0;
  for (int i = 0; i < 1'000; ++i) {
    Touch touch = touch_at(random_probing_pose(random));
    for (std::size_t a = 0; a < 4; ++a) {
      touch.latched[a].velocity = random.in(-1e7, 1e7);
      touch.latched[a].direction = static_cast<Direction>(random.integer(0, 2));
    }
    const Vec3 n = Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)).normalized();
    const ProbePoint expected =
        corrector.correct(touch, {3, n}, runner.compensator->error_at(touch.latched));
    const volcomp_touch latched = c_touch(touch);
    const volcomp_feature feature{3, {n[0], n[1], n[2]}};
    volcomp_point point;
    ASSERT_EQ(volcomp_correct_touch(c.get(), &latched, &feature, &point).reason, VOLCOMP_OK);
    ASSERT_EQ(point.verdict, static_cast<int>(expected.verdict));
    const bool away = expected.verdict == TouchVerdict::retracting;
    retracting += away ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(point.workpiece[k], away ? 0 : expected.workpiece[k]);
      ASSERT_EQ(point.machine[k], away ? 0 : expected.machine[k]);
      ASSERT_EQ(point.uncertainty[k], away ? 0.0F : expected.uncertainty[k]);
    }
  }
  EXPECT_GT(retracting, 100);
  EXPECT_LT(retracting, 900);
}

}  // namespace
}  // namespace volcomp::test
