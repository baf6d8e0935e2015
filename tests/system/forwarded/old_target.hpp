#pragma once
// The hazard of forwarded targets: a drive is enabled by the controller, gets no target from the
// node, and goes to the one there was before. The axis has been moved by hand meanwhile.

#include "tests/system/forwarded/forwarded_world.hpp"

namespace volcomp::sim {

struct OldTarget {
  // The node sends targets, or nothing: it waits for 2037h, and says so by bit 15 of 2600h:03.
  enum class Node : std::uint8_t { serves, dead, waits };
  Node node = Node::dead;
  // It enables whatever the node says; else it heeds 180h + 32.
  bool careless = false;
  bool controlword_at_once = false;          // RPDO1 of type 255
  std::uint16_t following_timeout_ms = 0;    // 6066h; 6065h is 1 mm
  double most_acceleration_mm_per_s2 = 0.0;  // of the axis; 0: no limit
};

inline constexpr double kMovedByHand_mm = 50.0;

struct AfterEnabling {
  double moved_mm = 0.0;  // until it stands
  bool enabled = false;   // at any time
  bool faulted = false;   // 8611h
};
// Throws std::runtime_error when the machine does not start.
[[nodiscard]] AfterEnabling enable_with_old_target(const OldTarget& way);

}  // namespace volcomp::sim
