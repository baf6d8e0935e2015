// sine_cosine against the C library in double, and the symmetries of the circle bit for bit.

#include <cstring>

#include "comp/machine/fixed_trig.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

double angle_of(std::uint32_t units) {
  return static_cast<double>(units) * (2.0 * 3.14159265358979323846 / 4294967296.0);
}

double worst_error(std::uint32_t units) {
  const SineCosine t = sine_cosine(units);
  const double s = std::abs(static_cast<double>(t.sine) - std::sin(angle_of(units)));
  const double c = std::abs(static_cast<double>(t.cosine) - std::cos(angle_of(units)));
  return std::max(s, c);
}

TEST(Trigonometry, DenseSweepWithin2em7) {
  double worst = 0.0;
  constexpr std::uint64_t kPoints = 4 * std::uint64_t{kManyPoints};
  constexpr std::uint64_t step = (std::uint64_t{1} << 32U) / kPoints | 1U;
  for (std::uint64_t u = 0; u < (std::uint64_t{1} << 32U); u += step)
    worst = std::max(worst, worst_error(static_cast<std::uint32_t>(u)));
  // Around the points of the circle and the seams between them, where what is left is largest.
  for (std::uint64_t half = 0; half < 256; ++half) {
    for (std::int64_t near = -100; near <= 100; ++near) {
      const auto u = static_cast<std::uint32_t>(static_cast<std::int64_t>(half << 24U) + near);
      worst = std::max(worst, worst_error(u));
    }
  }
  EXPECT_LE(worst, 2e-7);
  RecordProperty("worst_e12", static_cast<int>(worst * 1e12));
}

TEST(Trigonometry, QuarterTurnsAreExact) {
  const float sine[] = {0.0F, 1.0F, 0.0F, -1.0F};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const SineCosine t = sine_cosine(k << 30U);
    EXPECT_EQ(t.sine, sine[k]);
    EXPECT_EQ(t.cosine, sine[(k + 1) % 4]);
  }
}

TEST(Trigonometry, SymmetriesHoldBitForBit) {
  Random random(30);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 200'000; ++n) {
    const auto u = static_cast<std::uint32_t>(random.integer(0, 0xFFFFFFFF));
    if ((u & 0x01FFFFFFU) == 0x01000000U) continue;  // a seam belongs to one side only
    const SineCosine here = sine_cosine(u);
    const SineCosine mirrored = sine_cosine(0U - u);
    const SineCosine quarter = sine_cosine(u + 0x40000000U);
    const SineCosine half = sine_cosine(u + 0x80000000U);
    ASSERT_EQ(mirrored.sine, -here.sine) << u;
    ASSERT_EQ(mirrored.cosine, here.cosine) << u;
    ASSERT_EQ(quarter.sine, here.cosine) << u;
    ASSERT_EQ(quarter.cosine, -here.sine) << u;
    ASSERT_EQ(half.sine, -here.sine) << u;
    ASSERT_EQ(half.cosine, -here.cosine) << u;
  }
}

TEST(Trigonometry, NeverLongerThanTheCircleByMoreThanItsError) {
  Random random(31);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 200'000; ++n) {
    const SineCosine t = sine_cosine(static_cast<std::uint32_t>(random.integer(0, 0xFFFFFFFF)));
    const double s = static_cast<double>(t.sine);
    const double c = static_cast<double>(t.cosine);
    ASSERT_NEAR(s * s + c * c, 1.0, 4e-7);
  }
}

}  // namespace
}  // namespace volcomp::test
