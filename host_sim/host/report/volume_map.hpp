#pragma once
// Error vectors over the work volume, drawn as arrows.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/machine/error_motion.hpp"

namespace volcomp::host {

struct VolumeArrows {
  std::string name;         // "uncompensated"
  std::vector<Vec3> error;  // at every point, mm
};

// Points in mm. The magnification is chosen so that the longest arrow is a fifth of the volume's
// shortest edge, and rounded.
[[nodiscard]] nlohmann::json volume_map(const std::string& title, const std::vector<Vec3>& points,
                                        const std::vector<VolumeArrows>& arrows,
                                        const std::string& note);

}  // namespace volcomp::host
