#include "host_sim/sim/instruments/circular_ball_bar.hpp"

#include <cmath>

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {
namespace {

// What is the same in all readings of one placement.
struct BarSetup {
  Vec3 socket = Vec3::Zero();  // against the nominal centre, mm; along first, second, normal
  double start_angle = 0.0;
  double length = 0.0;
  std::array<double, 2> sensor{};  // cosine and sine of its second harmonic
};

BarSetup set_up(const CirclePlan& plan, const BallBarClass& bar, const BallBarDraw& draw) {
  const auto at = [&](std::uint32_t number) {
    return RandomIndex{static_cast<std::uint32_t>(RandomStream::set_up), draw.draw, draw.setup,
                       kCommon - number};
  };
  const auto z = [&](std::uint32_t number) { return normals(draw.seed, at(number)); };
  const auto centre = z(0);
  const auto angles = z(1);
  const auto length = z(2);
  BarSetup s;
  s.socket = {bar.centre * centre[0], bar.centre * centre[1], bar.tilt * plan.radius * angles[1]};
  s.start_angle = bar.start_angle * angles[0];
  s.length = bar.length * length[0];
  const Uniforms sensor = uniforms(draw.seed, at(3));
  s.sensor = {bar.sensor * (2.0 * sensor.u - 1.0), bar.sensor * (2.0 * sensor.v - 1.0)};
  return s;
}

class Circles {
 public:
  Circles(const TrueMachine& machine, const CirclePlan& plan, const BallBarClass& bar,
          const BallBarDraw& draw, const std::array<std::size_t, 3>& xyz)
      : machine_(machine),
        plan_(plan),
        bar_(bar),
        draw_(draw),
        xyz_(xyz),
        setup_(set_up(plan, bar, draw)) {
    for (std::size_t direction = 0; direction < path_.size(); ++direction)
      for (std::size_t i = 0; i < plan.readings; ++i)
        path_.at(direction).push_back(radial(angle(direction, i), sense(direction)));
  }

  [[nodiscard]] host::BallBarCircle go_round(std::size_t direction, std::size_t run) {
    host::BallBarCircle circle;
    circle.run = static_cast<long>(run) + 1;
    for (std::size_t i = 0; i < plan_.readings; ++i) {
      circle.theta.push_back(angle(direction, i));
      circle.radial.push_back(path_.at(direction)[i] + noise());
    }
    return circle;
  }

 private:
  static double sense(std::size_t direction) { return direction == 0 ? 1.0 : -1.0; }
  // Clockwise from the same angle, so that both directions are read at the same ones.
  [[nodiscard]] double angle(std::size_t direction, std::size_t i) const {
    return sense(direction) * 2.0 * kPi * static_cast<double>(i) /
           static_cast<double>(plan_.readings);
  }
  [[nodiscard]] double noise() {
    return bar_.reading * normal(draw_.seed, {static_cast<std::uint32_t>(RandomStream::ball_bar),
                                              draw_.draw, draw_.setup, reading_++});
  }

  // Without the noise of a reading: the same in every run.
  [[nodiscard]] double radial(double theta, double sense) const {
    const auto a = static_cast<Eigen::Index>(plan_.first);
    const auto b = static_cast<Eigen::Index>(plan_.second);
    const double at = theta + setup_.start_angle;
    Vec3 p = plan_.centre;
    p(a) += plan_.radius * std::cos(at);
    p(b) += plan_.radius * std::sin(at);
    Approach approach{};
    approach[xyz_[static_cast<std::size_t>(a)]] = -sense * std::sin(at) >= 0.0 ? 1.0 : -1.0;
    approach[xyz_[static_cast<std::size_t>(b)]] = sense * std::cos(at) >= 0.0 ? 1.0 : -1.0;
    Vec3 socket = plan_.centre;
    socket(a) += setup_.socket(0);
    socket(b) += setup_.socket(1);
    socket(3 - a - b) += setup_.socket(2);
    const double length = (p + error(p, approach) - socket).norm() + setup_.length;
    return length - plan_.radius + setup_.sensor[0] * std::cos(2.0 * theta) +
           setup_.sensor[1] * std::sin(2.0 * theta);
  }

  [[nodiscard]] Vec3 error(const Vec3& p, const Approach& approach) const {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[xyz_[k]] = p(static_cast<Eigen::Index>(k));
    const Vec3 in_work = machine_.error(q, approach, machine_.chain.tool_point()).position_work;
    return machine_.chain.ideal(machine_.chain.work(), q).R * in_work;
  }

  const TrueMachine& machine_;
  const CirclePlan& plan_;
  const BallBarClass& bar_;
  BallBarDraw draw_;
  std::array<std::size_t, 3> xyz_;
  BarSetup setup_;
  std::array<std::vector<double>, 2> path_;  // radial, by direction
  std::uint32_t reading_ = 0;
};

}  // namespace

host::BallBarTest measure_circles(const TrueMachine& machine, const CirclePlan& plan,
                                  const BallBarClass& bar, const BallBarDraw& draw,
                                  const std::array<std::size_t, 3>& xyz) {
  host::BallBarTest test;
  test.name = "simulated ball bar";
  test.plane = std::string{"XYZ"[static_cast<std::size_t>(plan.first)],
                           "XYZ"[static_cast<std::size_t>(plan.second)]};
  test.radius = plan.radius;
  test.feed = plan.feed;
  test.centre = plan.centre;
  test.calibrated = true;
  Circles circles(machine, plan, bar, draw, xyz);
  for (std::size_t run = 0; run < plan.circles; ++run)
    for (std::size_t direction = 0; direction < test.circle.size(); ++direction)
      test.circle.at(direction).push_back(circles.go_round(direction, run));
  return test;
}

XyfzSquareness squareness_by_circles(const TrueMachine& machine, const SquarenessCircles& place,
                                     const BallBarClass& bar, const BallBarDraw& draw,
                                     const std::array<std::size_t, 3>& xyz) {
  constexpr std::array<std::array<Axis, 2>, 3> kPlanes{
      {{Axis::x, Axis::y}, {Axis::z, Axis::x}, {Axis::y, Axis::z}}};
  std::array<double, 3> found{};
  for (std::size_t i = 0; i < kPlanes.size(); ++i) {
    CirclePlan plan;
    plan.first = kPlanes[i][0];
    plan.second = kPlanes[i][1];
    plan.centre = place.centre;
    plan.radius = place.radius;
    const BallBarDraw one{draw.seed, draw.draw, draw.setup + static_cast<std::uint32_t>(i)};
    const host::BallBarTest test = measure_circles(machine, plan, bar, one, xyz);
    found.at(i) = host::decompose_ball_bar(test).value.squareness;
  }
  return {-found[0], found[1], found[2]};  // of EC0Y, EB0Z, EA0Z
}

}  // namespace volcomp::sim
