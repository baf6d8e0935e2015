#pragma once
// What a tick was, by what went in and by the status words that came out, and what the ticks of
// each kind cost.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/tick/tick_types.hpp"

namespace volcomp::target {

enum class TickKind : std::uint8_t {
  everyday,  // every axis corrected, nothing limited
  limited,   // an offset or the change of one is limited, was in the tick before, or is beyond half
             // its limit, where the limiter keeps room to stop
  change,    // tables are exchanged or are being ramped in, or were in the tick before
  anything,  // all ticks, faults included
};
inline constexpr std::array<const char*, 4> kTickKindNames{"everyday", "limited", "change",
                                                           "anything"};

// The status words of one tick, together, and where its offsets are.
struct Seen {
  static constexpr std::uint32_t kLimits = kClamped | kRateLimited | kAccelerationLimited;

  std::uint32_t any = 0;
  bool all_reported = true;
  bool near_limit = false;  // an offset is beyond half its limit

  template <std::size_t Axes>
  static Seen of(const TickOutput<Axes>& out, const CompensatorSettings<Axes>& settings,
                 std::size_t axes) {
    Seen seen;
    for (std::size_t a = 0; a < axes; ++a) {
      seen.any |= out.status[a];
      seen.all_reported = seen.all_reported && out.status[a] != 0;
      const std::int32_t half = settings.axis[a].limit / 2;
      seen.near_limit = seen.near_limit || out.offset[a] > half || out.offset[a] < -half;
    }
    return seen;
  }

  [[nodiscard]] bool limited() const { return near_limit || (any & kLimits) != 0; }
  // Nothing but what ordinary operation brings.
  [[nodiscard]] bool ordinary() const {
    return all_reported && (any & ~(kValid | kLimits | kRamping)) == 0;
  }
};

// A tick of ordinary operation. The status words of the one before count, too: an offset that
// arrives where it was held back from, or comes back from a fault, has no everyday tick yet.
inline TickKind kind_of(const Seen& before, const Seen& now, bool exchanged) {
  if (!before.ordinary() || !now.ordinary()) return TickKind::anything;
  if (exchanged || ((before.any | now.any) & kRamping) != 0) return TickKind::change;
  return before.limited() || now.limited() ? TickKind::limited : TickKind::everyday;
}

class WorstCost {
 public:
  struct Entry {
    std::uint32_t count = 0;
    std::uint32_t least = UINT32_MAX;  // instructions
    std::uint32_t most = 0;
  };

  void add(TickKind kind, std::uint32_t instructions) {
    count(entry_[static_cast<std::size_t>(kind)], instructions);
    if (kind != TickKind::anything) count(entry_.back(), instructions);
  }
  [[nodiscard]] const Entry& of(std::size_t kind) const { return entry_[kind]; }

 private:
  static void count(Entry& entry, std::uint32_t instructions) {
    ++entry.count;
    if (instructions < entry.least) entry.least = instructions;
    if (instructions > entry.most) entry.most = instructions;
  }

  std::array<Entry, kTickKindNames.size()> entry_{};
};

}  // namespace volcomp::target
