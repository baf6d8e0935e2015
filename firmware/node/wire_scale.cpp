#include "firmware/node/wire_scale.hpp"

#include <algorithm>

namespace volcomp::node {
namespace {

struct Division {
  std::int64_t quotient;   // floor
  std::int64_t remainder;  // 0 ≤ remainder < divisor
};

// Most drives count in whole run-time units, and a division of 64 bits takes hundreds of
// instructions.
Division divide(std::int64_t value, std::int64_t divisor) {
  if (divisor == 1) return {value, 0};
  Division d{value / divisor, value % divisor};
  if (d.remainder < 0) {
    --d.quotient;
    d.remainder += divisor;
  }
  return d;
}

std::int64_t divide_half_even(std::int64_t value, std::int64_t divisor) {
  const Division d = divide(value, divisor);
  const std::int64_t twice = 2 * d.remainder;
  const bool up = twice > divisor || (twice == divisor && (d.quotient & 1) != 0);
  return d.quotient + (up ? 1 : 0);
}

std::int32_t saturated(std::int64_t value) {
  return static_cast<std::int32_t>(
      std::max<std::int64_t>(INT32_MIN, std::min<std::int64_t>(INT32_MAX, value)));
}

constexpr std::int64_t kOffsetToPosition = 256;  // 2^-32 turn in 2^-40 turn

// In a `denominator`th of the units of a position.
std::int64_t parts_of(std::int32_t offset, const WireScale& scale) {
  return std::int64_t{offset} * (scale.rotary ? kOffsetToPosition : 1) * scale.denominator;
}

}  // namespace

std::int32_t offset_to_wire(std::int32_t offset, const WireScale& scale) {
  return saturated(divide_half_even(parts_of(offset, scale), scale.numerator));
}

std::int32_t step_to_wire(std::int32_t step, const WireScale& scale) {
  const std::int32_t nearest = offset_to_wire(step, scale);
  const bool more = std::int64_t{nearest} * scale.numerator > parts_of(step, scale);
  return nearest - (more ? 1 : 0);
}

std::int32_t offset_from_wire(std::int32_t wire, const WireScale& scale) {
  const std::int64_t divisor =
      std::int64_t{scale.denominator} * (scale.rotary ? kOffsetToPosition : 1);
  return saturated(divide_half_even(std::int64_t{wire} * scale.numerator, divisor));
}

std::int64_t WirePosition::update(std::int32_t wire, const WireScale& scale) {
  if (!scale.rotary)
    return divide_half_even(std::int64_t{wire} * scale.numerator, scale.denominator);
  if (!started_) {
    whole_ = 0;
    rest_ = last_ = 0;
  }
  started_ = true;
  // Wraps by design: the difference of two unsigned counters.
  const auto moved = static_cast<std::int32_t>(static_cast<std::uint32_t>(wire) -
                                               static_cast<std::uint32_t>(last_));
  last_ = wire;
  const Division d = divide(rest_ + std::int64_t{moved} * scale.numerator, scale.denominator);
  whole_ += static_cast<std::uint64_t>(d.quotient);
  rest_ = d.remainder;
  return static_cast<std::int64_t>(whole_);
}

}  // namespace volcomp::node
