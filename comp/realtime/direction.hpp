#pragma once
// Direction of travel with hysteresis, so that encoder noise does not flip the table (seed 001
// section 5.3).

#include <cstdint>

#include "comp/realtime/inline.hpp"

namespace volcomp {

enum class Direction : std::uint8_t { forward = 0, backward = 1, unknown = 2 };

class DirectionTracker {
 public:
  // Unknown until the axis has moved by more than half the hysteresis.
  [[nodiscard]] Direction direction() const { return direction_; }

  // `position`: low 32 bits in nm or 2^-32 turn, may wrap; steps up to 2.1 m. A window of width
  // `hysteresis` is dragged along; its upper edge moving means forward, its lower edge backward.
  // Interrupt-safe.
  VOLCOMP_INLINE Direction update(std::uint32_t position, std::int32_t hysteresis) {
    if (!started_) {
      started_ = true;
      direction_ = Direction::unknown;
      lower_edge_ = position - static_cast<std::uint32_t>(hysteresis / 2);
      return direction_;
    }
    const auto above = static_cast<std::int32_t>(position - lower_edge_);
    if (above > hysteresis) {
      lower_edge_ = position - static_cast<std::uint32_t>(hysteresis);
      direction_ = Direction::forward;
    } else if (above < 0) {
      lower_edge_ = position;
      direction_ = Direction::backward;
    }
    return direction_;
  }

 private:
  std::uint32_t lower_edge_ = 0;
  Direction direction_ = Direction::unknown;
  bool started_ = false;
};

}  // namespace volcomp
