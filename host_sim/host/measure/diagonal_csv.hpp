#pragma once
// Body and face diagonals measured along their length, as CSV. The header names every column, in
// any order:
//
//   diagonal,target [mm],run,direction,deviation [um]
//   PPP,0,1,up,0.0
//
// Diagonals are called PPP, NPP, PNP, PPN (ISO 230-6: the sign of X, Y and Z on the way up) or XY+,
// XY-, XZ+ … for those of a face. target: distance from the beginning, the same point for both
// directions; up: away from it. deviation: actual − nominal. Lines starting with # are skipped.

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

namespace volcomp::host {

struct DiagonalRun {
  long number = 0;
  bool up = true;
  std::size_t line = 0;              // of its first reading
  std::vector<double> deviation_mm;  // by target
};

struct DiagonalTarget {
  double distance_mm = 0.0;
  std::size_t line = 0;  // where it is first named
};

struct DiagonalRuns {
  std::string name;
  std::vector<DiagonalTarget> targets;  // by distance, at least 2
  std::vector<DiagonalRun> runs;

  [[nodiscard]] double length_mm() const {
    return targets.back().distance_mm - targets.front().distance_mm;
  }
};

struct DiagonalsFile {
  std::string name;
  std::vector<DiagonalRuns> diagonals;  // in the order of the file
};

// Throws UserError with file and line: malformed number, value that is not finite, unknown or
// missing unit, column or diagonal, duplicate reading, run that lacks a target, more than 16
// diagonals, 512 targets or 1000 runs, a file that is no text.
[[nodiscard]] DiagonalsFile read_diagonals(std::istream& stream, const std::string& name);
[[nodiscard]] DiagonalsFile read_diagonals_file(const std::filesystem::path& path);

[[nodiscard]] std::string diagonals_csv(const DiagonalsFile& file);

// "PPP" … of the three linear axes, not "XY+".
[[nodiscard]] bool is_body_diagonal(const std::string& name);

// Two targets are the same place within this.
inline constexpr double kSameTarget_mm = 1e-3;

// Throws UserError naming file and line of what only one of them has: diagonal, target, run.
void require_same_points(const DiagonalsFile& before, const DiagonalsFile& after);

}  // namespace volcomp::host
