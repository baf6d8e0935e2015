#pragma once
// What a compensator promises a drive whatever comes in: no offset beyond its limit, no step beyond
// its rate, no change of the step beyond its acceleration, no error that is not a number. An offset
// may be beyond the limit where the drive has started there or the limit has become smaller; it
// then goes no further, and comes back.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "comp/tables/runtime_chain.hpp"
#include "comp/tick/tick_types.hpp"
#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {

template <class Unit>
class OffsetPromise {
 public:
  // After configure().
  void configured(const typename Unit::Settings& settings) {
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      axis_[a].changed(settings.axis[a]);
  }
  // After start_from(), or with zeros after restart(); the settings stay.
  void started(const std::array<std::int32_t, Unit::kAxes>& offsets) {
    for (std::size_t a = 0; a < Unit::kAxes; ++a)
      axis_[a].started(offsets[a]);
  }
  // After begin_at_zero().
  void started_at_zero(std::size_t axis) { axis_[axis].started(0); }

  // After a tick: what is broken, or nullptr. `axis`: of which axis.
  const char* broken_by(const Unit& unit, const typename Unit::Output& out, std::size_t& axis) {
    for (const float e : unit.last_error_nm()) {
      if (!std::isfinite(e)) return "the error is not a number";
    }
    return offsets_broken_by(unit, out, axis);
  }
  // The same where tables have been damaged in memory: the error may then be anything.
  const char* offsets_broken_by(const Unit& unit, const typename Unit::Output& out,
                                std::size_t& axis) {
    for (axis = 0; axis < unit.machine().chain.axes; ++axis) {
      const char* const broken = broken_by(unit, axis, out.offset[axis], out.status[axis]);
      if (broken != nullptr) return broken;
    }
    return nullptr;
  }

  [[nodiscard]] const LimitedPromise& of(std::size_t axis) const { return axis_[axis]; }

 private:
  const char* broken_by(const Unit& unit, std::size_t a, std::int32_t offset,
                        std::uint32_t status) {
    constexpr std::uint32_t kHolds = kStale | kNoAuthority | kRamping;
    LimitedPromise& axis = axis_[a];
    const Int from = axis.offset();
    const bool outward = from < 0 ? axis.step() < 0 : axis.step() > 0;
    if (const char* const broken = axis.broken_by(offset); broken != nullptr) return broken;
    const UsedLimits& l = axis.limits().now();
    const Int before = std::abs(from);
    const Int now = std::abs(axis.offset());
    if (before <= l.limit || axis.limits().waiting() || !takes_offsets(unit, a)) return nullptr;
    if (now >= before && !outward) return "does not come back to its limit";
    const bool held = (status & kHolds) != 0;
    if (l.none && !held && now > std::max(l.limit, before - l.soft_rate))
      return "comes back too slowly";
    return nullptr;
  }

  static bool takes_offsets(const Unit& unit, std::size_t axis) {
    const auto& chain = unit.machine().chain;
    return chain.correcting_index[axis] != kNotCorrecting ||
           (Unit::kOrients && chain.orienting_index(axis) != kNotOrienting);
  }

  std::array<LimitedPromise, Unit::kAxes> axis_{};
};

}  // namespace volcomp::test
