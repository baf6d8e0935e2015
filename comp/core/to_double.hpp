#pragma once
// Integers of 64 bits as double, in pieces that processors know: for the whole the library of the
// compiler brings its additions in software, also where there is an FPU for doubles.

#include <cstdint>

namespace volcomp {

inline constexpr double kWord = 4294967296.0;  // 2^32

// As a cast does it: both pieces and their product are exact, only the sum is rounded.
[[nodiscard]] inline double to_double(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  return static_cast<double>(static_cast<std::int32_t>(bits >> 32U)) * kWord +
         static_cast<double>(static_cast<std::uint32_t>(bits));
}

}  // namespace volcomp
