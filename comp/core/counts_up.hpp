#pragma once
// For codes whose texts are found by number: reasons.def and others.

#include <array>
#include <cstddef>

namespace volcomp {

// 0, 1, 2 …
template <std::size_t n>
constexpr bool counts_up(const std::array<int, n>& numbers) {
  for (std::size_t i = 0; i < n; ++i) {
    if (numbers[i] != static_cast<int>(i)) return false;
  }
  return true;
}

}  // namespace volcomp
