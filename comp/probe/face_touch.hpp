#pragma once
// What became of a touch that was meant for a flank of a face gear. Fixed work, no libm,
// interrupt-safe. See docs/papers/face-gear.md, "What we do".

#include "comp/probe/face_kernel.hpp"

namespace volcomp {

struct FaceProbing {
  double ball_radius = 0.0;  // mm, > 0
  double gate = 0.0;         // mm, > 0: a flank is touched when |distance − ball_radius| ≤ gate
};

struct FaceTouch {
  // The first that applies of:
  // bad_point        there is no distance (reason in `foot.reason`), or radius or gate are unusable
  // two_flanks       both flanks of the slot are touched
  // ok               the commanded flank is touched where it is one
  // opposite_flank   the other one is touched
  // ball_in_metal    nearer than radius − gate to either, or behind it
  // bad_point        the commanded one is touched where it is none (`foot.reason`)
  // nothing_touched  neither
  Reason verdict = Reason::bad_point;
  double distance = std::numeric_limits<double>::quiet_NaN();   // from the commanded flank, mm
  double other = std::numeric_limits<double>::quiet_NaN();      // from the opposite one, mm
  double deviation = std::numeric_limits<double>::quiet_NaN();  // distance − radius: > 0 is excess
  FaceFoot foot;  // on the commanded flank as generated
};

// `q`: centre of the ball, gear frame. Distances include the relief of the gear, in closed form.
[[nodiscard]] FaceTouch judge_touch(const FaceGear& gear, const FaceFlank& flank,
                                    const FaceProbing& probing, const Vec3& q);

}  // namespace volcomp
