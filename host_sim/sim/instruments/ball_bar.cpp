#include "host_sim/sim/instruments/ball_bar.hpp"

namespace volcomp::sim {

XyfzSquareness measure_squareness(const TrueMachine& machine, const Vec3& tool_point,
                                  const SquarenessLines& place, double sigma_rad, Random& random,
                                  const std::array<std::size_t, 3>& xyz) {
  const auto error_at = [&](const Vec3& p) {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[xyz[k]] = p(static_cast<Eigen::Index>(k));
    const Frame work = machine.chain.ideal(machine.chain.work(), q);
    const VolumetricError error = machine.error(q, {}, tool_point);
    return Vec3(work.R * error.position_work);
  };
  XyfzSquareness a = apparent_squareness(error_at, place);
  a.a_xy += random.normal(sigma_rad);
  a.a_xz += random.normal(sigma_rad);
  a.a_yz += random.normal(sigma_rad);
  return a;
}

}  // namespace volcomp::sim
