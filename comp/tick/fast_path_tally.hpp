#pragma once
// Counts how often the status bits of ordinary operation began: valid, clamped, rate-limited. They
// come and go in ordinary operation, on several axes in one tick. Every pattern of beginnings has a
// counter of its own, "nothing began" included: one increment per tick, whatever happens.

#include <array>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/published.hpp"
#include "comp/machine/machine_description.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp {

// Three bits for each correcting axis.
using FastPathBits = std::uint32_t;
inline constexpr unsigned kFastPathWidth = 3;

constexpr FastPathBits fast_path_bits(std::uint32_t status) {
  const bool valid = (status & kValid) != 0;
  const bool clamped = (status & kClamped) != 0;
  const bool limited = (status & kRateLimited) != 0;
  return (valid ? 1U : 0U) | (clamped ? 2U : 0U) | (limited ? 4U : 0U);
}
constexpr std::uint32_t fast_path_status(FastPathBits bits) {
  const std::uint32_t valid = (bits & 1U) != 0 ? kValid : 0;
  const std::uint32_t clamped = (bits & 2U) != 0 ? kClamped : 0;
  const std::uint32_t limited = (bits & 4U) != 0 ? kRateLimited : 0;
  return valid | clamped | limited;
}
// The same bits of the correcting axis `c`.
constexpr FastPathBits bits_of_axis(std::size_t c, FastPathBits bits) {
  return bits << (kFastPathWidth * c);
}

// Valid bits of all axes. Counts of absent axes are never read.
inline constexpr FastPathBits kAllValid = bits_of_axis(0, fast_path_bits(kValid)) |
                                          bits_of_axis(1, fast_path_bits(kValid)) |
                                          bits_of_axis(2, fast_path_bits(kValid));
static_assert(kMaxCorrecting == 3);

class FastPathTally {
 public:
  // All correcting axes in this tick. Interrupt-safe.
  VOLCOMP_INLINE void enter(FastPathBits now) {
    Published<std::uint16_t>& count = count_[now & ~last_];
    const std::uint32_t n = count.own() + 1U;
    count.set(static_cast<std::uint16_t>(n - (n >> 16U)));  // saturates
    last_ = now;
  }

  // One axis, its changes counted elsewhere.
  void resume(std::size_t c, FastPathBits bits) {
    last_ = (last_ & ~bits_of_axis(c, kAxisBits)) | bits_of_axis(c, bits);
  }
  [[nodiscard]] FastPathBits last(std::size_t c) const {
    return (last_ >> (kFastPathWidth * c)) & kAxisBits;
  }

  // Adds to `began`, bit by bit of the axis `c`, how often each began.
  void add_to(std::array<std::uint32_t, kFastPathWidth>& began, std::size_t c) const {
    for (std::size_t pattern = 1; pattern < count_.size(); ++pattern) {
      for (std::size_t bit = 0; bit < kFastPathWidth; ++bit) {
        if ((pattern >> (kFastPathWidth * c + bit) & 1U) != 0) began[bit] += count_[pattern].get();
      }
    }
  }

 private:
  static constexpr FastPathBits kAxisBits = (1U << kFastPathWidth) - 1U;

  FastPathBits last_ = 0;
  std::array<Published<std::uint16_t>, 1U << (kFastPathWidth * kMaxCorrecting)> count_{};
};

}  // namespace volcomp
