#pragma once
// Options of the soak programs: --ticks N --seed N.

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace volcomp::test {

struct SoakOptions {
  std::uint64_t ticks = 1'000'000;
  std::uint64_t seed = 1;
};

inline SoakOptions soak_options(int argc, char** argv) {
  SoakOptions options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--ticks") options.ticks = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--seed") options.seed = std::strtoull(argv[i + 1], nullptr, 10);
  }
  return options;
}

}  // namespace volcomp::test
