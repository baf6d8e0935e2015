// A rotary axis: 2³¹ units in a turn, so an INTEGER32 holds two turns and wraps.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

TEST(RotaryDrive, TurnsOnAndOnThroughTheWrap) {
  auto settings = Bench::rotary();
  settings.following_window = host::kNoFollowingWindow;
  Bench bench(settings);
  bench.enable();
  constexpr std::int32_t kEighth = 1 << 28;
  std::int32_t target = 0;
  for (int i = 0; i < 8 * 5; ++i)
    bench.cycle(0x0F, target = wrapped_sum(target, kEighth));
  for (int i = 0; i < 100; ++i)
    bench.cycle(0x0F, target);
  EXPECT_NEAR(bench.drive.position_turns(), 5.0, 1e-9);
  EXPECT_EQ(bench.drive.demand(), std::int64_t{5} << 31);
  EXPECT_EQ(bench.drive.objects().actual, INT32_MIN);  // an odd number of turns
}

TEST(RotaryDrive, TheOffsetWrapsToo) {
  Bench bench(Bench::rotary());
  bench.drive.stand_at(INT32_MAX);
  bench.enable(INT32_MAX);
  bench.offset(2);
  bench.cycle(0x0F, INT32_MAX);
  EXPECT_EQ(bench.drive.demand(), std::int64_t{INT32_MAX} + 2);
  EXPECT_EQ(bench.drive.objects().demand, INT32_MIN + 1);
}

TEST(RotaryDrive, SoftwareLimitsDoNotApply) {
  auto settings = Bench::rotary();
  settings.software_max = 10;
  Bench bench(settings);
  bench.enable();
  bench.cycle(0x0F, 1000);
  EXPECT_EQ(bench.drive.demand(), 1000);
}

TEST(RotaryDrive, ItsObjectsSayTwoToThe31UnitsPerTurn) {
  Bench bench(Bench::rotary());
  EXPECT_EQ(bench.read(0x6092, 1) / bench.read(0x6092, 2), 0x8000'0000U);
  EXPECT_EQ(bench.read(0x608F, 1) / bench.read(0x608F, 2), 0x8000'0000U);
}

}  // namespace
}  // namespace volcomp::sim
