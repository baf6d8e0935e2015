#pragma once
// Counts how often each status bit of an axis began. Bits come and go together, up to nine in one
// tick: they are counted in groups, of which every pattern of beginnings has a counter of its own.
// So a change costs one increment where only bits of ordinary operation change, and four whatever
// the status is.

#include <array>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/published.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp {

// The bits of ordinary operation.
inline constexpr std::uint32_t kOrdinaryStatus =
    kValid | kClamped | kRateLimited | kAccelerationLimited;

class StatusTally {
 public:
  // The status of this tick. Interrupt-safe.
  VOLCOMP_INLINE void enter(std::uint32_t status) {
    const std::uint32_t began = status & ~last_;
    last_ = status;
    VOLCOMP_UNROLL
    for (std::size_t g = 0; g < kGroups; ++g)
      count(g, began);
  }
  // The same where it has no other bits than kOrdinaryStatus.
  VOLCOMP_INLINE void enter_ordinary(std::uint32_t status) {
    const std::uint32_t began = status & ~last_;
    last_ = status;
    count(0, began);
  }

  // The next status begins anew, whatever it is.
  void forget() { last_ = 0; }

  // How often this bit began, at most 65 535. Any context.
  [[nodiscard, gnu::cold]] std::uint16_t began(std::size_t bit) const {
    std::uint32_t sum = 0;
    for (std::size_t g = 0; g < kGroups; ++g) {
      const std::uint32_t counted = pattern(g, 1U << bit);
      const std::uint32_t patterns = g + 1 < kGroups ? kPatterns : kLastPatterns;
      for (std::uint32_t p = 1; p < patterns; ++p)
        sum += (p & counted) != 0 ? count_[g * kPatterns + p].get() : 0U;
    }
    return static_cast<std::uint16_t>(sum < UINT16_MAX ? sum : UINT16_MAX);
  }

 private:
  static constexpr std::size_t kGroups = 4;
  static constexpr std::uint32_t kPatterns = 16;  // of a group
  static constexpr std::uint32_t kLastPatterns = 4;

  // `width` neighbouring bits of a status from bit `from` on, moved to bit `to` of a pattern.
  static constexpr std::uint32_t bits(std::uint32_t status, std::size_t from, unsigned width,
                                      unsigned to) {
    return (status >> from & ((1U << width) - 1U)) << to;
  }
  // The bits of a group. kRamping is in none: ramps are those of all axes.
  static constexpr std::uint32_t pattern(std::size_t group, std::uint32_t status) {
    switch (group) {
      case 0:
        return bits(status, bit_of(kValid), 1, 0) | bits(status, bit_of(kClamped), 2, 1) |
               bits(status, bit_of(kAccelerationLimited), 1, 3);
      case 1:
        return bits(status, bit_of(kNotHomed), 4, 0);
      case 2:
        return bits(status, bit_of(kOutOfRange), 2, 0) |
               bits(status, bit_of(kDirectionUnknown), 1, 2) |
               bits(status, bit_of(kNoAuthority), 1, 3);
      default:
        return bits(status, bit_of(kNoTables), 2, 0);
    }
  }
  static_assert(kRateLimited == kClamped << 1U && kImplausible == kNotHomed << 3U &&
                kFarOutOfRange == kOutOfRange << 1U && kTableDamaged == kNoTables << 1U);

  VOLCOMP_INLINE void count(std::size_t group, std::uint32_t began) {
    Published<std::uint16_t>& count = count_[group * kPatterns + pattern(group, began)];
    const std::uint32_t n = count.own();
    count.set(static_cast<std::uint16_t>(n < UINT16_MAX ? n + 1U : n));
  }

  std::uint32_t last_ = 0;
  std::array<Published<std::uint16_t>, (kGroups - 1) * kPatterns + kLastPatterns> count_{};
};

}  // namespace volcomp
