#pragma once
// Where the L300G stands when its ball touches a flank (docs/papers/l300g.md).

#include "comp/metrology/gears/involute_gear.hpp"
#include "comp/metrology/gears/l300g.hpp"

namespace volcomp {

enum class PathStyle : unsigned char {
  fixed_a,   // the gear stands still, its tooth on +Y; Y steps, B touches
  generate,  // the ball stays on the base tangent, the gear turns to it
};

struct FlankTouch {
  Flank flank;
  double roll_length = 0.0;  // mm
  double x = 0.0;            // along the axis of the gear, mm
};

// NC coordinates by axis X, Y, B, A. Spur gears. Refused: out_of_reach.
Status touch_pose(const SwingArm& arm, const L300gDatum& datum, const InvoluteGear& gear,
                  PathStyle style, const FlankTouch& touch, double ball_radius, Pose& out);

}  // namespace volcomp
