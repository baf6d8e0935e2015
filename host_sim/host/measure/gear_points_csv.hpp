#pragma once
// A measured gear as CSV: touched points in the frame of the gear (axis X, tooth 1 on +Y at x = 0:
// comp/metrology/gears/involute_gear.hpp), or deviations as gear centres give them. Columns in any
// order:
//
//   trace,flank,tooth,X [mm],Y [mm],Z [mm]         trace,flank,tooth,at [mm],deviation [um]
//   profile,left,1,15.0,60.1234,3.2101             profile,left,1,9.51,0.34
//
// trace is profile, lead or pitch; flank left or right, left facing +φ seen along −X; teeth count
// from 1 towards +φ. `at` is the roll length of a profile, x of a lead, and may be empty for a
// pitch, whose deviation is the position of the tooth on the reference circle. Lines that begin
// with # and empty lines are skipped.

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "comp/metrology/gears/involute_gear.hpp"

namespace volcomp::host {

enum class GearTraceKind : std::uint8_t { profile, lead, pitch };
[[nodiscard]] const char* name_of(GearTraceKind kind);

struct GearPoint {
  GearTraceKind trace = GearTraceKind::profile;
  FlankSide side = FlankSide::left;
  int tooth = 0;              // from 0
  Vec3 place = Vec3::Zero();  // mm; where the file has coordinates
  double at = 0.0;            // mm; where it has deviations
  double deviation_mm = 0.0;
  std::size_t line = 0;
};

struct GearPointsFile {
  std::string name;
  bool has_coordinates = true;  // else deviations
  std::vector<GearPoint> points;
};

inline constexpr std::size_t kMostGearPoints = 200'000;

// Throws UserError with file and line: a column that is missing, unknown or there twice, a unit of
// another kind, a word that is none of the known ones, a value that is no finite number, no point
// or more than kMostGearPoints.
[[nodiscard]] GearPointsFile read_gear_points(std::istream& stream, const std::string& name);
[[nodiscard]] GearPointsFile read_gear_points_file(const std::filesystem::path& path);

}  // namespace volcomp::host
