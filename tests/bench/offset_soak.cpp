// The limiter of offsets in a storm for a very long time: targets meant to break its promises,
// limits of every size that change in motion, holds and restarts; every 16th tick is compared with
// the definition.
//
//   volcomp_offset_soak [--ticks 1000000] [--seed 1]

#include <cstdlib>

#include <fmt/format.h>

#include "tests/bench/soak_options.hpp"
#include "tests/oracle/offset_storm.hpp"

namespace volcomp::test {
namespace {

template <class Limiter>
bool run(const char* name, std::uint64_t ticks, std::uint64_t seed) {
  OffsetStorm<Limiter> storm(seed);
  const bool kept = storm.run(ticks);
  const StormCounts& n = storm.counts();
  fmt::print(
      "{}: {} ticks, {} limited, {} changes of limits, {} ticks waiting for them, {} began beyond "
      "the limit, {} compared with the definition; random seed {}\n",
      name, n.ticks, n.limited, n.changes, n.waiting, n.outside, n.compared, seed);
  if (!kept) fmt::print(stderr, "offset_soak: {}: {}\n", name, storm.broken());
  return kept;
}

}  // namespace
}  // namespace volcomp::test

int main(int argc, char** argv) {
  const auto [ticks, seed] = volcomp::test::soak_options(argc, argv);
  using volcomp::OffsetLimiter;
  const bool accelerated = volcomp::test::run<OffsetLimiter<true>>("acceleration", ticks, seed);
  const bool rate = volcomp::test::run<OffsetLimiter<false>>("rate alone", ticks / 10, seed);
  return accelerated && rate ? EXIT_SUCCESS : EXIT_FAILURE;
}
