#pragma once
// Touches of an artefact as CSV: where the centre of the ball stood, corrected by the node, and in
// which direction of the tool frame the part pushed it. Columns in any order:
//
//   X [mm],Y [mm],Z [mm],NX,NY,NZ
//   12.5013,0.0002,31.0000,1,0,0
//
// NX NY NZ: normal out of the part, tool frame, of any length; or AX AY AZ: the direction of
// approach, which is the opposite. Without either the axes of the coordinates are those of the
// tool. Lines that begin with # and empty lines are skipped.

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "comp/machine/error_motion.hpp"

namespace volcomp::host {

struct ProbeTouch {
  Vec3 centre = Vec3::Zero();  // mm
  Vec3 normal = Vec3::Zero();  // unit, tool frame; 0 where the file has none
  std::size_t line = 0;
};

struct TouchFile {
  std::string name;
  std::vector<ProbeTouch> touches;
  bool has_normals = false;
};

inline constexpr std::size_t kMostTouches = 10'000;

// Throws UserError with file and line: a column that is missing, unknown or there twice, a unit of
// another kind, a value that is no finite number, a direction without length, no touch or more than
// kMostTouches.
[[nodiscard]] TouchFile read_touches(std::istream& stream, const std::string& name);
[[nodiscard]] TouchFile read_touch_file(const std::filesystem::path& path);

}  // namespace volcomp::host
