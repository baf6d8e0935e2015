#pragma once
// Settings of gear and strokes for the compensation of a helical grinder, on a node or integrated.

#include "comp/strokes/helix_monitor.hpp"
#include "comp/strokes/learning_choice.hpp"
#include "comp/strokes/stroke_offsets.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

struct WatchedStrokes {
  std::uint16_t slots = 0;  // of the gear
  HelixMonitorSettings monitor;
  StrokeOffsetSettings offsets;
  LearningRules along;   // the stroke, for the tables by direction
  LearningRules around;  // the gear, for the table by slot
  LearningTarget target = LearningTarget::synchronisation;
};

inline constexpr double kNodeSpacing_mm = 0.25;  // of the tables along the stroke

// For this gear and stroke: half of the error is learned per step, within limits that keep a bad
// pass out and are several times what a grinder needs. `period_s`: of the cycle.
[[nodiscard]] WatchedStrokes watched_strokes(const GrindingFile& job, double pitch_mm,
                                             double period_s);

// The process state that the controller sends with the targets of a cycle.
struct ProcessState {
  std::uint16_t slot = 0;
  Direction stroke = Direction::unknown;
  bool in_face = false;     // the wheel is within the face width
  bool stroke_end = false;  // it turns round here
  std::int32_t feed_nm_per_s = 0;
};

}  // namespace volcomp::host
