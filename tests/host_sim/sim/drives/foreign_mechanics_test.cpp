// A drive with mechanics that its owner brings: 6064h is what the encoder read when SYNC came, and
// then they follow 607Ah + 60B0h.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

struct ForeignAxis {
  std::int64_t place = 1000;
  int periods = 0;

  ForeignMechanics mechanics() {
    return {[this] { return place; },
            [this](std::int64_t demand) {
              place = demand;
              ++periods;
            }};
  }
};

TEST(ForeignMechanics, AreReadBeforeTheyFollow) {
  ForeignAxis axis;
  Bench bench;
  bench.drive.couple(axis.mechanics());
  bench.enable(1000);
  bench.offset(7);
  bench.cycle(0x0F, 5000);
  EXPECT_EQ(axis.place, 5007);
  EXPECT_EQ(bench.drive.objects().actual, 1000);
  bench.cycle(0x0F, 6000);
  EXPECT_EQ(bench.drive.objects().actual, 5007);
  EXPECT_EQ(axis.place, 6007);
}

TEST(ForeignMechanics, StandWithoutPower) {
  ForeignAxis axis;
  Bench bench;
  bench.drive.couple(axis.mechanics());
  bench.enable(1000);
  bench.cycle(0x0F, 5000);
  const int before = axis.periods;
  bench.drive.power_off();
  bench.cycle(0x0F, 9000);
  EXPECT_EQ(axis.periods, before);
  EXPECT_EQ(axis.place, 5000);
}

}  // namespace
}  // namespace volcomp::sim
