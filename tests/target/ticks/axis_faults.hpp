#pragma once
// Where axes go in the search for the most expensive tick, and what can be wrong with a sample.

#include <cstdint>

#include "comp/core/units.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp::target {

// Where an axis may go.
struct AxisRoom {
  std::int64_t low = 0;
  std::int64_t high = 0;
  std::int64_t pitch = 1;
  std::int64_t unit = 1;  // 1 mm or 1 mrad
};

// What can be wrong with a sample.
enum class Fault : std::uint8_t {
  none,
  lost,
  not_homed,
  beyond_end,
  before_start,
  beyond_end_not_homed,
  before_start_not_homed,
  lost_not_homed,
  lost_beyond_end,
  jump,    // further than an axis comes in one tick
  absurd,  // at the end of the integers, not homed
};
inline constexpr std::uint32_t kFaults = 11;

inline AxisSample faulty(AxisSample sample, Fault fault, const AxisRoom& room) {
  constexpr std::int64_t kFar = 2 * kUnitsPerTurn;
  const bool beyond = fault == Fault::beyond_end || fault == Fault::beyond_end_not_homed ||
                      fault == Fault::lost_beyond_end;
  const bool before = fault == Fault::before_start || fault == Fault::before_start_not_homed;
  if (beyond) sample.position += kFar;
  if (before) sample.position -= kFar;
  if (fault == Fault::jump) sample.position += 50 * room.unit;
  if (fault == Fault::absurd) sample.position = INT64_MIN + 1;
  sample.valid =
      fault != Fault::lost && fault != Fault::lost_not_homed && fault != Fault::lost_beyond_end;
  sample.homed = fault != Fault::not_homed && fault != Fault::beyond_end_not_homed &&
                 fault != Fault::before_start_not_homed && fault != Fault::lost_not_homed &&
                 fault != Fault::absurd;
  return sample;
}

}  // namespace volcomp::target
