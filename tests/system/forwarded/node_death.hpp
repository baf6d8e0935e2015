#pragma once
// How far two axes leave their circle when the node dies under way, until both stand: by who
// notices it, by what the drives make of a missing target, and by how many of the axes take their
// targets from the node.

#include "tests/system/forwarded/forwarded_world.hpp"

namespace volcomp::sim {

// Who notices it first. Then the controller sees in 6041h that an axis has stopped, and stops all
// others (quick stop by 6040h).
enum class DeathWatch : std::uint8_t {
  nobody,      // the node lives; the controller stops all axes: what a quick stop costs by itself
  controller,  // 180h + 32 is missing in a cycle
  rpdo_timer,  // 140xh:05 of the drives that the node serves: three cycles
  heartbeat,   // 1016h of all drives: 30 ms, 1017h of the node 10 ms, 6007h = 3
};

struct NodeDeath {
  DeathWatch watch = DeathWatch::controller;
  DriveBehaviour::MissingTarget missing = DriveBehaviour::MissingTarget::held;
  bool both_forwarded = true;  // else X alone, and Y takes 60B0h
  double feed_m_per_s = 1.0;
};

// 6085h in nm/s² holds at most 4.29 m/s².
inline constexpr std::uint32_t kDeathDeceleration = 4'000'000'000;
inline constexpr double kDeathRadius_mm = 250.0;  // 1 m/s is 4 m/s² there
// Cycles of one turn.
[[nodiscard]] int death_cycles(double feed_m_per_s);

// The node dies `cycle` cycles after the circle has begun. The largest distance of the axes from
// the circle from then on, in mm. Throws std::runtime_error when the machine does not start or
// does not stop.
[[nodiscard]] double path_error_mm(const NodeDeath& death, int cycle);

}  // namespace volcomp::sim
