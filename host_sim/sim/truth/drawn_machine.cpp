#include "host_sim/sim/truth/drawn_machine.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/sim/truth/drawn_errors.hpp"

namespace volcomp::sim {
namespace {

// Amplitudes of rotary axes and of what does not move, by class.
constexpr double kRunOut_mm = 2e-3;
constexpr double kWobble_rad = 8e-6;
constexpr double kIndexing_rad = 15e-6;
constexpr double kLocation_mm = 15e-3;
constexpr double kLocation_rad = 30e-6;
constexpr double kSquareness_rad = 20e-6;

// What repeats with every turn is drawn over half a turn: its waves end where they have begun.
TrueAxis draw_rotary(const host::AxisFile& file, const Joint& joint, Random& random) {
  TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.full_turn() ? file.lo + kPi : file.hi;
  const std::size_t own = 3 + index(joint.axis);
  for (std::size_t c = 0; c < 6; ++c) {
    const double amplitude = c == own ? kIndexing_rad : c < 3 ? kRunOut_mm : kWobble_rad;
    // A slope that no full turn has is drawn all the same: every seed keeps its machine.
    static_cast<void>(random.uniform());
    axis.channel[c] = waves_on_line(0.0, amplitude, random);
  }
  ErrorMotion location = ErrorMotion::Zero();
  for (Eigen::Index c = 0; c < 6; ++c)
    location(c) = (c < 3 ? kLocation_mm : kLocation_rad) * random.uniform(-1.0, 1.0);
  set_location(joint, location, axis);
  draw_reversal(own, axis, random);
  return axis;
}

XyfzSquareness draw_squareness(Random& random) {
  XyfzSquareness s;
  for (double* angle : {&s.a_xy, &s.a_xz, &s.a_yz})
    *angle = kSquareness_rad * random.uniform(-1.0, 1.0);
  return s;
}

}  // namespace

TrueAxis draw_linear(const host::AxisFile& file, std::size_t own, Random& random) {
  TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.hi;
  for (std::size_t c = 0; c < 6; ++c) {
    const double amplitude = default_amplitude(c, own);
    const bool straightness = c < 3 && c != own;
    const double rise = (straightness ? 0.0 : amplitude) * random.uniform(-1.0, 1.0);
    axis.channel[c] = waves_on_line(rise, amplitude, random);
  }
  draw_ripple(axis.channel[own], random);
  for (ErrorFunction& f : axis.channel)
    f.constant = -f.at(file.reference, axis.lo, axis.hi);
  draw_reversal(own, axis, random);
  return axis;
}

// Turned into the moving frame, what stands still goes round: once per turn.
void set_location(const Joint& joint, const ErrorMotion& location, TrueAxis& axis) {
  for (const std::size_t part : {std::size_t{0}, std::size_t{3}}) {
    const std::size_t u = part + (index(joint.axis) + 1) % 3;
    const std::size_t v = part + (index(joint.axis) + 2) % 3;
    const double along_u = location(static_cast<Eigen::Index>(u));
    const double along_v = location(static_cast<Eigen::Index>(v));
    const double phase = std::atan2(along_u, along_v);
    for (const auto& [channel, ahead] : {std::pair{u, 0.0}, std::pair{v, 0.5 * kPi}}) {
      ErrorFunction& f = axis.channel.at(channel);
      f.ripple = std::hypot(along_u, along_v);
      f.ripple_period = 2.0 * kPi;
      f.ripple_phase = joint.sign > 0 ? phase + ahead : kPi - phase - ahead;
    }
  }
}

TrueMachine ideal_machine(const host::MachineFile& file) {
  TrueMachine machine;
  machine.chain = file.chain;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    machine.axis[a].lo = file.axes[a].lo;
    machine.axis[a].hi = file.axes[a].hi;
  }
  return machine;
}

TrueMachine draw_machine(const host::MachineFile& file, std::uint64_t seed) {
  Random random(seed);
  TrueMachine machine = ideal_machine(file);
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const Joint& joint = file.chain.axis(a);
    machine.axis[a] = file.axes[a].rotary ? draw_rotary(file.axes[a], joint, random)
                                          : draw_linear(file.axes[a], index(joint.axis), random);
  }
  if (!file.squareness) return machine;
  const DirectionErrors xyz = xyfz_directions(draw_squareness(random));
  for (std::size_t k = 0; k < 3; ++k)
    machine.directions[file.axis_index("XYZ"[k])] = xyz[k];
  return machine;
}

}  // namespace volcomp::sim
