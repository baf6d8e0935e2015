#pragma once
// The inspection as an NC program, before and after the geometric error chain is compensated
// (docs/papers/l300g.md, "Options"; steps 3 and 6 of the paper): standard words of RS274, touches
// by G38.2.

#include <functional>
#include <string>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "host_sim/experiments/l300g/inspection_plan.hpp"

namespace volcomp::l300g {

// What to add to a commanded pose so that the machine stands where an ideal one would.
using OffsetFor = std::function<Pose(const Pose&)>;

// None: the program before compensation.
[[nodiscard]] Pose no_offset(const Pose& pose);
// Δq of the correcting axes with Δq = −J⁺ E(q + Δq). Throws UserError where they cannot act.
[[nodiscard]] Pose compensation_at(const VolumetricModel& model, const Pose& pose);

// Profile and lead as planned and the pitch of all teeth, left flanks, then right ones. mm,
// degrees, mm/min; feeds of blocks that move only B are in degrees per minute. All blocks of a
// touch have the offset of its contact. `title`: one line, for the comment at the beginning.
[[nodiscard]] std::string inspection_program(const InspectionSetup& setup, const std::string& title,
                                             const OffsetFor& offset_for);

}  // namespace volcomp::l300g
