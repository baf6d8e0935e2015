#pragma once
// From what the drives report of a probe edge, axis by axis, to one touch: complete, plausible,
// numbered. Whatever is wrong with an edge becomes a touch with a verdict, never silence.
//
// A drive latches its position at the edge and counts it, perhaps at once (CiA 402 touch probe,
// 60D5h); at the next SYNC it reports the position and the time since the SYNC before (60BAh,
// 60D1h). The report of one axis may come a cycle later than that of another: the edge was so close
// to a SYNC that their delays fall on either side of it. So an edge is judged when every axis has
// reported all of it, or at the end of the second cycle after the first report.

#include "comp/tick/touch.hpp"

namespace volcomp {

struct TouchRules {
  std::uint32_t axes = 0;  // in use, a bit per NC axis
  // Of these the time of the latch is not known: half a period after SYNC, or that much before or
  // after. Two edges that can have been one are one.
  std::uint32_t untimed = 0;
  std::int64_t period_ns = 0;                     // of SYNC
  std::int64_t bounce_ns = 1'000'000;             // no two touches are closer
  std::int64_t skew_ns = 2'000;                   // most between the edges of two axes
  std::array<std::int64_t, kMaxAxes> delay_ns{};  // from the edge to the latch of an axis
};

// What one drive reports in one cycle.
struct LatchReport {
  bool counted = false;          // edge_count is fresh
  bool latched = false;          // position and time are fresh
  bool homed = false;            // the axis is referenced
  bool moving = false;           // its velocity is known
  std::uint16_t edge_count = 0;  // 60D5h
  std::uint32_t time_ns = 0;     // 60D1h: since the SYNC before the edge
  LatchedAxis axis{};
};

class TouchCollector {
 public:
  // Forgets an edge that is under way.
  [[gnu::cold]] void configure(const TouchRules& rules);
  // The counters of the drives are not known any more.
  [[gnu::cold]] void restart();

  void report(std::size_t axis, const LatchReport& report);

  // At the end of a cycle, after the reports of all axes. When an edge has come to its end, that
  // touch, accepted or not, until the next call; else nullptr.
  const Touch* finish_cycle();

 private:
  struct AxisEdges {
    LatchedAxis latched{};
    std::int64_t edge_ns = 0;      // since start, of the latch minus its delay
    std::uint32_t time_ns = 0;     // of the latch
    std::uint16_t edge_count = 0;  // as last reported
    std::uint16_t edges = 0;       // in this touch
    bool homed = false;
    bool moving = false;
    // Cycles in which a latch makes an edge of the first report of the counter; without one it only
    // reports where the counter stands.
    std::uint8_t doubtful = 0;
  };
  void count(AxisEdges& a, std::uint32_t bit, std::uint16_t edge_count);
  void settle_doubts();
  [[nodiscard]] std::int64_t half_unknown_ns(std::size_t axis) const {
    return (rules_.untimed >> axis & 1U) != 0 ? rules_.period_ns / 2 : 0;
  }
  [[nodiscard]] TouchVerdict judge_axis(std::size_t axis) const;
  [[nodiscard]] TouchVerdict judge(std::uint8_t& axis) const;
  void close();

  TouchRules rules_{};
  std::array<AxisEdges, kMaxAxes> axis_{};
  // A bit per axis: its counter is known; known only by its first report; it has counted an edge,
  // latched a position, in this touch.
  std::uint32_t started_ = 0;
  std::uint32_t doubtful_ = 0;
  std::uint32_t counted_ = 0;
  std::uint32_t latched_ = 0;
  std::int64_t sync_ns_ = 0;       // of the SYNC before the last: latch times count from it
  std::int64_t last_edge_ns_ = 0;  // of the touch before
  bool any_yet_ = false;
  int cycles_open_ = 0;  // in which some axes have reported an edge, and not all
  Touch touch_{};        // the last; its sequence counts on
};

}  // namespace volcomp
