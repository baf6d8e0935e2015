#pragma once
// Error vectors at places of the volume, as CSV and as figures:
//
//   X [mm],Y [mm],Z [mm],DX [um],DY [um],DZ [um]
//
// D: actual − nominal position of the tool relative to the work.

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "comp/machine/frame.hpp"

namespace volcomp::host {

struct VolumePoint {
  Vec3 at_mm = Vec3::Zero();
  Vec3 error_mm = Vec3::Zero();
  std::size_t line = 0;
};

struct VolumeFile {
  std::string name;
  std::vector<VolumePoint> points;
};

// Throws UserError with file and line, as read_diagonals; a place that occurs twice, fewer than 4
// places or more than 100 000.
[[nodiscard]] VolumeFile read_volume(std::istream& stream, const std::string& name);
[[nodiscard]] VolumeFile read_volume_file(const std::filesystem::path& path);

[[nodiscard]] std::string volume_csv(const VolumeFile& file);

// Throws UserError naming file and line of a place that only one of them has.
void require_same_places(const VolumeFile& before, const VolumeFile& after);

// Lengths of error vectors, µm.
struct VolumeFigures {
  double max_um = 0.0;
  double rms_um = 0.0;
};

[[nodiscard]] VolumeFigures volume_figures(const std::vector<VolumePoint>& points);
// After the workpiece frame has been aligned by a best-fit rigid motion, which every workpiece
// set-up does. Places in a line or fewer than three are taken as they are.
[[nodiscard]] std::vector<VolumePoint> aligned(std::vector<VolumePoint> points);
[[nodiscard]] VolumeFigures aligned_volume_figures(std::vector<VolumePoint> points);
// Errors at these places, aligned.
[[nodiscard]] std::vector<Vec3> aligned_errors(const std::vector<Vec3>& at_mm,
                                               const std::vector<Vec3>& error_mm);
// In the order of their places: two files of the same places in the same order.
[[nodiscard]] std::vector<VolumePoint> aligned_by_place(const VolumeFile& file);

}  // namespace volcomp::host
