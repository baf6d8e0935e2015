#pragma once
// Profile, lead and pitch of an external cylindrical gear, graded by both editions of ISO 1328-1,
// from deviations of its flanks: those of points that a machine has touched, or of a gear centre.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/metrology/gears/run_out.hpp"
#include "host_sim/host/measure/gear_points_csv.hpp"
#include "host_sim/host/measure/gear_traces.hpp"

namespace volcomp::host {

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

// The same deviation of several teeth. A grade is about the worst; the mean is what gear centres
// print beside it.
struct ToothSummary {
  GearTraceKind kind = GearTraceKind::profile;
  std::size_t side = 0;
  std::size_t teeth = 0;
  GearDeviation deviation = GearDeviation::profile;
  std::array<double, 2> mean_um{};   // by kGearStandards
  std::array<double, 2> worst_um{};  // largest magnitude, with its sign
};

// A ball in every space.
struct InspectedRunOut {
  double ball_mm = 0.0;
  double radius_mm = 0.0;  // of its centre in the nominal gear
  RunOut um;
  std::array<std::optional<int>, 2> grade{};
};

// F_pk: the largest sum of k pitches in a row, k an eighth of the round. It decides no grade.
struct PitchSpan {
  std::size_t side = 0;  // of kFlankSides
  std::size_t pitches = 0;
  double um = 0.0;
};

struct InspectSettings {
  bool filter = false;   // filter_as_2013, before the grades of both editions
  double ball_mm = 0.0;  // diameter for the run-out; 0: none
};

struct InspectedGear {
  InspectSettings settings;
  std::vector<InspectedTrace> traces;         // profiles, leads, pitches; left before right
  std::vector<ToothSummary> teeth;            // of traces that several teeth have
  std::optional<InspectedRunOut> run_out;     // where settings name a ball
  std::vector<PitchSpan> spans;               // of each pitch
  std::array<bool, 2> covered{};              // does the edition cover a gear of this size?
  std::array<std::optional<int>, 2> grade{};  // worst of F_α, F_β, f_pt and F_p
  std::vector<std::string> warnings;
};

// Throws UserError naming the file, and the line where it has one: a tooth that the gear has not, a
// point that is on no flank of it, too few points, pitch of some teeth only, a ball that does not
// fit.
[[nodiscard]] InspectedGear inspect_gear(const InvoluteGear& gear, const GearPointsFile& file,
                                         const InspectSettings& settings = {});

}  // namespace volcomp::host
