#pragma once
// What a compensator promises a drive whatever comes in: no offset beyond its limit, no step beyond
// its rate, no error that is not a number. An offset may be beyond the limit where the drive has
// started there or the limit has become smaller; it then goes no further, and comes back.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "comp/tick/tick_types.hpp"

namespace volcomp::test {

template <class Unit>
class OffsetPromise {
 public:
  // After configure().
  void configured(const typename Unit::Settings& settings) {
    limits_ = settings.axis;
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      furthest_[a] = std::max(limit(a), std::abs(last_[a]));
  }
  // After start_from(), or with zeros after restart(); the settings stay.
  void started(const std::array<std::int32_t, Unit::kAxes>& offsets) {
    last_ = offsets;
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      furthest_[a] = std::max(limit(a), std::abs(last_[a]));
  }

  // After a tick: what is broken, or nullptr. `axis`: of which axis.
  const char* broken_by(const Unit& unit, const typename Unit::Output& out, std::size_t& axis) {
    for (const float e : unit.last_error_nm()) {
      if (!std::isfinite(e)) return "the error is not a number";
    }
    for (axis = 0; axis < unit.machine().chain.axes; ++axis) {
      const char* const broken = broken_by(unit, axis, out.offset[axis], out.status[axis]);
      if (broken != nullptr) return broken;
      last_[axis] = out.offset[axis];
    }
    return nullptr;
  }

  [[nodiscard]] std::int32_t furthest(std::size_t axis) const { return furthest_[axis]; }
  [[nodiscard]] std::int32_t last(std::size_t axis) const { return last_[axis]; }

 private:
  [[nodiscard]] std::int32_t limit(std::size_t axis) const { return limits_[axis].limit; }

  const char* broken_by(const Unit& unit, std::size_t a, std::int32_t offset,
                        std::uint32_t status) {
    constexpr std::uint32_t kHolds = kStale | kNoAuthority | kRamping;
    const std::int32_t size = std::abs(offset);
    const std::int32_t before = std::abs(last_[a]);
    if (std::abs(std::int64_t{offset} - last_[a]) > limits_[a].rate) return "faster than its rate";
    if (size > furthest_[a]) return "beyond its limit";
    if ((status & kRamping) != 0) return nullptr;
    if ((status & kHolds) == 0 && takes_offsets(unit, a) &&
        size > std::max(limit(a), before - limits_[a].soft_rate))
      return "does not come back to its limit";
    furthest_[a] = std::max(limit(a), size);
    return nullptr;
  }

  static bool takes_offsets(const Unit& unit, std::size_t axis) {
    const auto& chain = unit.machine().chain;
    return chain.correcting_index[axis] != kNotCorrecting ||
           (Unit::kOrients && chain.orienting_index(axis) != kNotOrienting);
  }

  std::array<AxisLimits, Unit::kAxes> limits_{};
  std::array<std::int32_t, Unit::kAxes> last_{};
  std::array<std::int32_t, Unit::kAxes> furthest_{};  // no offset is larger before it has come back
};

}  // namespace volcomp::test
