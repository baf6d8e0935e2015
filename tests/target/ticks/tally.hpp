#pragma once
// What a tick turned out to be, and what the ticks of each kind cost.

#include <array>
#include <cstddef>
#include <cstdint>

namespace volcomp::target {

// A tick can be of several kinds at once.
enum class Kind : std::uint8_t {
  any,
  plain,     // none of the following
  segment,   // an axis entered another segment of its table
  reversal,  // an axis turned round, beyond the hysteresis
  clamp,     // an offset was limited
  rate,      // the change of an offset was limited
  swap,      // tables were exchanged at its beginning
  ramp,      // on the way to new tables
  status,    // the status word of an axis changed
  // faults
  outside,    // an axis stood beyond its table
  lost,       // the position of an axis was missing or implausible
  not_homed,  // an axis was not referenced
  off,        // corrections were switched off
};
inline constexpr std::array<const char*, 13> kKindNames{
    "any",  "plain",  "segment", "reversal", "clamp",     "rate", "swap",
    "ramp", "status", "outside", "lost",     "not_homed", "off"};

using Kinds = std::uint32_t;  // a bit per kind
constexpr Kinds bit(Kind kind) { return 1U << static_cast<unsigned>(kind); }

class Tally {
 public:
  struct Entry {
    std::uint32_t count = 0;
    std::uint32_t least = UINT32_MAX;  // instructions
    std::uint32_t most = 0;
  };

  void add(Kinds kinds, std::uint32_t instructions) {
    for (std::size_t k = 0; k < entry_.size(); ++k) {
      if ((kinds >> k & 1U) == 0) continue;
      Entry& e = entry_[k];
      ++e.count;
      if (instructions < e.least) e.least = instructions;
      if (instructions > e.most) e.most = instructions;
    }
  }
  [[nodiscard]] const Entry& of(std::size_t kind) const { return entry_[kind]; }

 private:
  std::array<Entry, kKindNames.size()> entry_{};
};

}  // namespace volcomp::target
