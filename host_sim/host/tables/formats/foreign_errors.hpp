#pragma once
// Error functions from files of other programs, one curve per channel, and the run files made of
// them. Only units and layout change here; the machine file defines what the values mean (relative
// or body, at which point), as for a user's own runs.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

struct ForeignPoint {
  double at = 0.0;  // mm or rad
  double value = 0.0;
};
using ForeignCurve = std::vector<ForeignPoint>;

struct LocationError {
  std::string name;  // as in the file, for instance C0Y
  double value = 0.0;
  bool angle = false;  // rad, otherwise mm
};

// The content of one or several files of the same machine. mm and rad.
struct ForeignErrors {
  std::map<char, std::array<ForeignCurve, 6>> axis;  // by letter; EX EY EZ EA EB EC
  std::vector<LocationError> location;
};

// What a run file holds, mm or rad. Targets that are nearer than this are one.
inline constexpr double kNearestTargets = 1e-5;
inline constexpr double kLargestInRuns = 1e9;
// NaN does not.
[[nodiscard]] bool fits_run_file(double value);

// What the format leaves open and the caller must state.
struct ImportRules {
  int sign = 1;              // −1: the file holds nominal − actual
  bool absent_zero = false;  // channels that are not in the file are 0
};

// A name by the scheme of ISO 230-1: channel 0…5 of an axis, or the location of an axis.
struct ErrorName {
  std::size_t channel = 0;
  char axis = '\0';
  bool location = false;
};

// "EXY" or "C0Y" ("EC0Y"), letters XYZABC; false for anything else.
[[nodiscard]] bool read_error_name(std::string_view text, ErrorName& out);

// Adds one point; both readers take lengths in mm, angles in rad and rotary positions in degrees.
// Fails with the line for a point that is not finite, too large, twice there, or one too many.
void add_point(ForeignErrors& errors, const ErrorName& name, double at, double value,
               const CsvLines& lines);

// Fails when the location has been given before.
void add_location(ForeignErrors& errors, std::string_view name, double value,
                  const CsvLines& lines);

// One run upwards per axis. Throws UserError with `name`: nothing there, a channel missing, fewer
// than two positions, channels of one axis at different positions.
[[nodiscard]] std::vector<RunsFile> to_runs(const ForeignErrors& errors, const std::string& name,
                                            const ImportRules& rules);

// "name,value,unit" with a line per location error; empty if there is none.
[[nodiscard]] std::string locations_csv(const ForeignErrors& errors, const ImportRules& rules);

}  // namespace volcomp::host
