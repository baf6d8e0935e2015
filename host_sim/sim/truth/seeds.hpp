#pragma once
// Seeds for generators that go through a loop. Two generators with the same seed give the same
// numbers: what is drawn for different purposes has seeds of its own.

#include <cstdint>

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {

// The errors of a machine have the seed of the run itself.
enum class SeedOf : std::uint32_t { gear = 1, arm = 2, instruments = 3, places = 4, locations = 5 };

[[nodiscard]] inline std::uint64_t seed_of(std::uint64_t seed, SeedOf what) {
  constexpr std::uint32_t kSeeds = 65;  // no RandomStream has this number
  const RandomWords words = random_words(seed, {kSeeds, static_cast<std::uint32_t>(what), 0, 0});
  return (std::uint64_t{words[0]} << 32U) | words[1];
}

}  // namespace volcomp::sim
