#pragma once
// A counter of an interrupt that stays at its most, 65 535. Any context may read it.

#include <cstdint>

#include "comp/core/inline.hpp"
#include "comp/core/published.hpp"

#if defined(__ARM_FEATURE_SIMD32)
#include <arm_acle.h>
#endif

namespace volcomp {

class SaturatingCounter {
 public:
  static constexpr std::uint32_t kMost = UINT16_MAX;

  // For the context that writes.
  VOLCOMP_INLINE void increment() {
    count_.set(static_cast<std::uint16_t>(one_more(count_.own())));
  }
  [[nodiscard]] std::uint16_t get() const { return count_.get(); }

 private:
  VOLCOMP_INLINE static std::uint32_t one_more(std::uint32_t n) {
#if defined(__ARM_FEATURE_SIMD32)
    return __uqadd16(n, 1);  // the saturating addition that C has no word for
#else
    return n + 1U - (n + 1U) / (kMost + 1U);
#endif
  }

  Published<std::uint16_t> count_ = 0;
};

}  // namespace volcomp
