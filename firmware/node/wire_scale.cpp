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
constexpr std::int64_t kOffsetsPerTurn = std::int64_t{1} << 32;

// The same length in both: `wire` of a unit of the drive, `offset` of one of an offset.
struct Parts {
  std::int64_t offset;
  std::int64_t wire;
};

Parts parts_of(const WireScale& scale) {
  if (scale.per_turn != 0) return {scale.per_turn, kOffsetsPerTurn};
  return {std::int64_t{scale.denominator} * (scale.rotary ? kOffsetToPosition : 1),
          scale.numerator};
}

}  // namespace

double units_per_wire(const WireScale& scale) {
  if (scale.per_turn != 0) return 0x1p40 / scale.per_turn;
  return static_cast<double>(scale.numerator) / scale.denominator;
}

std::int32_t offset_to_wire(std::int32_t offset, const WireScale& scale) {
  const Parts parts = parts_of(scale);
  return saturated(divide_half_even(offset * parts.offset, parts.wire));
}

std::int32_t step_to_wire(std::int32_t step, const WireScale& scale) {
  const Parts parts = parts_of(scale);
  const std::int32_t nearest = offset_to_wire(step, scale);
  return nearest - (nearest * parts.wire > step * parts.offset ? 1 : 0);
}

std::int32_t bound_to_wire(std::int32_t step, const WireScale& scale) {
  const Parts parts = parts_of(scale);
  const std::int32_t nearest = offset_to_wire(step, scale);
  const bool more = nearest < INT32_MAX && nearest * parts.wire < step * parts.offset;
  return nearest + (more ? 1 : 0);
}

std::int32_t offset_from_wire(std::int32_t wire, const WireScale& scale) {
  const Parts parts = parts_of(scale);
  return saturated(divide_half_even(wire * parts.wire, parts.offset));
}

// A turn has 2^40 units: in two steps of 20 bits, as one product would overflow.
std::uint64_t WirePosition::advance(std::int32_t moved, std::uint32_t per_turn) {
  constexpr unsigned kStep = 20;
  constexpr std::int64_t kFactor = std::int64_t{1} << kStep;
  const Division high = divide(moved * kFactor, per_turn);
  const Division low = divide(high.remainder * kFactor + rest_, per_turn);
  rest_ = low.remainder;
  return (static_cast<std::uint64_t>(high.quotient) << kStep) +
         static_cast<std::uint64_t>(low.quotient);
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
  const bool wrapped = std::int64_t{wire} - last_ != moved;
  last_ = wire;
  if (scale.per_turn != 0) {
    const bool whole_turns = (scale.per_turn & (scale.per_turn - 1U)) == 0;
    lost_ = lost_ || (wrapped && !whole_turns);
    whole_ += advance(moved, scale.per_turn);
    return static_cast<std::int64_t>(whole_);
  }
  const Division d = divide(rest_ + std::int64_t{moved} * scale.numerator, scale.denominator);
  whole_ += static_cast<std::uint64_t>(d.quotient);
  rest_ = d.remainder;
  return static_cast<std::int64_t>(whole_);
}

}  // namespace volcomp::node
