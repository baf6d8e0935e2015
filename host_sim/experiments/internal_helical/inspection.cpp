#include "host_sim/experiments/internal_helical/inspection.hpp"

#include <algorithm>

#include "comp/metrology/gears/internal_gear_deviations.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {

HelicalInspection inspect_gear(const InternalGear& gear, const FlankGrinding& grinding,
                               const std::vector<StrokeTrace>& passes, double probe_mm,
                               sim::Random& random) {
  HelicalInspection result;
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
    HelicalPitch& pitch = result.pitch[side];
    for (const StrokeTrace& pass : passes) {
      const double dn = grinding.pitch_point(pass, side) + random.normal(probe_mm);
      pitch.position.push_back(kUmPerMm * pitch_arc_towards_plus(gear, kHelicalSides[side], dn));
    }
    host::require(evaluate_pitch(pitch.position, pitch.figures), "pitch");
  }
  for (int k = 0; k < kProfileSlots; ++k) {
    const auto slot = static_cast<std::size_t>((k * gear.teeth + 1) / kProfileSlots);
    for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
      HelicalProfile profile{slot, side, {}, {}};
      for (std::size_t i = 0; i < kProfilePoints; ++i) {
        const double dn =
            grinding.profile_point(passes.at(slot), side, i) + random.normal(probe_mm);
        profile.deviation.push_back(kUmPerMm * transverse_of(gear, dn));
      }
      host::require(
          evaluate_internal_profile(grinding.roll_length(), profile.deviation, profile.figures),
          "profile");
      result.F_alpha = std::max(result.F_alpha, profile.figures.total);
      result.profile.push_back(profile);
    }
  }
  return result;
}

}  // namespace volcomp::internal_helical
