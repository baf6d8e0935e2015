#pragma once
// The machine as it really is: smooth error motions, reversal, squareness, thermal growth, exact
// kinematics.

#include <array>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/volumetric.hpp"

namespace volcomp::sim {

// One smooth error channel of a simulated axis, never a table:
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
    for (std::size_t k = 0; k < amplitude.size(); ++k)
      value += amplitude[k] * std::sin(static_cast<double>(k + 1) * kPi * u + phase[k]);
    return value + ripple * std::sin(2.0 * kPi * q / ripple_period + ripple_phase);
  }
};

// Truth of one axis: relative values (tool with respect to workpiece) at the reading head.
struct TrueAxis {
  double lo = 0.0;
  double hi = 1.0;
  std::array<ErrorFunction, 6> channel;
  std::array<double, 6> reversal{};  // full width between the two directions
};

// Side from which each axis arrived: −1…+1, +1 after a long move upwards.
using Approach = std::array<double, kMaxAxes>;

inline constexpr double kSteel_per_K = 11.7e-6;  // expansion

struct TrueMachine {
  MachineChain chain;
  std::array<TrueAxis, kMaxAxes> axis;
  DirectionErrors directions = zero_directions();
  double expansion_per_K = kSteel_per_K;    // of every scale
  double temperature_offset_K = 0.0;        // against the temperature of the campaign
  std::array<double, kMaxAxes> warmer_K{};  // of one axis more than that

  // Relative values of one axis as warm as in the campaign, and all axes as warm as they are in the
  // internal convention.
  [[nodiscard]] ErrorMotion relative_error(std::size_t axis, double q, double approach) const;
  [[nodiscard]] ErrorSet errors(const Pose& q, const Approach& approach) const;

  // Actual − nominal pose of a point of the tool frame for these encoder positions: exact chain,
  // rotation model rxryrz, work frame (mm, rad).
  [[nodiscard]] VolumetricError error(const Pose& q, const Approach& approach,
                                      const Vec3& tool_point) const;

 private:
  void grow(std::size_t axis, double q, ErrorMotion& body) const;
};

}  // namespace volcomp::sim
