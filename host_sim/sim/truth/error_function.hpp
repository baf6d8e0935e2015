#pragma once
// One smooth error channel of a simulated axis, never a table: a slope, three harmonics of the
// stroke and a short ripple.

#include <array>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp::sim {

// constant + linear·u + Σ a_k sin(kπu + φ_k) + ripple, u = place in the travel, 0…1.
struct ErrorFunction {
  double constant = 0.0;
  double linear = 0.0;
  std::array<double, 3> amplitude{};
  std::array<double, 3> phase{};
  double ripple = 0.0;         // amplitude
  double ripple_period = 7.3;  // mm or rad
  double ripple_phase = 0.0;

  [[nodiscard]] double at(double q, double lo, double hi) const {
    const double u = (q - lo) / (hi - lo);
    double value = constant + linear * u;
    for (std::size_t k = 0; k < amplitude.size(); ++k) {
      value += amplitude[k] * std::sin(static_cast<double>(k + 1) * kPi * u + phase[k]);
    }
    return value + ripple * std::sin(2.0 * kPi * q / ripple_period + ripple_phase);
  }
};

}  // namespace volcomp::sim
