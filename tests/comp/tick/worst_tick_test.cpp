// The search for the most expensive tick (tests/target/ticks), here without a counter: its ticks
// give the same bits as on a board, and it leaves out nothing that can happen.

#include "tests/target/ticks/worst_run.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace volcomp::target {

void stop(const char* sentence) {
  static_cast<void>(std::fprintf(stderr, "%s\n", sentence));
  std::abort();
}

namespace {

// A computer counts no instructions here.
struct NoMeter {
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  int start() { return 0; }
  std::uint32_t stop(int /*start*/) { return 0; }
  // NOLINTEND(readability-convert-member-functions-to-static)
};

TEST(WorstTick, HasTheSameBitsEverywhereAndMeetsEverything) {
  constexpr std::uint32_t kEveryBit = (1U << kStatusBits) - 1U;
  constexpr std::uint32_t kAtLeast = 100'000;
  std::uint32_t seen = 0;
  NoMeter meter;
  visit_worst_machines(
      [&](const WorstMachine& machine, const auto& unit, const MachineDescription& description) {
        const Searched searched = look_for_the_worst(*unit, description, meter);
        const Digests& got = searched.digests;
        const Digests& wanted = machine.digests;
        EXPECT_EQ(got.unbounded.outputs, wanted.unbounded.outputs) << machine.name;
        EXPECT_EQ(got.unbounded.counts, wanted.unbounded.counts) << machine.name;
        EXPECT_EQ(got.bounded.outputs, wanted.bounded.outputs) << machine.name;
        EXPECT_EQ(got.bounded.counts, wanted.bounded.counts) << machine.name;
        for (std::size_t kind = 0; kind < kTickKindNames.size(); ++kind)
          EXPECT_GT(searched.cost.of(kind).count, 1'000U) << machine.name << kTickKindNames[kind];
        EXPECT_GE(searched.cost.of(kTickKindNames.size() - 1).count, kAtLeast) << machine.name;
        seen |= searched.seen;
      });
  EXPECT_EQ(seen, kEveryBit);
}

}  // namespace
}  // namespace volcomp::target
