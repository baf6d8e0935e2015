#pragma once
// Seeds for a test that expects the same of each.

#include <cstdint>
#include <vector>

namespace volcomp::sim {

// The first alone below the sanitizers: they look at the code, which is the same for all.
inline std::vector<std::uint64_t> each_of(std::vector<std::uint64_t> seeds) {
#ifdef VOLCOMP_SANITIZED
  seeds.resize(1);
#endif
  return seeds;
}

}  // namespace volcomp::sim
