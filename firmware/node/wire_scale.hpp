#pragma once
// Position units of a drive to run-time units and back, exactly: an axis has numerator/denominator
// run-time units per wire unit (conventions, section 5), or so many wire units per turn. Run-time
// units of a position: nm or 2^-40 turn; of an offset: nm or 2^-32 turn.

#include <cstdint>

namespace volcomp::node {

inline constexpr std::uint32_t kMostScale = 1U << 20U;

struct WireScale {
  std::uint32_t numerator = 1;    // 1…kMostScale
  std::uint32_t denominator = 1;  // 1…kMostScale
  bool rotary = false;
  std::uint32_t per_turn = 0;  // rotary: wire units, instead of the fraction; 0: the fraction holds
};

// Run-time units of a position per wire unit, for speeds.
[[nodiscard]] double units_per_wire(const WireScale& scale);
// Offset of the run time in wire units, half to even, saturating.
[[nodiscard]] std::int32_t offset_to_wire(std::int32_t offset, const WireScale& scale);
// A limit of steps: never more than `step`, so rounded down, saturating.
[[nodiscard]] std::int32_t step_to_wire(std::int32_t step, const WireScale& scale);
// What no step of at most `step` exceeds but for its rounding, so rounded up, saturating.
[[nodiscard]] std::int32_t bound_to_wire(std::int32_t step, const WireScale& scale);
// The nearest run-time offset, saturating.
[[nodiscard]] std::int32_t offset_from_wire(std::int32_t wire, const WireScale& scale);

// A position on the wire is 32 bits wide. A linear axis uses it directly; a rotary axis wraps and
// is counted through by differences, which must stay below half the range per cycle.
class WirePosition {
 public:
  std::int64_t update(std::int32_t wire, const WireScale& scale);
  void reset() { started_ = lost_ = false; }
  // The wire has wrapped, and its range is no whole number of turns: this counts on, but after a
  // restart nobody would know in which turn the axis is.
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  std::uint64_t advance(std::int32_t moved, std::uint32_t per_turn);

  std::uint64_t whole_ = 0;  // wraps after a whole number of turns
  std::int64_t rest_ = 0;    // 0 ≤ rest < denominator
  std::int32_t last_ = 0;
  bool started_ = false;
  bool lost_ = false;
};

}  // namespace volcomp::node
