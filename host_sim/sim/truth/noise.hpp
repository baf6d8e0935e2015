#pragma once
// Standard deviations of all imperfections of a campaign, those of realistic instruments
// (docs/papers/xyfz.md, "What stays open"), and random numbers that are the same on every computer.

#include <cmath>
#include <cstdint>
#include <random>

#include "comp/core/units.hpp"

namespace volcomp::sim {

struct NoiseClasses {
  double repeatability_mm = 0.7e-3;  // per reading
  double repeatability_rad = 0.7e-6;
  double scale = 0.25e-6;  // laser wavelength
  double straightness_gain = 0.5e-2;
  double straightness_wave_mm = 0.3e-3;
  double angle_gain = 0.2e-2;
  double angle_wave_rad = 0.3e-6;
  double roll_rad = 2.0e-6;  // over the travel
  double arm_mm = 2.0;       // every component of a lever
  double ball_bar_rad = 3.0e-6;
  double temperature_K = 0.1;  // between campaign and check
  double interferometer = 0.25e-6;
};

[[nodiscard]] inline NoiseClasses no_noise() {
  return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
}

// mt19937_64 is specified to the bit; the distributions of the standard library are not, so they
// are written out.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // 0 ≤ x < 1
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }

  // Box–Muller.
  double normal(double sigma) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return sigma * radius * std::cos(2.0 * kPi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace volcomp::sim
