#pragma once
// The inspection as an NC program for a controller without a node (docs/papers/face-gear.md,
// "Options"): standard words of RS274, touches by G38.2.

#include <functional>
#include <string>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "host_sim/experiments/face_gear/inspection_plan.hpp"

namespace volcomp::face_gear {

struct FaceProgramSetup {
  const FaceGear& gear;
  const FaceGrid& grid;
  FacePath path;
  double ball_radius = 0.0;  // mm
  int touches = 1;           // of each point
  int flanks = 1;            // pairs that are mapped
};

// What to add to a commanded pose so that the machine stands where an ideal one would.
using FaceOffsetFor = std::function<Pose(const Pose&)>;

// None.
[[nodiscard]] Pose no_face_offset(const Pose& pose);
// Δq of the correcting axes with Δq = −J⁺ E(q + Δq). Throws UserError where they cannot act.
[[nodiscard]] Pose face_offset_at(const VolumetricModel& model, const Pose& pose);

// The touches of the frame, the maps, the pitch of all teeth. mm, degrees, mm/min; the table turns
// only while the ball is above the tips. All blocks of a touch have the offset of its contact.
// `title`: one line, for the comment at the beginning.
[[nodiscard]] std::string face_program(const FaceProgramSetup& setup, const std::string& title,
                                       const FaceOffsetFor& offset_for);

}  // namespace volcomp::face_gear
