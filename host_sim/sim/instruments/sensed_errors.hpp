#pragma once
// What a laser between table and spindle has before it when one axis moves and the others stand.

#include "host_sim/sim/instruments/laser6d.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// The errors that an instrument shows whose sensed point is there, with the lever `arm_error` off,
// when all axes are at machine zero; the other axes stand at zero.
class SensedErrors {
 public:
  SensedErrors(TrueMachine machine, std::size_t axis, const SensedPoint& sensed,
               const LaserSetup& setup);

  [[nodiscard]] ErrorMotion at(double q, double approach) const;

 private:
  TrueMachine machine_;
  std::size_t axis_;
  Vec3 point_in_tool_;  // where it senses
  bool rides_on_tool_;
};

}  // namespace volcomp::sim
