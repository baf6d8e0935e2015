#pragma once
// An offset that acts a cycle late (2034h = 3), as it will be then: it goes on as it went last.
//
// Positions are not extrapolated: an axis that stops would be seen to turn, by its deceleration
// times the period squared, which is more than a hysteresis. Of the last two changes of the offset
// the smaller one counts, and none when their signs differ (the minmod limiter of finite volumes),
// so a reversal or a jump is a cycle late, but never overshoots. What is left at a steady
// acceleration is that times the period squared, times the slope of the table.

#include <cstdint>
#include <cstdlib>

namespace volcomp::node {

class LookAhead {
 public:
  // |offset| ≤ 2^30, as of a compensator.
  std::int32_t next(std::int32_t offset) {
    const std::int32_t change = offset - last_;
    const bool goes_on = (change > 0 && before_ > 0) || (change < 0 && before_ < 0);
    const std::int32_t least = std::abs(change) < std::abs(before_) ? change : before_;
    last_ = offset;
    before_ = change;
    return goes_on ? offset + least : offset;
  }

 private:
  std::int32_t last_ = 0;
  std::int32_t before_ = 0;  // the change before
};

}  // namespace volcomp::node
