#pragma once
// Traces of a flank and the pitch of a gear with their grades by both editions of ISO 1328-1.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/gears/involute_gear.hpp"
#include "comp/metrology/gears/pitch.hpp"

namespace volcomp::host {

inline constexpr std::array<FlankSide, 2> kFlankSides{FlankSide::left, FlankSide::right};
inline constexpr std::array<const char*, 2> kFlankNames{"left", "right"};
inline constexpr std::array<GearStandard, 2> kGearStandards{GearStandard::iso1328_1995,
                                                            GearStandard::iso1328_2013};

// A touch that was meant for the end of the range belongs to it, though encoders count nanometres.
inline constexpr double kTraceEnd_mm = 1e-5;

// Share of the roll length, from the root.
inline constexpr double kRollUsed1995 = 0.92;
inline constexpr double kRollUsed2013 = 0.95;
// Range of the roll length: the share `used` of it.
[[nodiscard]] EvaluationRange profile_range(const InvoluteGear& gear, double used);
[[nodiscard]] EvaluationRange lead_range(const InvoluteGear& gear);

[[nodiscard]] GearSize size_of(const InvoluteGear& gear);

// None is worse than the last one.
[[nodiscard]] std::optional<int> worse_grade(const std::optional<int>& a,
                                             const std::optional<int>& b);

struct FlankTrace {
  std::vector<double> at;         // roll length or x, mm
  std::vector<double> deviation;  // µm, excess positive
  EvaluationRange range;          // of the edition of 1995
  TraceDeviations figures;        // over it, µm
  TraceDeviations figures_2013;   // over the range of that edition, µm
  std::optional<int> grade_1995;  // of the total deviation; none: worse than the last
  std::optional<int> grade_2013;
};

struct PitchRound {
  std::vector<double> position;   // of each tooth from where it should be, µm
  PitchDeviations figures;        // µm
  std::optional<int> grade_1995;  // the worse of single and total pitch
  std::optional<int> grade_2013;
};

// The low-pass that the edition of 2013 requires before evaluation, over the whole trace, cut-off
// from `range` (trace_filter.hpp). Puts the trace in order; touches of one place count as their
// mean. Throws UserError with `name` for points too far apart to filter.
void filter_as_2013(FlankTrace& trace, const EvaluationRange& range, const std::string& name);

// From `at` and `deviation`, or from `position`, to the rest. Throw UserError with `name` for what
// cannot be evaluated: fewer than three points in the range, teeth that are missing.
void grade_profile(const InvoluteGear& gear, const std::string& name, FlankTrace& trace);
void grade_lead(const InvoluteGear& gear, const std::string& name, FlankTrace& trace);
void grade_pitch(const InvoluteGear& gear, const std::string& name, PitchRound& round);

}  // namespace volcomp::host
