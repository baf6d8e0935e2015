#include "tests/oracle/stylus.hpp"

#include <cmath>

namespace volcomp::test {

Status contact_point(const Vec3& centre, const Vec3& normal, double ball_radius, Vec3& out) {
  if (!centre.allFinite() || !normal.allFinite() || !std::isfinite(ball_radius))
    return refuse(Reason::not_finite);
  const double length = normal.stableNorm();
  if (!(length > 0.0)) return refuse(Reason::zero_normal);
  out = centre - normal * (ball_radius / length);
  return {};
}

}  // namespace volcomp::test
