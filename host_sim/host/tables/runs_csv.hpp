#pragma once
// Measured runs as CSV, one file per axis. The header names every column with its unit, in any
// order:
//
//   target [mm],run,direction,EXX [um],EYX [um],EZX [um],EAX [urad],EBX [urad],ECX [urad]
//   -500,1,up,3.12,-0.45,…
//
// The last letter of the channels is the axis. Lines starting with # and empty lines are skipped.

#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "comp/machine/error_motion.hpp"
#include "comp/metrology/tables/table_builder.hpp"

namespace volcomp::host {

using RunValues = std::vector<ErrorMotion>;  // by target, mm and rad
using RunLines = std::vector<std::size_t>;   // of the readings of a run, by target

struct RunsFile {
  std::string name;
  char letter = '\0';
  std::vector<double> positions;  // mm or rad, in the order of the file
  std::vector<RunValues> up;      // towards increasing coordinate
  std::vector<RunValues> down;
  std::vector<RunLines> up_lines;  // empty where the runs are not from a file
  std::vector<RunLines> down_lines;

  // "runs_X.csv:17" of a reading; the name alone where its line is not known.
  [[nodiscard]] std::string place_of(bool upwards, std::size_t run, std::size_t target) const;
};

// Views for the table builder; the file must outlive them.
struct RunViews {
  explicit RunViews(const RunsFile& file);
  std::vector<Run> up;
  std::vector<Run> down;
};

// Throws UserError with file and line: malformed number, unknown or missing unit, unit of the wrong
// kind, unknown column, duplicate reading, more than 512 targets or 1000 runs, a file that is no
// text.
[[nodiscard]] RunsFile read_runs(std::istream& stream, const std::string& name);
[[nodiscard]] RunsFile read_runs_file(const std::filesystem::path& path);

[[nodiscard]] std::string runs_csv(const RunsFile& runs);
void write_runs(std::ostream& stream, const RunsFile& runs);
// Whole or not at all.
void write_runs_file(const std::filesystem::path& path, const RunsFile& runs);

}  // namespace volcomp::host
