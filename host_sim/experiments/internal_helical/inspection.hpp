#pragma once
// The ground gear on a measuring machine: pitch of all slots and profile of four, at mid face.

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/experiments/internal_helical/grinding.hpp"

namespace volcomp::internal_helical {

// Evenly around the gear; of 79 slots 0, 20, 39 and 59.
inline constexpr int kProfileSlots = 4;

struct HelicalPitch {
  std::vector<double> position;  // along the reference circle, towards +angle, µm
  PitchDeviations figures;       // µm
};

struct HelicalProfile {
  std::size_t slot = 0;
  std::size_t side = 0;           // of kHelicalSides
  std::vector<double> deviation;  // transverse, at FlankGrinding::roll_length(), µm
  TraceDeviations figures;        // µm; slope positive: material grows towards the tip
};

struct HelicalInspection {
  std::array<HelicalPitch, 2> pitch;
  std::vector<HelicalProfile> profile;
  double F_alpha = 0.0;  // the worst of the profiles; the paper gives one without a side
};

[[nodiscard]] HelicalInspection inspect_gear(const InternalGear& gear,
                                             const FlankGrinding& grinding,
                                             const std::vector<StrokeTrace>& passes,
                                             double probe_mm, sim::Random& random);

}  // namespace volcomp::internal_helical
