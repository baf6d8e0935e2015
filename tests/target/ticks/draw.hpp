#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace volcomp::target {

// Marsaglia's xorshift32 (Journal of Statistical Software 8(14), 2003): the same in every run.
class Draw {
 public:
  // 0…limit − 1
  std::uint32_t below(std::uint32_t limit) {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 17U;
    state_ ^= state_ << 5U;
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(state_) * limit) >> 32U);
  }
  bool once_in(std::uint32_t ticks) { return below(ticks) == 0; }
  template <class Value, std::size_t Count>
  const Value& one_of(const std::array<Value, Count>& values) {
    return values[below(Count)];
  }

 private:
  std::uint32_t state_ = 2'463'534'242U;
};

}  // namespace volcomp::target
