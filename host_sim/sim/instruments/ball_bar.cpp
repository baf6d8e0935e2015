#include "host_sim/sim/instruments/ball_bar.hpp"

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/sim/instruments/circular_ball_bar.hpp"

namespace volcomp::sim {

XyfzSquareness measure_squareness(const TrueMachine& machine, const Vec3& tool_point,
                                  const SquarenessLines& place, double sigma_rad,
                                  const CampaignDraw& draw, const std::array<std::size_t, 3>& xyz) {
  const auto error_at = [&](const Vec3& p) {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[xyz[k]] = p(static_cast<Eigen::Index>(k));
    const Frame work = machine.chain.ideal(machine.chain.work(), q);
    const VolumetricError error = machine.error(q, {}, tool_point);
    return Vec3(work.R * error.position_work);
  };
  XyfzSquareness a = apparent_squareness(error_at, place);
  std::uint32_t number = kBallBarSetUp;
  for (double* angle : {&a.a_xy, &a.a_xz, &a.a_yz})
    *angle += sigma_rad * normal(draw.seed, {static_cast<std::uint32_t>(RandomStream::ball_bar),
                                             draw.draw, number++, 0});
  return a;
}

XyfzSquareness measure_squareness(const TrueMachine& machine, const host::SquarenessFile& place,
                                  const NoiseClasses& classes, const CampaignDraw& draw,
                                  const std::array<std::size_t, 3>& xyz) {
  if (!place.circle_radius) {
    const std::vector<double> x = place.line(0);
    const std::vector<double> y = place.line(1);
    const std::vector<double> z = place.line(2);
    return measure_squareness(machine, machine.chain.tool_point(), {place.at, x, y, z},
                              classes.ball_bar_rad, draw, xyz);
  }
  const BallBarClass bar = classes.ball_bar_rad > 0.0 ? BallBarClass{} : perfect_ball_bar();
  return squareness_by_circles(machine, {place.at, *place.circle_radius}, bar,
                               {draw.seed, draw.draw, kBallBarSetUp}, xyz);
}

}  // namespace volcomp::sim
