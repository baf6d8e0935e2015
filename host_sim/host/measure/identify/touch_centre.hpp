#pragma once
// From touches of one sphere to its centre, as an ideal machine would have found it.

#include <vector>

#include "comp/core/status.hpp"
#include "comp/metrology/fits/sphere_fit.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"

namespace volcomp::host::identify {

inline constexpr std::size_t kLeastTouches = 5;

struct TouchedCentre {
  Vec3 centre = Vec3::Zero();  // work frame
  Pose q{};                    // where the ideal tip stands there
  SphereFit fit;
};

// `q`: positions of the touches, rotary axes standing still; `tip`: centre of the ball of the
// stylus, tool frame. Refused: too_few_touches (count), no_authority where three linear axes do not
// span the space, and what fit_sphere refuses.
Status touched_centre(const MachineChain& chain, const Vec3& tip, const std::vector<Pose>& q,
                      TouchedCentre& out);

// The same with the errors that are known by now: the fitted centre of a machine with errors is off
// by the radius of the sphere times how they change over it, which no χ² shows.
Status refined_centre(const MachineChain& chain, const Vec3& tip, const std::vector<Pose>& q,
                      const std::vector<ErrorSet>& errors, const Pose& q_centre,
                      const ErrorSet& errors_centre, Vec3& out);

}  // namespace volcomp::host::identify
