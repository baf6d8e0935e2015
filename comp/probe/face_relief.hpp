#pragma once
// Distance from a flank with tip relief: in closed form for the trigger, exactly for frames and
// maps. No libm, interrupt-safe. See docs/papers/face-gear.md.

#include "comp/probe/face_kernel.hpp"

namespace volcomp {

// From the foot on the generated flank, mm: error ≤ 3 nm within 1.5 mm of the flank of Table 3
// (≤ 1 nm within 0.5 mm). The verdict on the foot stays the same. Without relief the distance of
// the foot.
[[nodiscard]] double relieved_distance(const FaceGear& gear, const FaceFoot& foot);

inline constexpr int kMaxReliefSteps = 10;

// The foot on the relieved flank itself, by Newton's method: `theta` and `beta` are those of the
// generated point it is set back from, `normal` that of the relieved flank. Error ≤ 1e-12 mm.
// Reasons are those of distance_from_face for the same point; no_regular_flank, too, where the
// steps do not settle. Without relief the same as distance_from_face.
[[nodiscard]] FaceFoot distance_from_relieved_face(const FaceGear& gear, const FaceFlank& flank,
                                                   const Vec3& q);

}  // namespace volcomp
