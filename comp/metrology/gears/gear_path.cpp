#include "comp/metrology/gears/gear_path.hpp"

#include "comp/core/units.hpp"

namespace volcomp {

Status touch_pose(const SwingArm& arm, const L300gDatum& datum, const InvoluteGear& gear,
                  PathStyle style, const FlankTouch& touch, double ball_radius, Pose& out) {
  const Flank on_y{touch.flank.side, 0};
  const double sigma = touch.flank.side == FlankSide::left ? 1.0 : -1.0;
  double A = -2.0 * kPi * touch.flank.tooth / gear.teeth;
  Transverse centre = ball_centre_at(gear, on_y, touch.roll_length, ball_radius);
  if (style == PathStyle::generate) {
    centre = {gear.r_b, sigma * (touch.roll_length + ball_radius)};
    A += sigma * (touch.roll_length / gear.r_b - gear.eta_b);
  }
  double B = 0.0;
  if (const Status s = arm_angle(arm, centre.z, B); !s.ok()) return s;
  out = {};
  out[0] = datum.x + touch.x - arm_foreshortening(arm, B);
  out[1] = datum.y + centre.y;
  out[2] = B;
  out[3] = A;
  return {};
}

}  // namespace volcomp
