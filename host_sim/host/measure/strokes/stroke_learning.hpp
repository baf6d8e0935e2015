#pragma once
// Learns the offsets of C of a helical grinder from a log of its strokes: the same monitor and the
// same step of learning that a node runs (docs/papers/internal-helical.md).

#include <array>
#include <string>
#include <vector>

#include "comp/strokes/learning.hpp"
#include "host_sim/host/measure/strokes/stroke_log.hpp"
#include "host_sim/host/tables/learned_tables.hpp"

namespace volcomp::host {

// Of a signal over the face, mm or rad: largest magnitude and root mean square.
struct SignalSize {
  double peak = 0.0;
  double rms = 0.0;
};

// One of the tables: by direction of the stroke, then by slot.
struct TableStep {
  LearningReport report;
  double before_um = 0.0;  // rms on the flank of what comes back in every pass
  double after_um = 0.0;   // the same with the new table, if it comes back alike
  double peak_rad = 0.0;   // of the new table
};

struct StrokesLearned {
  MachineFile machine;
  std::string log;
  std::size_t cycles = 0;
  double period_s = 0.0;
  double feed_mm_per_s = 0.0;           // median over the face
  std::array<std::size_t, 2> passes{};  // upwards, downwards
  std::vector<std::string> discarded;   // passes, each with its reason
  bool has_x = false;
  SignalSize x;
  SignalSize z;
  SignalSize c;
  SignalSize out_of_step_um;  // e_C + e_Z / p on the flank, cycle by cycle
  std::array<TableStep, 3> step{};
  LearnedTables tables;
  std::string slot_0;  // how slots were counted

  // A table was changed, and none refused the step.
  [[nodiscard]] bool good() const;
};

struct LearnSettings {
  double weight = 0.5;               // of the step, 0 < w ≤ 1
  std::vector<std::uint8_t> before;  // learned tables that were in force; empty: none
  std::string before_name;
};

// Throws UserError where the machine file has no [gear], the gear or the stroke has more places
// than a table, or the log holds no whole pass.
[[nodiscard]] StrokesLearned learn_strokes(const StrokeLog& log, const MachineFile& machine,
                                           const LearnSettings& settings);

}  // namespace volcomp::host
