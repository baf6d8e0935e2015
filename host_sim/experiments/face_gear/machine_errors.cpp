#include "host_sim/experiments/face_gear/machine_errors.hpp"

#include <algorithm>
#include <array>

#include "host_sim/sim/truth/drawn_errors.hpp"

namespace volcomp::face_gear {
namespace {

constexpr std::size_t kX = 0;
constexpr std::size_t kY = 1;
constexpr std::size_t kZ = 2;
constexpr std::size_t kC = 5;  // channel of turning about Z
constexpr double kRippleShare = 0.3;

// A table repeats itself every turn: one wave and three. They add up to `half_range` at most.
sim::ErrorFunction once_per_turn(double half_range, sim::Random& random) {
  const double amplitude = half_range / (1.0 + kRippleShare);
  sim::ErrorFunction f;
  f.amplitude[1] = amplitude;  // sin 2πu
  f.phase[1] = random.uniform(0.0, 2.0 * kPi);
  f.ripple = kRippleShare * amplitude;
  f.ripple_period = 2.0 * kPi / 3.0;
  f.ripple_phase = random.uniform(0.0, 2.0 * kPi);
  return f;
}

sim::ErrorFunction along_slide(double amplitude, sim::Random& random) {
  const double rise = amplitude * random.uniform(-1.0, 1.0);
  return sim::waves_on_line(rise, amplitude, random);
}

sim::ErrorFunction straightness(double lo, double hi, sim::Random& random) {
  sim::ErrorFunction f = sim::waves_on_line(0.0, 1.0, random);
  const double scale = kStraightness_mm / straightness_over(f, lo, hi, kStraightnessLength_mm);
  for (double& amplitude : f.amplitude)
    amplitude *= scale;
  f.linear = f.at(lo, lo, hi) - f.at(hi, lo, hi);  // no slope between the ends
  return f;
}

sim::TrueAxis slide(const host::AxisFile& file, std::size_t own, sim::Random& random) {
  sim::TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.hi;
  for (std::size_t c = 0; c < axis.channel.size(); ++c) {
    if (c == own) {
      axis.channel[c] = along_slide(kPositioning_mm, random);
    } else {
      axis.channel[c] =
          c < 3 ? straightness(file.lo, file.hi, random) : along_slide(kSlideAngle_rad, random);
    }
  }
  return axis;
}

sim::TrueAxis table(const host::AxisFile& file, sim::Random& random) {
  sim::TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.hi;
  const double tilt = 0.5 * kRunOut_mm / kTableRim_mm;
  for (std::size_t c = 0; c < axis.channel.size(); ++c) {
    const double turning = c == kC ? kTablePosition_rad : tilt;
    axis.channel[c] = once_per_turn(c < 3 ? 0.5 * kRunOut_mm : turning, random);
  }
  return axis;
}

// The slope of a straightness is a direction of the axis.
void lean(sim::TrueAxis& axis, std::size_t towards, double slope) {
  axis.channel.at(towards).linear += slope * (axis.hi - axis.lo);
}

// An axis that is square to the table within the limit, and to Z as well, which leans towards it by
// `z_slope`.
double square_to_both(double z_slope, sim::Random& random) {
  const double least = -kSquareness_rad - std::min(0.0, z_slope);
  const double most = kSquareness_rad - std::max(0.0, z_slope);
  return random.uniform(least, most);
}

}  // namespace

double straightness_over(const sim::ErrorFunction& f, double lo, double hi, double length) {
  constexpr int kSteps = 40;  // of a piece
  const double piece = std::min(length, hi - lo);
  const double step = piece / kSteps;
  double worst = 0.0;
  const auto begins = static_cast<int>(std::floor((hi - lo - piece) / step + 0.5)) + 1;
  for (int b = 0; b < begins; ++b) {
    const double begin = lo + b * step;
    const double first = f.at(begin, lo, hi);
    const double rise = f.at(begin + piece, lo, hi) - first;
    double least = 0.0;
    double most = 0.0;
    for (int i = 1; i < kSteps; ++i) {
      const double off = f.at(begin + i * step, lo, hi) - first - rise * i / kSteps;
      least = std::min(least, off);
      most = std::max(most, off);
    }
    worst = std::max(worst, most - least);
  }
  return worst;
}

sim::TrueMachine make_yk7280_truth(const host::MachineFile& file, std::uint64_t seed) {
  file.expect_axes("XYZC");
  sim::Random random(seed);
  sim::TrueMachine machine;
  machine.chain = file.chain;
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    machine.axis[a] =
        file.axes[a].rotary ? table(file.axes[a], random) : slide(file.axes[a], a, random);
  lean(machine.axis[kX], kY, random.uniform(-kSquareness_rad, kSquareness_rad));
  const std::array<double, 2> z_slope{random.uniform(-kParallelism_rad, kParallelism_rad),
                                      random.uniform(-kParallelism_rad, kParallelism_rad)};
  for (const std::size_t a : {kX, kY}) {
    lean(machine.axis[kZ], a, z_slope.at(a));
    lean(machine.axis.at(a), kZ, square_to_both(z_slope.at(a), random));
  }
  return machine;
}

}  // namespace volcomp::face_gear
