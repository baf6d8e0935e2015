#pragma once
// Six-degree-of-freedom laser: reads the motion of one axis at its sensed point, with its own
// imperfections.

#include <functional>
#include <optional>

#include "comp/machine/joint.hpp"
#include "host_sim/sim/instruments/bidirectional_runs.hpp"
#include "host_sim/sim/instruments/level.hpp"
#include "host_sim/sim/instruments/noise_classes.hpp"

namespace volcomp::sim {

// Systematic imperfections of one set-up.
struct LaserSetup {
  // Of the instrument, the same in all set-ups of a campaign.
  double scale = 0.0;
  std::array<double, 2> straightness_gain{};
  std::array<double, 3> angle_gain{};
  double roll = 0.0;
  // Of this set-up.
  std::array<double, 6> wave{};  // amplitude of a slow sinusoid per channel
  std::array<double, 6> wave_phase{};
  double shorter = 0.0;           // share of a length that the angle of the beam takes, ≥ 0
  Vec3 arm_error = Vec3::Zero();  // sensed point − that of the machine file
  double warmer_K = 0.0;          // the axis, while it is measured
};

// Number `set_up` of a campaign: a function of the draw and this number. Of perfect classes: all 0.
[[nodiscard]] LaserSetup mount_laser(const NoiseClasses& classes, const CampaignDraw& draw,
                                     std::uint32_t set_up);

// Which axis a laser reads, in which travel.
struct LaserPlace {
  Axis axis = Axis::x;
  double lo = 0.0;
  double hi = 1.0;
};

// One axis measured in one set-up.
class Laser6D {
 public:
  Laser6D(const NoiseClasses& classes, const CampaignDraw& draw, std::uint32_t set_up,
          const LaserPlace& place);

  [[nodiscard]] const LaserSetup& setup() const { return setup_; }

  // Errors of the axis at its sensed point, relative values, mm and rad.
  using Truth = std::function<ErrorMotion(double q, double approach)>;
  // What the instrument shows of them, 1 nm and 1 nrad resolution.
  [[nodiscard]] host::RunsFile read_runs(char letter, const std::vector<double>& positions,
                                         std::size_t runs, const Truth& truth) const;

 private:
  [[nodiscard]] ErrorMotion shown(const ErrorMotion& truth, const Stop& stop) const;
  [[nodiscard]] double scatter(const Stop& stop, Eigen::Index channel) const;
  // Of the three lengths at each reading.
  [[nodiscard]] std::array<std::vector<double>, 3> drifts(std::size_t readings) const;

  NoiseClasses classes_;
  CampaignDraw draw_;
  std::uint32_t set_up_;
  LaserPlace place_;
  LaserSetup setup_;
  std::optional<Level> level_;
};

}  // namespace volcomp::sim
