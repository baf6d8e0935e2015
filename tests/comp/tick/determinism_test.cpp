// One fixed sequence of ticks gives the same bits with every compiler, optimisation and sanitizer,
// compiled in or loaded.

#include "tests/oracle/fixed_numbers.hpp"

namespace volcomp::test {
namespace {

constexpr int kFixedTicks = 100'000;

template <class Output>
void add_record(Digest& digest, const Output& out, std::size_t axes) {
  for (std::size_t a = 0; a < axes; ++a) {
    digest.add(static_cast<std::uint32_t>(out.offset[a]), 4);
    digest.add(out.status[a], 2);
  }
  digest.end_record();
}

// Default settings: ramp, slew, hysteresis and the position source all take part.
template <class AnyRunner>
std::uint32_t run(AnyRunner& runner, std::size_t axes, std::int64_t rotary_span) {
  Fixed fixed;
  Digest digest;
  typename AnyRunner::Positions q{};
  for (int n = 0; n < kFixedTicks; ++n) {
    for (std::size_t a = 0; a < axes; ++a) {
      q[a] += fixed.integer(-900'000, 1'000'000);
      if (a < 3 && q[a] > 30'000'000) q[a] = -450'000'000;
      if (a >= 3) q[a] = (q[a] + fixed.integer(0, rotary_span)) % (3 * kTurn);
      runner.in.axis[a].valid = fixed.integer(0, 999) != 0;
    }
    runner.tick(q);
    add_record(digest, runner.out, axes);
  }
  return digest.value();
}

MachineTables fixed_xyfz() {
  Fixed fixed;
  MachineTables tables;
  tables.machine = kXyfzMachine;
  tables.directions = xyfz_directions({127e-6, 222e-6, 17e-6});
  tables.axis[0] = fixed.table(-500'000'000, 50'000'000, 11);
  tables.axis[1] = fixed.table(-300'000'000, 30'000'000, 11);
  tables.axis[2] = fixed.table(-400'000'000, 33'333'333, 13);
  return tables;
}

MachineTables fixed_five_axis() {
  Fixed fixed;
  MachineTables t;
  MachineDescription& d = t.machine;
  d.body_count = 6;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::x, -1, 0, 'X', {0, 0, 200});
  d.body[2] = moving_body(2, JointKind::rotary, Axis::x, -1, 3, 'A', {50, 20, 180});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::z, -1, 4, 'C', {0.1, 35, 60});
  d.body[4] = moving_body(1, JointKind::prismatic, Axis::y, 1, 1, 'Y', {40, 300, 700});
  d.body[5] = moving_body(5, JointKind::prismatic, Axis::z, 1, 2, 'Z', {0, -150, 80});
  d.work_body = 4;
  d.tool_body = 6;
  d.tool_point = {2, -3, -220};
  d.correcting = {0, 1, 3};  // A corrects: division and trigonometry take part
  d.correcting_count = 3;
  for (std::size_t a = 0; a < 3; ++a)
    t.axis[a] = fixed.table(-450'000'000, 33'333'333, 14);
  t.axis[3] = fixed.table(-kTurn / 3, kTurn / 36, 25);
  t.axis[4] = fixed.table(0, kTurn / 37, 37, true);
  return t;
}

// The values below were obtained with g++ 12 at -O0, -O2, -O3, clang++ 14 at -O2 and g++ with the
// address and undefined-behaviour sanitizers at -O1, all on x86-64, and agreed. A change of them is
// a change of the arithmetic, which the conventions (section 5) forbid to happen by itself.
constexpr std::uint32_t kXyfzDigest = 3'651'727'908;
constexpr std::uint32_t kFiveAxisDigest = 2'307'962'111;

TEST(Determinism, XyfzLoaded) {
  LoadedRunner runner(kXyfzMachine);
  ASSERT_TRUE(runner.start(fixed_xyfz(), {}).ok());
  EXPECT_EQ(run(runner, 3, 0), kXyfzDigest);
}

TEST(Determinism, XyfzCompiledIn) {
  XyfzRunner runner;
  ASSERT_TRUE(runner.start(fixed_xyfz(), {}).ok());
  EXPECT_EQ(run(runner, 3, 0), kXyfzDigest);
}

TEST(Determinism, FiveAxisRecursion) {
  const MachineTables tables = fixed_five_axis();
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.start(tables, {}).ok());
  EXPECT_EQ(run(runner, 5, kTurn / 100), kFiveAxisDigest);
}

// Nothing is carried over but what the interface states: two runs in one process agree.
TEST(Determinism, TwoInstancesDoNotInfluenceEachOther) {
  XyfzRunner first;
  XyfzRunner second;
  const MachineTables tables = fixed_xyfz();
  ASSERT_TRUE(first.start(tables, {}).ok());
  ASSERT_TRUE(second.start(tables, {}).ok());
  Fixed fixed;
  for (int n = 0; n < 1'000; ++n) {
    const XyfzRunner::Positions q{fixed.integer(-500'000'000, 0), fixed.integer(-300'000'000, 0),
                                  fixed.integer(-400'000'000, 0)};
    first.tick(q);
    second.tick({q[2], q[0], q[1]});
    second.tick(q);
    first.tick({q[2], q[0], q[1]});
  }
  XyfzRunner fresh;
  auto settings = open_settings<3>();
  ASSERT_TRUE(fresh.start(tables, settings).ok());
  XyfzRunner used;
  ASSERT_TRUE(used.start(tables, settings).ok());
  for (int n = 0; n < 1'000; ++n)
    used.tick({fixed.integer(-500'000'000, 0), 0, 0});
  used.tick({-400'000'000, -100'000'000, -100'000'000});
  fresh.tick({-490'000'000, -200'000'000, -200'000'000});  // a direction for every axis
  fresh.tick({-300'000'000, -100'000'000, -100'000'000});
  used.tick({-300'000'000, -50'000'000, -50'000'000});
  fresh.tick({-300'000'000, -50'000'000, -50'000'000});
  EXPECT_EQ(used.out.offset, fresh.out.offset);
}

}  // namespace
}  // namespace volcomp::test
