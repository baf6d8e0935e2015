#include "host_sim/sim/artefacts/face_gear.hpp"

#include <cmath>
#include <utility>

#include "comp/core/units.hpp"
#include "comp/probe/face_relief.hpp"

namespace volcomp::sim {
namespace {

// Further than any ball can be from what it touches.
constexpr double kFar_mm = 1e3;

int nearest_slot(const FaceGear& gear, const Vec3& centre) {
  const double pitches = std::atan2(centre.y(), centre.x()) * gear.teeth / (2.0 * kPi);
  const auto slot = static_cast<int>(std::lround(pitches));
  return (slot % gear.teeth + gear.teeth) % gear.teeth;
}

}  // namespace

FaceGearOnTable::FaceGearOnTable(const FaceGear& gear, Frame mounting, FaceDeviation deviation)
    : gear_(gear), mounting_(std::move(mounting)), deviation_(std::move(deviation)) {}

// Material is what lies within the blank and outside of all slots.
Gap FaceGearOnTable::gap(const Vec3& centre, double ball_radius) const {
  const Mat3 turn = axis_rotation(Axis::z, turned_);
  const Vec3 in_gear = mounting_.apply_inverse(turn.transpose() * centre);
  const Gap blank = gap_to_blank(in_gear, ball_radius);
  const Gap slot = gap_in_slot(in_gear, ball_radius);
  const Gap& nearest = slot.mm > blank.mm ? slot : blank;
  return {nearest.mm, turn * (mounting_.R * nearest.normal)};
}

// A ring from the tips downwards.
Gap FaceGearOnTable::gap_to_blank(const Vec3& centre, double ball_radius) const {
  const double rho = std::hypot(centre.x(), centre.y());
  const Vec3 radial = rho > 0.0 ? Vec3(centre.x() / rho, centre.y() / rho, 0.0) : Vec3::UnitX();
  Gap gap{gear_.z_tip - centre.z() - ball_radius, -Vec3::UnitZ()};
  if (rho - gear_.r_out - ball_radius > gap.mm) gap = {rho - gear_.r_out - ball_radius, radial};
  if (gear_.r_in - rho - ball_radius > gap.mm) gap = {gear_.r_in - rho - ball_radius, -radial};
  return gap;
}

Gap FaceGearOnTable::gap_in_slot(const Vec3& centre, double ball_radius) const {
  const int slot = nearest_slot(gear_, centre);
  Gap solid{-kFar_mm, -Vec3::UnitZ()};
  Gap nearest{kFar_mm, -Vec3::UnitZ()};
  for (const int side : {1, -1}) {
    FaceFlank flank;
    if (!choose_flank(gear_, side, slot, flank).ok()) return solid;
    const FaceFoot foot = distance_from_relieved_face(gear_, flank, centre);
    if (!has_distance(foot.reason)) return solid;
    double mm = foot.distance - ball_radius;
    if (deviation_) mm -= deviation_(side, slot, to_flank(flank, foot.point));
    if (mm < nearest.mm) nearest = {mm, foot.normal};
  }
  return nearest;
}

}  // namespace volcomp::sim
