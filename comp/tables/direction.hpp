#pragma once
// Direction of travel with hysteresis, so that encoder noise does not flip the table.

#include <cstdint>

#include "comp/core/inline.hpp"

namespace volcomp {

// A word: the fast path writes it together with the edge.
enum class Direction : std::uint32_t { forward = 0, backward = 1, unknown = 2 };

class DirectionTracker {
 public:
  // Unknown until the axis has moved by more than half the hysteresis.
  [[nodiscard]] Direction direction() const { return direction_; }

  // `position`: low 32 bits in nm or 2^-32 turn, may wrap; steps up to 2.1 m. A window of width
  // `hysteresis` is dragged along; its upper edge moving means forward, its lower edge backward.
  // Interrupt-safe.
  Direction update(std::uint32_t position, std::int32_t hysteresis) {
    if (started_) return follow(position, hysteresis);
    started_ = true;
    lower_edge_ = position - static_cast<std::uint32_t>(hysteresis / 2);
    return direction_;
  }

  // As if every position so far had been further by this much: more counts as position from now on.
  void shift(std::uint32_t by) { lower_edge_ += by; }

  // The same once it has been started. Selections, not branches: a flip costs nothing.
  VOLCOMP_INLINE Direction follow(std::uint32_t position, std::int32_t hysteresis) {
    const auto above = static_cast<std::int32_t>(position - lower_edge_);
    const bool left = static_cast<std::uint32_t>(above) > static_cast<std::uint32_t>(hysteresis);
    const bool backward = above < 0;
    const std::uint32_t edge = position - (backward ? 0U : static_cast<std::uint32_t>(hysteresis));
    lower_edge_ = left ? edge : lower_edge_;
    direction_ = left ? static_cast<Direction>(backward) : direction_;
    return direction_;
  }

 private:
  std::uint32_t lower_edge_ = 0;
  Direction direction_ = Direction::unknown;
  bool started_ = false;
};

}  // namespace volcomp
