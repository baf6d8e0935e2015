#pragma once
// How the correction of an axis reaches its drive, 2034h. Numbers are stable.

#include <cstdint>

namespace volcomp::node {

enum class Way : std::uint8_t {
  offset = 0,            // 60B0h by PDO, beside the target of the controller
  forwarded_target = 1,  // the drive takes 607Ah from the node, 6040h from the controller
  forwarded_frame = 2,   // both from the node: not built
  controller_adds = 3,   // the controller adds what the node tells it to its next target
  none = 4,              // the drive takes no correction
};

// 2037h: nobody has read the mapping of the drive back.
inline constexpr std::uint8_t kNobody = 255;

// 2600h:03, above the status bits of the axes: an axis whose targets are forwarded got none in this
// cycle, or waits for its drive.
inline constexpr std::uint16_t kForwardingIncomplete = 1U << 15U;

// Targets are forwarded to drives in this mode only (6061h, CiA 402-2): cyclic synchronous
// position.
inline constexpr std::int8_t kCyclicPosition = 8;

}  // namespace volcomp::node
