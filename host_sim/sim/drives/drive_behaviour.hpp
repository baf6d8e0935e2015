#pragma once
// What no data sheet tells of a drive: how it behaves where CiA 402-2 leaves it open. The defaults
// are those of the complete simulated drive. When a target arrives over an RPDO of type 254 or 255
// is a matter of that RPDO, and the PDOs after boot-up of the profile.

#include <cstdint>
#include <optional>

namespace volcomp::sim {

// 607Bh: positions wrap from one end to the other.
struct PositionRange {
  std::int32_t lowest = INT32_MIN;
  std::int32_t highest = INT32_MAX;

  [[nodiscard]] std::int64_t width() const {
    return std::int64_t{highest} - std::int64_t{lowest} + 1;
  }
  // The same place inside the range.
  [[nodiscard]] std::int64_t inside(std::int64_t units) const {
    const std::int64_t rest = (units - lowest) % width();
    return lowest + (rest < 0 ? rest + width() : rest);
  }
  // Of the distances that differ by whole ranges, the shortest.
  [[nodiscard]] std::int64_t shortest(std::int64_t units) const {
    const std::int64_t half = width() / 2;
    const std::int64_t rest = (units + half) % width();
    return (rest < 0 ? rest + width() : rest) - half;
  }
};

struct DriveBehaviour {
  // In force when operation is enabled, or the mode becomes cyclic synchronous position, until the
  // next 607Ah: where the axis stands, or the 607Ah of before.
  enum class AtEnabling : std::uint8_t { stands, keeps_target };
  // At a SYNC without a 607Ah since the one before.
  enum class MissingTarget : std::uint8_t { held, extrapolated, fault };
  // Position loop: takes its input at SYNC, or a 607Ah as soon as it is received.
  enum class TargetActs : std::uint8_t { at_sync, at_reception };
  // Target and offset beyond 607Dh.
  enum class BeyondLimit : std::uint8_t { clipped, fault };

  AtEnabling at_enabling = AtEnabling::stands;
  MissingTarget missing_target = MissingTarget::held;
  std::uint8_t patience = 3;  // targets in a row that are extrapolated; missing before the fault
  // RPDO timer (140xh:05): a fault after so many SYNCs in a row without a 607Ah, whatever is made
  // of each; 0: none.
  std::uint8_t target_timer = 0;
  TargetActs target_acts = TargetActs::at_sync;
  BeyondLimit beyond_limit = BeyondLimit::clipped;
  // A PDO that is longer than what is mapped is an error (8220h) instead of being used as far as
  // mapped (CiA 301, 7.2.2.2): {6040h} alone does not hear {6040h, 607Ah}, dummies must fill it.
  bool exact_length = false;
  std::optional<PositionRange> range;  // none: linear saturates, rotary wraps at 32 bits
};

}  // namespace volcomp::sim
