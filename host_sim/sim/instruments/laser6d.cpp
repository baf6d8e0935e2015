#include "host_sim/sim/instruments/laser6d.hpp"

namespace volcomp::sim {
namespace {

constexpr double kResolution = 1e-6;  // 1 nm; angles: 1 nrad

double rounded(double value, double step) { return std::round(value / step) * step; }

}  // namespace

LaserSetup mount_laser(const NoiseClasses& classes, Random& random) {
  LaserSetup s;
  s.scale = random.normal(classes.scale);
  for (double& g : s.straightness_gain)
    g = random.normal(classes.straightness_gain);
  for (double& g : s.angle_gain)
    g = random.normal(classes.angle_gain);
  for (std::size_t c = 0; c < 6; ++c) {
    s.wave[c] =
        c < 3 ? random.normal(classes.straightness_wave_mm) : random.normal(classes.angle_wave_rad);
    s.wave_phase[c] = random.uniform(0.0, 2.0 * kPi);
  }
  s.roll = random.normal(classes.roll_rad);
  for (double& a : s.arm_error)
    a = random.normal(classes.arm_mm);
  return s;
}

Laser6D::Laser6D(const TrueMachine& machine, std::size_t axis, const SensedPoint& sensed,
                 const LaserSetup& setup)
    : machine_(machine), axis_(axis), setup_(setup) {
  // Frame origin of the axis at machine zero, then along the real lever to the sensed point.
  const Pose zero{};
  const std::uint8_t wanted = machine.chain.body_of_axis(axis);
  Frame frame;
  const bool tool_side = machine.chain.joint(wanted).branch == Branch::tool;
  for (const std::uint8_t body : tool_side ? machine.chain.tool() : machine.chain.work()) {
    frame = frame * joint_offset(machine.chain.joint(body));
    if (body == wanted) break;
  }
  const Vec3 in_base = frame.apply(sensed.at_zero + setup.arm_error);
  point_in_tool_ = machine.chain.ideal(machine.chain.tool(), zero).apply_inverse(in_base);
  // A tool-carrying axis whose sensed point is fixed on the table (κ = −1) sees a lever that
  // shortens with q.
  rides_on_tool_ = !tool_side || sensed.kappa == 0;
}

ErrorMotion Laser6D::true_reading(double q, double approach) const {
  Pose pose{};
  pose[axis_] = q;
  Approach from{};
  from[axis_] = approach;
  Vec3 point = point_in_tool_;
  if (!rides_on_tool_) point -= q * unit_vector(machine_.chain.axis(axis_).axis);
  const VolumetricError e = machine_.error(pose, from, point);
  // The laser sees one axis move; squareness of its direction belongs to the alignment of the beam.
  const Vec3 straight = e.position_work - machine_.directions[axis_] * q;
  ErrorMotion reading;
  reading << straight, e.orientation_work;
  return reading;
}

ErrorMotion Laser6D::read(double q, double approach, const NoiseClasses& classes,
                          Random& random) const {
  const TrueAxis& truth = machine_.axis.at(axis_);
  const LaserPlace place{machine_.chain.axis(axis_).axis, q, truth.lo, truth.hi};
  return laser_reading(true_reading(q, approach), place, setup_, classes, random);
}

ErrorMotion laser_reading(const ErrorMotion& truth, const LaserPlace& place,
                          const LaserSetup& setup, const NoiseClasses& classes, Random& random) {
  const double u = (place.q - place.lo) / (place.hi - place.lo);
  const auto along = static_cast<Eigen::Index>(place.axis);
  ErrorMotion r = truth;
  std::size_t straightness = 0;
  for (Eigen::Index c = 0; c < 6; ++c) {
    const auto i = static_cast<std::size_t>(c);
    if (c == along) r(c) += place.q * setup.scale;
    if (c < 3 && c != along) r(c) *= 1.0 + setup.straightness_gain.at(straightness++);
    if (c >= 3) r(c) *= 1.0 + setup.angle_gain.at(i - 3);
    const double wave = setup.wave.at(i) * std::sin(2.0 * kPi * u + setup.wave_phase.at(i));
    if (c != along) r(c) += wave;
    if (c == along + 3) r(c) += setup.roll * u;
    r(c) += random.normal(c < 3 ? classes.repeatability_mm : classes.repeatability_rad);
    r(c) = rounded(r(c), c < 3 ? kResolution : kResolution * 1e-3);
  }
  return r;
}

}  // namespace volcomp::sim
