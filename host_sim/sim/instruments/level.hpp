#pragma once
// Electronic level: reads how far a slide tilts about a horizontal axis, so the roll of X and Y.
// What turns about the vertical it does not see.

#include "host_sim/sim/instruments/noise_classes.hpp"

namespace volcomp::sim {

// Standard deviations, rad; from memory.
struct LevelClass {
  double reading = 0.5e-6;  // averaged over 3 s
  double zero = 5.0e-6;     // of a set-up
  double gain = 0.5e-2;     // of the instrument
  double settling_s = 2.0;  // time constant after a move
};

// Number `set_up` of a campaign.
class Level {
 public:
  Level(const LevelClass& level, const CampaignDraw& draw, std::uint32_t set_up, double dwell_s);

  // Tilts in rad: now, and at the reading before, of which something is left after the dwell.
  [[nodiscard]] double read(double tilt, double before, std::uint32_t reading) const;

 private:
  LevelClass level_;
  CampaignDraw draw_;
  std::uint32_t set_up_;
  double gain_;
  double zero_;
  double left_;  // share of a step that is still to come
};

}  // namespace volcomp::sim
