#include "host_sim/sim/truth/drawn_errors.hpp"

#include "comp/core/units.hpp"

namespace volcomp::sim {
namespace {

constexpr double kOwnAxis_mm = 3e-3;
constexpr double kStraightness_mm = 2.5e-3;
constexpr double kRoll_rad = 12e-6;
constexpr double kPitchYaw_rad = 20e-6;
constexpr double kRipple_mm = 0.15e-3;

}  // namespace

double default_amplitude(std::size_t channel, std::size_t own) {
  if (channel == own) return kOwnAxis_mm;
  if (channel < 3) return kStraightness_mm;
  return channel == own + 3 ? kRoll_rad : kPitchYaw_rad;
}

ErrorFunction waves_on_line(double rise, double amplitude, Random& random) {
  ErrorFunction f;
  f.linear = rise;
  f.amplitude = {amplitude, 0.5 * amplitude, 0.25 * amplitude};
  for (double& phase : f.phase)
    phase = random.uniform(0.0, 2.0 * kPi);
  return f;
}

void draw_ripple(ErrorFunction& positioning, Random& random) {
  positioning.ripple = kRipple_mm;
  positioning.ripple_phase = random.uniform(0.0, 2.0 * kPi);
}

void draw_reversal(std::size_t own, TrueAxis& axis, Random& random) {
  axis.reversal[own] = own < 3 ? random.uniform(0.5e-3, 1.0e-3) : random.uniform(2e-6, 4e-6);
  for (std::size_t c = 3; c < 6; ++c) {
    if (c != own) axis.reversal[c] = random.uniform(-1.5e-6, 1.5e-6);
  }
}

}  // namespace volcomp::sim
