#pragma once
// The machine as it really is: smooth error motions, reversal, squareness, thermal growth, exact
// kinematics.

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "host_sim/sim/truth/error_function.hpp"

namespace volcomp::sim {

// Truth of one axis: relative values (tool with respect to workpiece) at the reading head.
struct TrueAxis {
  double lo = 0.0;
  double hi = 1.0;
  std::array<ErrorFunction, 6> channel;
  std::array<double, 6> reversal{};  // full width between the two directions
};

// Side from which each axis arrived: −1…+1, +1 after a long move upwards.
using Approach = std::array<double, kMaxAxes>;

struct TrueMachine {
  MachineChain chain;
  std::array<TrueAxis, kMaxAxes> axis;
  DirectionErrors directions = zero_directions();
  double expansion_per_K = 11.7e-6;         // of every scale
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
