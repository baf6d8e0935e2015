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
using EverydayBits = std::uint32_t;
inline constexpr unsigned kEverydayWidth = 3;

constexpr EverydayBits everyday_bits(std::uint32_t status) {
  const bool valid = (status & kValid) != 0;
  const bool clamped = (status & kClamped) != 0;
  const bool limited = (status & kRateLimited) != 0;
  return (valid ? 1U : 0U) | (clamped ? 2U : 0U) | (limited ? 4U : 0U);
}
constexpr std::uint32_t everyday_status(EverydayBits bits) {
  const std::uint32_t valid = (bits & 1U) != 0 ? kValid : 0;
  const std::uint32_t clamped = (bits & 2U) != 0 ? kClamped : 0;
  const std::uint32_t limited = (bits & 4U) != 0 ? kRateLimited : 0;
  return valid | clamped | limited;
}
// The same bits of the correcting axis `c`.
constexpr EverydayBits everyday_of(std::size_t c, EverydayBits bits) {
  return bits << (kEverydayWidth * c);
}

// Valid bits of all axes. Counts of absent axes are never read.
inline constexpr EverydayBits kAllValid = everyday_of(0, everyday_bits(kValid)) |
                                          everyday_of(1, everyday_bits(kValid)) |
                                          everyday_of(2, everyday_bits(kValid));
static_assert(kMaxCorrecting == 3);

class EverydayTally {
 public:
  // All correcting axes in this tick. Interrupt-safe.
  VOLCOMP_INLINE void enter(EverydayBits now) {
    Published<std::uint16_t>& count = count_[now & ~last_];
    const std::uint32_t n = count.own() + 1U;
    count.set(static_cast<std::uint16_t>(n - (n >> 16U)));  // saturates
    last_ = now;
  }

  // One axis, its changes counted elsewhere.
  void resume(std::size_t c, EverydayBits bits) {
    last_ = (last_ & ~everyday_of(c, kAxisBits)) | everyday_of(c, bits);
  }
  [[nodiscard]] EverydayBits last(std::size_t c) const {
    return (last_ >> (kEverydayWidth * c)) & kAxisBits;
  }

  // Adds to `began`, bit by bit of the axis `c`, how often each began.
  void add_to(std::array<std::uint32_t, kEverydayWidth>& began, std::size_t c) const {
    for (std::size_t pattern = 1; pattern < count_.size(); ++pattern) {
      for (std::size_t bit = 0; bit < kEverydayWidth; ++bit) {
        if ((pattern >> (kEverydayWidth * c + bit) & 1U) != 0) began[bit] += count_[pattern].get();
      }
    }
  }

 private:
  static constexpr EverydayBits kAxisBits = (1U << kEverydayWidth) - 1U;

  EverydayBits last_ = 0;
  std::array<Published<std::uint16_t>, 1U << (kEverydayWidth * kMaxCorrecting)> count_{};
};

}  // namespace volcomp
