#pragma once
// Counts how often each status bit of an axis began. Bits come and go together, up to nine in one
// tick: they are counted in groups, of which every pattern of beginnings has a counter of its own.
// So a tick costs one increment where only bits of ordinary operation come, and four whatever the
// status is. One that changes nothing costs as much: the most expensive tick is what is budgeted.

#include <array>
#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/saturating_counter.hpp"
#include "comp/core/span.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp {

// The bits of ordinary operation.
inline constexpr std::uint32_t kOrdinaryStatus =
    kValid | kClamped | kRateLimited | kAccelerationLimited;

// These four side by side: every product of one of them and of one of the factor has a place of its
// own, so that nothing carries, and four of these are the upper ones.
constexpr std::uint32_t ordinary_pattern(std::uint32_t ordinary_status) {
  constexpr std::uint32_t kGather = 1U << 28U | 1U << 22U | 1U << 17U;
  return ordinary_status * kGather >> 28U;
}
static_assert(ordinary_pattern(kValid) == 1 && ordinary_pattern(kClamped) == 2 &&
              ordinary_pattern(kRateLimited) == 4 && ordinary_pattern(kAccelerationLimited) == 8 &&
              ordinary_pattern(kOrdinaryStatus) == 15);

class StatusTally {
 public:
  // The status of this tick. Interrupt-safe.
  VOLCOMP_INLINE void enter(std::uint32_t status) {
    const std::uint32_t began = status & ~last_;
    last_ = status;
    count(ordinary_.data(), ordinary_pattern(began & kOrdinaryStatus));
    count(of_sample_.data(), sample_pattern(began));
    count(of_place_.data(), place_pattern(began));
    count(of_machine_.data(), machine_pattern(began));
  }
  // The same where it has no other bits than kOrdinaryStatus.
  VOLCOMP_INLINE void enter_ordinary(std::uint32_t status) {
    const std::uint32_t began = status & ~last_;
    last_ = status;
    count(ordinary_.data(), ordinary_pattern(began));
  }

  // The next status begins anew, whatever it is.
  void forget() { last_ = 0; }

  // How often this bit began, at most 65 535. Any context.
  [[nodiscard, gnu::cold]] std::uint16_t began(std::size_t bit) const {
    const std::uint32_t status = 1U << bit;
    const std::uint32_t sum = sum_of(ordinary_, ordinary_pattern(status & kOrdinaryStatus)) +
                              sum_of(of_sample_, sample_pattern(status)) +
                              sum_of(of_place_, place_pattern(status)) +
                              sum_of(of_machine_, machine_pattern(status));
    return static_cast<std::uint16_t>(sum < UINT16_MAX ? sum : UINT16_MAX);
  }

 private:
  using Counter = SaturatingCounter;

  // The groups beside that of ordinary operation. kRamping is in none: ramps are those of all axes.
  static constexpr std::uint32_t sample_pattern(std::uint32_t status) {
    return status / kNotHomed % 16U;  // … kImplausible
  }
  static constexpr std::uint32_t place_pattern(std::uint32_t status) {
    return status / kOutOfRange % 4U | status / kDirectionUnknown % 2U * 4U;
  }
  static constexpr std::uint32_t machine_pattern(std::uint32_t status) {
    return status / kNoAuthority % 8U;  // … kTableDamaged
  }
  static_assert(kImplausible == kNotHomed << 3U && kFarOutOfRange == kOutOfRange << 1U &&
                kNoTables == kNoAuthority << 1U && kTableDamaged == kNoAuthority << 2U);

  VOLCOMP_INLINE static void count(Counter* group, std::uint32_t pattern) {
    VOLCOMP_KEEP_IN_REGISTER(group);
    group[pattern].increment();
  }

  [[gnu::cold, gnu::noinline]] static std::uint32_t sum_of(Span<const Counter> counters,
                                                           std::uint32_t counted) {
    std::uint32_t sum = 0;
    for (std::uint32_t p = 1; p < counters.size(); ++p)
      sum += (p & counted) != 0 ? counters[p].get() : 0U;
    return sum;
  }

  std::uint32_t last_ = 0;
  std::array<Counter, 16> ordinary_{};
  std::array<Counter, 16> of_sample_{};
  std::array<Counter, 8> of_place_{};
  std::array<Counter, 8> of_machine_{};
};

}  // namespace volcomp
