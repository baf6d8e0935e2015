#pragma once
// What a touch of a trigger probe adds to a deviation: lobing, bending of the stylus at the trigger
// force, hysteresis towards the touch before, repeatability. + reads as excess material.

#include <cmath>

#include "comp/machine/error_motion.hpp"

namespace volcomp::sim {

// Lengths in mm, forces in N, stiffness in N/mm.
struct TouchNoise {
  double repeatability_2s =
      0.0;  // unidirectional, 2σ, at a stylus of 50 mm, as data sheets state it
  double stylus = 50.0;
  double lobe3 = 0.0;        // amplitude of three lobes round the axis of the stylus
  double lobe3_angle = 0.0;  // rad, where one of them is
  double hysteresis = 0.0;   // between opposite directions
  double force_xy = 0.0;
  double force_z = 0.0;
  double stiffness_xy = 1.0;
  double stiffness_z = 1.0;

  // `normal`: outward normal of the part at the contact, unit, tool frame.
  [[nodiscard]] double lobing(const Vec3& normal) const {
    const double across = normal[0] * normal[0] + normal[1] * normal[1];
    const double direction = std::atan2(normal[1], normal[0]);
    return lobe3 * std::pow(across, 1.5) * std::cos(3.0 * (direction - lobe3_angle));
  }
  [[nodiscard]] double bending(const Vec3& normal) const {
    const double across = normal[0] * normal[0] + normal[1] * normal[1];
    return -(force_xy * across / stiffness_xy + force_z * normal[2] * normal[2] / stiffness_z);
  }
  // `before`: normal of the touch before; zero for the first.
  [[nodiscard]] double lag(const Vec3& normal, const Vec3& before) const {
    return 0.5 * hysteresis * normal.dot(before);
  }
  // Of one touch. The root fits what makers state for 50 and 100 mm (from memory).
  [[nodiscard]] double sigma() const {
    constexpr double kDataSheetStylus = 50.0;
    return 0.5 * repeatability_2s * std::sqrt(stylus / kDataSheetStylus);
  }
  // All together; `z`: a standard normal number, another for every touch.
  [[nodiscard]] double of_touch(const Vec3& normal, const Vec3& before, double z) const {
    return lobing(normal) + bending(normal) + lag(normal, before) + sigma() * z;
  }
};

}  // namespace volcomp::sim
