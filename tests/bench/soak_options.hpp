#pragma once
// Options of the soak programs: --ticks N --seed N.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace volcomp::test {

struct SoakOptions {
  std::uint64_t ticks = 1'000'000;
  std::uint64_t seed = 1;
};

// Ends the program with a sentence where they are not that.
inline SoakOptions soak_options(int argc, char** argv) {
  SoakOptions options;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    const std::string_view text = i + 1 < argc ? argv[i + 1] : "";
    std::uint64_t* const value = name == "--ticks"  ? &options.ticks
                                 : name == "--seed" ? &options.seed
                                                    : nullptr;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (value == nullptr || error != std::errc() || end != text.data() + text.size()) {
      std::fprintf(stderr, "%s: the options are --ticks N and --seed N, whole numbers.\n", argv[0]);
      std::exit(2);
    }
    *value = number;
  }
  return options;
}

}  // namespace volcomp::test
