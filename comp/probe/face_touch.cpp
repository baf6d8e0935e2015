#include "comp/probe/face_touch.hpp"

#include "comp/probe/face_relief.hpp"

namespace volcomp {
namespace {

Reason verdict_on(const FaceTouch& touch, const FaceProbing& probing) {
  const double r = probing.ball_radius;
  const double nearest = r - probing.gate;
  const double farthest = r + probing.gate;
  const bool near_here = touch.distance < nearest;
  const bool near_there = touch.other < nearest;
  const bool here = !near_here && touch.distance <= farthest;
  const bool there = !near_there && touch.other <= farthest;
  if (here && there) return Reason::two_flanks;
  if (here && touch.foot.reason == Reason::ok) return Reason::ok;
  if (there) return Reason::opposite_flank;
  if (near_here || near_there) return Reason::ball_in_metal;
  return here ? Reason::bad_point : Reason::nothing_touched;
}

}  // namespace

FaceTouch judge_touch(const FaceGear& gear, const FaceFlank& flank, const FaceProbing& probing,
                      const Vec3& q) {
  FaceTouch touch;
  const FaceFeet feet = distances_in_slot(gear, flank, q);
  touch.foot = feet.here;
  if (!has_distance(touch.foot.reason)) return touch;
  touch.distance = relieved_distance(gear, touch.foot);
  touch.other = relieved_distance(gear, feet.opposite);
  touch.deviation = touch.distance - probing.ball_radius;
  if (!(probing.ball_radius > 0.0) || !(probing.gate > 0.0)) return touch;
  touch.verdict = verdict_on(touch, probing);
  return touch;
}

}  // namespace volcomp
