#pragma once
// Profile, lead and pitch of an external cylindrical gear, graded by both editions of ISO 1328-1,
// from deviations of its flanks: those of points that a machine has touched, or of a gear centre.
//
// Traces are graded as they are: the edition of 2013 requires a Gaussian filter before, which would
// remove noise of the probe.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/gears/involute_gear.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/host/measure/gear_points_csv.hpp"

namespace volcomp::host {

inline constexpr std::array<FlankSide, 2> kFlankSides{FlankSide::left, FlankSide::right};
inline constexpr std::array<const char*, 2> kFlankNames{"left", "right"};
inline constexpr std::array<GearStandard, 2> kGearStandards{GearStandard::iso1328_1995,
                                                            GearStandard::iso1328_2013};

// Range of the roll length: the share `used` of it, from the root. The edition of 1995 uses 0.92,
// that of 2013 0.95.
[[nodiscard]] EvaluationRange profile_range(const InvoluteGear& gear, double used);
[[nodiscard]] EvaluationRange lead_range(const InvoluteGear& gear);

[[nodiscard]] GearSize size_of(const InvoluteGear& gear);

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

// From `at` and `deviation`, or from `position`, to the rest. Throw UserError with `name` for what
// cannot be evaluated: fewer than three points in the range, teeth that are missing.
void grade_profile(const InvoluteGear& gear, const std::string& name, FlankTrace& trace);
void grade_lead(const InvoluteGear& gear, const std::string& name, FlankTrace& trace);
void grade_pitch(const InvoluteGear& gear, const std::string& name, PitchRound& round);

// A deviation of the gear with the grade of each edition.
struct GearFigure {
  GearDeviation deviation = GearDeviation::profile;
  std::array<double, 2> um{};                 // by kGearStandards; the slope with its sign
  std::array<std::optional<int>, 2> grade{};  // none: worse than the last
};

struct InspectedTrace {
  GearTraceKind kind = GearTraceKind::profile;
  std::size_t side = 0;  // of kFlankSides
  int tooth = 0;         // from 0; of a pitch: unused
  std::size_t points = 0;
  std::vector<GearFigure> figures;
};

struct InspectedGear {
  std::vector<InspectedTrace> traces;         // profiles, leads, pitches; left before right
  std::array<bool, 2> covered{};              // does the edition cover a gear of this size?
  std::array<std::optional<int>, 2> grade{};  // worst of F_α, F_β, f_pt and F_p
  std::vector<std::string> warnings;
};

// Throws UserError naming the file, and the line where it has one: a tooth that the gear has not, a
// point that is on no flank of it, too few points, pitch of some teeth only.
[[nodiscard]] InspectedGear inspect_gear(const InvoluteGear& gear, const GearPointsFile& file);

}  // namespace volcomp::host
