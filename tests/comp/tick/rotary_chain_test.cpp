// Machines with rotary axes: tick against the exact chain in long double, offsets against the
// closed formulas of the L300G, exact wrap-around of turning axes, and poses without authority.

#include <algorithm>

#include "tests/oracle/table_table_machine.hpp"

namespace volcomp::test {
namespace {

constexpr double kArm_mm = 173.7135;  // L_R of docs/papers/l300g.md
constexpr Real kWirePerRad = 4294967296.0L / (2 * 3.14159265358979323846264338327950288L);

// Probe arm on B on Y on X; the gear turns on A. X, Y and B correct.
MachineDescription l300g() {
  MachineDescription d;
  d.body_count = 5;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X', {173.0, 0, 0});
  d.body[2] = moving_body(2, JointKind::prismatic, Axis::y, 1, 1, 'Y', {0, -12.5, 0});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::y, 1, 2, 'B');
  d.body[4] = moving_body(1, JointKind::rotary, Axis::z, 1, 3, 'A', {-60, 5, -20});
  d.tool_body = 4;
  d.work_body = 5;
  d.tool_point = {-kArm_mm, 0, 0};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

MachineTables l300g_tables(double delta_nm, double epsilon, Random& random) {
  MachineTables t;
  t.machine = l300g();
  t.axis[0] = random_table(-120'000'000, 15'000'000, 17, delta_nm, epsilon, random);
  t.axis[1] = random_table(-80'000'000, 20'000'000, 9, delta_nm, epsilon, random);
  t.axis[2] = random_table(-kTurn / 4, kTurn / 36, 19, delta_nm, epsilon, random);  // ±90°
  t.axis[3] = whole_turn(36, delta_nm, epsilon, random);
  return t;
}

MachineTables table_table_tables(double delta_nm, double epsilon, Random& random) {
  MachineTables t;
  t.machine = table_table();
  for (std::size_t a = 0; a < 3; ++a) {
    t.axis[a] = random_table(-250'000'000, 33'333'333, 16, delta_nm, epsilon, random);
    t.directions[a] = Vec3(random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5), random.in(-5e-5, 5e-5));
  }
  t.axis[3] = random_table(-kTurn * 110 / 360, kTurn * 10 / 360, 23, delta_nm, epsilon, random);
  t.axis[4] = whole_turn(37, delta_nm, epsilon, random);
  return t;
}

TEST(RotaryChain, L300gOffsetsAreTheFormulasOfSeed000) {
  Random random(20);
  SCOPED_TRACE(random.trace());
  MachineTables tables = l300g_tables(5e3, 80e-6, random);
  tables.axis[3].value[1] = tables.axis[3].value[0];  // A jumps by turns: it has no direction here
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  MachineModel model(tables, tables.machine.tool_point);
  std::array<std::int64_t, kMaxAxes> q{};
  std::array<int, kMaxAxes> travel{2, 2, 2, 2};
  constexpr Real kArm = static_cast<Real>(kArm_mm) * 1e6L;
  Real worst_linear = 0;
  Real worst_arc = 0;
  for (int n = 0; n < kManyPoints / 5; ++n) {
    const std::array<std::int64_t, 4> to{
        random.integer(-130'000'000, 130'000'000), random.integer(-90'000'000, 90'000'000),
        random.integer(-kTurn * 75 / 360, kTurn * 75 / 360), random.integer(-8 * kTurn, 8 * kTurn)};
    for (std::size_t a = 0; a < 4; ++a) {
      if (n > 0) travel[a] = to[a] > q[a] ? 0 : 1;
      q[a] = to[a];
    }
    runner.tick({q[0], q[1], q[2], q[3], 0});
    model.stand_at(q, travel);
    const Real3 e = model.exact();
    const Real theta = model.at(2).held;
    const Real dB = -e[2] / (kArm * std::cos(theta));
    const Real dX = -e[0] - kArm * std::sin(theta) * dB;
    const Real dY = -e[1];
    worst_linear = std::max({worst_linear, std::abs(static_cast<Real>(runner.out.offset[0]) - dX),
                             std::abs(static_cast<Real>(runner.out.offset[1]) - dY)});
    worst_arc =
        std::max(worst_arc, std::abs(static_cast<Real>(runner.out.offset[2]) - dB * kWirePerRad));
    ASSERT_LT(worst_linear, 1.0L) << "point " << n;
    ASSERT_LT(worst_arc, 1.0L) << "point " << n;  // 2^-32 turn: 0.25 nm at the arm
  }
  RecordProperty("worst_pm", static_cast<int>(worst_linear * 1e3L));
  RecordProperty("worst_arc_units_e3", static_cast<int>(worst_arc * 1e3L));
}

TEST(RotaryChain, FiveAxisTableTableEqualsTheExactChain) {
  for (const double scale : {1.0, 2.5}) {
    Random random(21);
    SCOPED_TRACE(random.trace());
    MachineTables tables = table_table_tables(8e3 * scale, 40e-6 * scale, random);
    for (AxisTable& t : tables.axis)
      t.value[1] = t.value[0];  // position only; directions have their own tests
    LoadedRunner runner(tables.machine);
    ASSERT_TRUE(runner.start(tables).ok());
    MachineModel model(tables, tables.machine.tool_point);
    double worst = 0.0;
    for (int n = 0; n < kManyPoints / 5; ++n) {
      const std::array<std::int64_t, kMaxAxes> q{
          random.integer(-280'000'000, 280'000'000), random.integer(-280'000'000, 280'000'000),
          random.integer(-280'000'000, 280'000'000), random.integer(-kTurn / 3, kTurn / 3),
          random.integer(-8 * kTurn, 8 * kTurn)};
      runner.tick({q[0], q[1], q[2], q[3], q[4]});
      model.stand_at(q, {});
      const Real3 e = model.exact();
      // X carries the table with sign −1, Y and Z the tool: Δq = −E in base
      for (std::size_t a = 0; a < 3; ++a) {
        const Real error = static_cast<Real>(runner.out.offset[a]) + e[a];
        worst = std::max(worst, static_cast<double>(std::abs(error)));
      }
      ASSERT_LT(worst, 1.0) << "point " << n;
    }
    RecordProperty(scale > 1.0 ? "worst_pm_large" : "worst_pm", static_cast<int>(worst * 1e3));
  }
}

// A table that turns for hours is at the same place after every whole turn.
TEST(RotaryChain, ThousandsOfTurnsChangeNoBit) {
  Random random(22);
  SCOPED_TRACE(random.trace());
  MachineTables tables = table_table_tables(8e3, 40e-6, random);
  for (AxisTable& t : tables.axis)
    t.value[1] = t.value[0];
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  for (int n = 0; n < 2'000; ++n) {
    const std::int64_t c = random.integer(0, kTurn - 1);
    const auto once = runner.tick({-1'000'000, 2'000'000, 3'000'000, kTurn / 9, c});
    for (const std::int64_t turns : {-1, 1, 9, 10, -10, 1'000, -12'345, 100'000, -1'000'000}) {
      const auto again =
          runner.tick({-1'000'000, 2'000'000, 3'000'000, kTurn / 9, c + turns * kTurn});
      ASSERT_EQ(again.offset, once.offset) << turns << " turns, phase " << c;
      ASSERT_EQ(again.status[4] & kOutOfRange, 0) << turns << " turns";
    }
  }
}

// Nor does a sample that was lost on the way, however often the table has turned: 2^21 turns are
// five days at 300 rpm, 2^23 are all that int64 counts.
TEST(RotaryChain, ALostSampleAfterMillionsOfTurnsChangesNoBit) {
  Random random(24);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = table_table_tables(8e3, 40e-6, random);
  const auto settings = [] {
    auto s = open_settings<LoadedCompensator::kAxes>();
    s.axis[4].max_step = 2 * kTurn;
    return s;
  }();
  const auto path = [&](std::int64_t turns) {
    LoadedRunner runner(tables.machine);
    EXPECT_TRUE(runner.start(tables, settings).ok());
    std::vector<std::array<std::int32_t, 5>> offsets;
    for (int n = 0; n < 40; ++n) {
      // The last of these counts wraps on the way.
      const auto c = static_cast<std::int64_t>(static_cast<std::uint64_t>(turns * kTurn) +
                                               static_cast<std::uint64_t>(n * kTurn / 16));
      runner.in.axis[4].valid = n % 10 != 5;
      offsets.push_back(runner.tick({-1'000'000, 2'000'000, 3'000'000, kTurn / 9, c}).offset);
    }
    return offsets;
  };
  const auto near_zero = path(0);
  EXPECT_NE(near_zero.front(), near_zero.back());
  for (const std::int64_t turns : {2'097'151, 2'100'000, -2'100'000, 8'000'000, 8'388'606})
    EXPECT_EQ(path(turns), near_zero) << turns << " turns";
}

// Target mode adds the last offset: even the extremes of int64 must not overflow.
TEST(RotaryChain, ExtremePositionsOfTurningAxesAreSafe) {
  Random random(23);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = l300g_tables(5e3, 80e-6, random);
  LoadedRunner runner(tables.machine);
  auto settings = open_settings<5>();
  settings.source = PositionSource::target;
  for (AxisLimits& l : settings.axis)
    l.max_step = std::numeric_limits<std::int64_t>::max();
  ASSERT_TRUE(runner.start(tables, settings).ok());
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t far : {kMin, kMax, kMin + 1, kMax - 1, std::int64_t{0}, kMax, kMin}) {
    for (int repeat = 0; repeat < 3; ++repeat) {
      runner.tick({far, far, far, far, 0});
      for (const std::int32_t offset : runner.out.offset)
        ASSERT_LE(std::abs(offset), 4'194'303);
    }
  }
}

// |cos θ| < 0.1: X, Y and B cannot correct Z; everything is held and reported, then resumes.
TEST(RotaryChain, WithoutAuthorityEverythingIsHeld) {
  Random random(24);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = l300g_tables(5e3, 20e-6, random);
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  const auto at_degrees = [](double degrees) {
    return static_cast<std::int64_t>(degrees / 360.0 * static_cast<double>(kTurn));
  };
  const double edge = std::acos(0.1) * 180.0 / 3.14159265358979323846;  // 84.26°
  runner.tick({0, 0, at_degrees(edge - 0.02), 0, 0});
  const auto before = runner.tick({0, 0, at_degrees(edge - 0.01), 0, 0});
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_EQ(before.status[a] & kNoAuthority, 0);
  for (const double degrees : {edge + 0.01, 89.0, 90.0, 86.0}) {
    const auto lost = runner.tick({1'000'000, 2'000'000, at_degrees(degrees), 0, 0});
    EXPECT_EQ(lost.offset, before.offset) << degrees;
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NE(lost.status[a] & kNoAuthority, 0) << degrees;
      EXPECT_EQ(lost.status[a] & kValid, 0) << degrees;
    }
  }
  const auto back = runner.tick({1'000'000, 2'000'000, 0, 0, 0});
  EXPECT_EQ(back.status[0] & kNoAuthority, 0);
  EXPECT_NE(back.offset, before.offset);
}

// Held means held, also while a change is being ramped in.
TEST(RotaryChain, WithoutAuthorityTheRampDoesNotMoveTheOutput) {
  Random random(25);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = l300g_tables(5e3, 20e-6, random);
  LoadedRunner runner(tables.machine);
  auto settings = open_settings<5>();
  settings.ramp_ticks = 100;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  for (int n = 0; n < 50; ++n)
    runner.tick({0, 0, kTurn / 10, 0, 0});
  const auto before = runner.out.offset;
  for (int n = 0; n < 30; ++n) {
    runner.tick({0, 0, kTurn / 4, 0, 0});
    ASSERT_EQ(runner.out.offset, before) << "tick " << n;
  }
}

// A tool point on the axis of a correcting rotary axis gives it no lever at all.
TEST(RotaryChain, ToolOnTheRotaryAxisHasNoAuthority) {
  Random random(26);
  SCOPED_TRACE(random.trace());
  MachineTables tables = l300g_tables(5e3, 20e-6, random);
  tables.machine.tool_point = {0, 0, 0};
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  for (int n = 0; n < 10; ++n) {
    runner.tick({n * 1'000'000, 0, kTurn / 50, 0, 0});
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_EQ(runner.out.offset[a], 0) << "tick " << n << " axis " << a;
      ASSERT_NE(runner.out.status[a] & kNoAuthority, 0);
    }
  }
}

}  // namespace
}  // namespace volcomp::test
