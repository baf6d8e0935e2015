#pragma once
// Squareness out of the slopes of straightness: turned so that the Y axis is the datum.

#include <array>

#include "comp/machine/error_motion.hpp"

namespace volcomp::host::identify {

// Slopes of the linear axes X, Y, Z: each what it goes aside in x, y, z a mm, relative values.
using AxisSlopes = std::array<Vec3, 3>;

struct SquareDatum {
  Vec3 rotation = Vec3::Zero();  // of the work frame, rad
  AxisSlopes after{};            // of Y 0 in x and z, of X 0 in z
  double a_xy = 0.0;
  double a_xz = 0.0;
  double a_yz = 0.0;
};
[[nodiscard]] SquareDatum square_datum(const AxisSlopes& slopes);

}  // namespace volcomp::host::identify
