#include "host_sim/host/measure/identify/datum.hpp"

#include <Eigen/Geometry>

namespace volcomp::host::identify {

SquareDatum square_datum(const AxisSlopes& slopes) {
  SquareDatum out;
  out.rotation = Vec3(-slopes[1].z(), slopes[0].z(), slopes[1].x());
  for (Eigen::Index a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    out.after.at(k) = slopes.at(k) + out.rotation.cross(Vec3::Unit(a));
  }
  out.a_xy = out.after[0].y();
  out.a_xz = out.after[2].x();
  out.a_yz = -out.after[2].y();
  return out;
}

}  // namespace volcomp::host::identify
