#pragma once
// The frames of one cycle on a bus with 1 Mbit/s, by the way of each axis, and what they leave the
// node between the last target and its own last frame.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/node/ways.hpp"

namespace volcomp::host {

inline constexpr double kBitRate = 1e6;

struct CycleAxis {
  node::Way way = node::Way::offset;
  bool confirmed = true;  // the drive reports the offset it holds (2207h): 480h + n
};
using CycleAxes = std::vector<CycleAxis>;

// Bits of the frames of a cycle, with or without the status frame of the node.
struct CycleBits {
  std::uint32_t nominal = 0;  // without stuff bits
  std::uint32_t worst = 0;    // the most stuff bits frames of these sizes can have
};
[[nodiscard]] CycleBits bits_of_cycle(const CycleAxes& axes, bool with_status);

// The drive of an axis takes its targets from the node.
[[nodiscard]] bool forwards_targets(const CycleAxes& axes);
// A controller that adds the offset, or whose targets pass through the node, needs the state of the
// node in every cycle.
[[nodiscard]] bool needs_status(const CycleAxes& axes);

// The largest rate of SYNC with 70 % of the bus taken by these frames at their worst, Hz. The rest
// is for SDO, heartbeats and emergencies.
[[nodiscard]] double largest_rate_hz(const CycleAxes& axes, bool with_status);

// All times in µs.
struct CycleTimes {
  std::uint32_t period = 0;       // 1006h
  std::uint32_t deadline = 0;     // 2200h:03, after SYNC; 0: 60 % of the period
  std::uint32_t last_target = 0;  // after SYNC, as measured (2620h:07); 0: not measured
};

// How long the node may take (2620h:05), in µs; negative: the frames alone do not fit. Worst
// stuffing; left for others are one frame of lower priority that is being sent, one that delays the
// next SYNC, and an emergency, 135 µs each.
struct LatencyBudget {
  std::int64_t last_target = 0;     // after SYNC: as measured, at least what the frames take
  std::int64_t deadline = 0;        // after SYNC
  std::int64_t usual = 0;           // L when every target has come
  std::int64_t with_edge = 0;       // L while every drive reports an edge of the probe
  std::int64_t after_deadline = 0;  // L when a frame was missing, and all waited until the deadline
  std::int64_t deadline_from = 0;   // the deadline must be later than this
  // Before this the deadline must be, for a node that takes `latency`.
  [[nodiscard]] std::int64_t deadline_until(std::int64_t latency) const {
    return deadline + after_deadline - latency;
  }
};
[[nodiscard]] LatencyBudget latency_budget(const CycleAxes& axes, const CycleTimes& times);

}  // namespace volcomp::host
