#include "host_sim/instruments/ball_bar.hpp"

namespace volcomp::sim {

XyfzSquareness measure_squareness(const TrueMachine& machine, const Vec3& tool_point,
                                  const SquarenessLines& place, double sigma_rad, Random& random) {
  const auto error_at = [&](const Vec3& p) {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[k] = p(static_cast<Eigen::Index>(k));
    return machine.error(q, {}, tool_point).position_work;
  };
  XyfzSquareness a = apparent_squareness(error_at, place);
  a.a_xy += random.normal(sigma_rad);
  a.a_xz += random.normal(sigma_rad);
  a.a_yz += random.normal(sigma_rad);
  return a;
}

}  // namespace volcomp::sim
