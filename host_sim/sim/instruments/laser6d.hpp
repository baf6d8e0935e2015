#pragma once
// Six-degree-of-freedom laser: reads the motion of one axis at its sensed point, with its own
// imperfections.

#include "comp/metrology/tables/abbe.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Systematic imperfections of one set-up, drawn once when the instrument is mounted; 0 for a
// perfect one.
struct LaserSetup {
  double scale = 0.0;
  std::array<double, 2> straightness_gain{};
  std::array<double, 3> angle_gain{};
  std::array<double, 6> wave{};  // amplitude of a slow sinusoid per channel
  std::array<double, 6> wave_phase{};
  double roll = 0.0;
  Vec3 arm_error = Vec3::Zero();  // sensed point − that of the machine file
};

[[nodiscard]] LaserSetup mount_laser(const NoiseClasses& classes, Random& random);

// Where an axis stands, in which travel.
struct LaserPlace {
  Axis axis = Axis::x;
  double q = 0.0;
  double lo = 0.0;
  double hi = 1.0;
};

// What such an instrument shows where the errors at the sensed point are these.
[[nodiscard]] ErrorMotion laser_reading(const ErrorMotion& truth, const LaserPlace& place,
                                        const LaserSetup& setup, const NoiseClasses& classes,
                                        Random& random);

class Laser6D {
 public:
  // `sensed`: reading head → sensed point as declared. The instrument stands so that the sensed
  // point is there when all axes are at machine zero.
  Laser6D(const TrueMachine& machine, std::size_t axis, const SensedPoint& sensed,
          const LaserSetup& setup);

  // Reading at q: relative values at the sensed point, mm and rad, 1 nm and 1 nrad resolution. The
  // other axes stand at zero. `repeatability` of the machine and the instrument together, 1 σ.
  [[nodiscard]] ErrorMotion read(double q, double approach, const NoiseClasses& classes,
                                 Random& random) const;

 private:
  [[nodiscard]] ErrorMotion true_reading(double q, double approach) const;

  const TrueMachine& machine_;
  std::size_t axis_;
  LaserSetup setup_;
  Vec3 point_in_tool_;  // where it senses
  bool rides_on_tool_;
};

}  // namespace volcomp::sim
