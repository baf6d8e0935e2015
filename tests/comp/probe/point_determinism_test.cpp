// One fixed sequence of touches gives the same points, bit for bit, with every compiler,
// optimisation and sanitizer, on the host and on the boards.

#include <cstring>

#include "tests/oracle/fixed_numbers.hpp"
#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

constexpr int kPointTouches = 5'000;

// Obtained with g++ 12 at -O2 on x86-64, and the same on the M7 and the M4F. A change of it is a
// change of the arithmetic, which the conventions (section 5) forbid to happen by itself.
constexpr std::uint32_t kPointDigest = 2'173'031'660;

MachineTables fixed_tables() {
  Fixed fixed;
  MachineTables t;
  t.machine = probing_machine();
  t.directions = zero_directions();
  t.axis[0] = fixed.table(0, 30'000'000, 11);
  t.axis[1] = fixed.table(150'000'000, 20'000'000, 11);
  t.axis[2] = fixed.table(-kTurn / 6, kTurn / 60, 11);
  t.axis[3] = fixed.table(0, kTurn / 16, 16, true);
  return t;
}

// Numbers that take one division at most.
ProbeSettings fixed_settings(Fixed& fixed) {
  ProbeSettings s;
  s.probe_delay_s = 1.0 / 100'000.0;
  for (std::size_t a = 0; a < 4; ++a) {
    s.latch_delay_s[a] = static_cast<double>(2 * a + 2) / 1e6;
    s.uncertainty.position[a] = a < 2 ? 50.0 : 3.0 / 1e7;
    s.uncertainty.latch_delay_s[a] = 1.0 / 1e6;
  }
  s.radius.coefficient[0] = 1'493'500.0;
  for (std::size_t k = 1; k < kLobingTerms; ++k)
    s.radius.coefficient[k] = static_cast<double>(fixed.integer(-5'000, 5'000));
  s.workpiece.R << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0;
  s.workpiece.t = {4e6, -5e6, 6e6};
  s.uncertainty.radius = 160.0;
  s.uncertainty.tool_length = 1'000.0;
  s.uncertainty.correlation = 0.5;
  s.uncertainty.repeatability = 250.0;
  s.uncertainty.tables = 300.0;
  s.uncertainty.normal = 1.0 / 1'000.0;
  s.uncertainty.probe_delay_s = 1.0 / 1e6;
  return s;
}

Touch fixed_touch(Fixed& fixed) {
  Touch touch =
      touch_at({fixed.integer(-5'000'000, 305'000'000), fixed.integer(150'000'000, 350'000'000),
                fixed.integer(-kTurn / 6, -kTurn / 18), fixed.integer(-3 * kTurn, 3 * kTurn)});
  for (std::size_t a = 0; a < 4; ++a) {
    touch.latched[a].velocity = static_cast<double>(fixed.integer(-20'000'000, 20'000'000));
    touch.latched[a].direction = static_cast<Direction>(fixed.integer(0, 2));
  }
  return touch;
}

ProbeFeature fixed_feature(Fixed& fixed) {
  const std::array<Vec3, 5> normals{Vec3::Zero(), Vec3::UnitZ(), Vec3(0.6, 0.0, -0.8),
                                    Vec3(-0.28, 0.96, 0.0), Vec3(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0)};
  return {1, normals[static_cast<std::size_t>(fixed.integer(0, 4))]};
}

void add_record(Digest& digest, const ProbePoint& point) {
  for (std::size_t k = 0; k < 3; ++k) {
    digest.add(static_cast<std::uint64_t>(point.machine[k]), 8);
    digest.add(static_cast<std::uint64_t>(point.workpiece[k]), 8);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &point.uncertainty[k], sizeof bits);
    digest.add(bits, 4);
  }
  digest.add(static_cast<std::uint64_t>(point.verdict), 1);
  digest.end_record();
}

TEST(PointDeterminism, SameBitsEverywhere) {
  const MachineTables tables = fixed_tables();
  Runner<LoadedCompensator> runner(tables.machine);
  ASSERT_TRUE(runner.start(tables).ok());
  runner.tick({100'000'000, 230'000'000, -kTurn / 10, 0, 0});
  runner.tick();
  ASSERT_TRUE(runner.compensator->active());
  Fixed fixed;
  ProbeCorrector corrector = probing_corrector();
  corrector.settings = fixed_settings(fixed);
  Digest digest;
  for (int i = 0; i < kPointTouches; ++i) {
    const Touch touch = fixed_touch(fixed);
    const ProbeFeature feature = fixed_feature(fixed);
    add_record(digest,
               corrector.correct(touch, feature, runner.compensator->error_at(touch.latched)));
  }
  EXPECT_EQ(digest.value(), kPointDigest);
}

}  // namespace
}  // namespace volcomp::test
