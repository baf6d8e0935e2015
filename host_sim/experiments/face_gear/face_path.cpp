#include "host_sim/experiments/face_gear/face_path.hpp"

#include <cmath>

#include "comp/metrology/tables/volumetric.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kAboveTips_mm = 8.0;

Vec3 in_slot(const FaceGear& gear, const FlankName& flank, const Vec3& v) {
  const double angle = 2.0 * kPi * flank.slot / gear.teeth;
  const Vec3 mirrored(v.x(), flank.side * v.y(), v.z());
  return axis_rotation(Axis::z, angle) * mirrored;
}

}  // namespace

double FacePath::table_at(int slot) const {
  const Vec3 centre =
      mounting_.R * axis_rotation(Axis::z, 2.0 * kPi * slot / gear_.teeth) * Vec3::UnitX();
  const double wanted = -std::atan2(centre.y(), centre.x());
  const double whole = 2.0 * kPi;
  return kScaleStep_rad *
         std::round((wanted - whole * std::floor(wanted / whole)) / kScaleStep_rad);
}

// The slides are parallel to the axes of base.
Pose FacePath::pose_at(const Vec3& in_gear, double table) const {
  Pose at_zero{};
  at_zero[3] = table;
  const Vec3 from = ideal_points(chain_, at_zero, chain_.tool_point()).work;
  const Vec3 way = axis_rotation(Axis::z, table) * (mounting_.apply(in_gear) - from);
  return {way.x(), way.y(), way.z(), table};
}

Pose FacePath::ball_at(const FlankName& flank, const SurfacePoint& at, double off,
                       double table) const {
  return pose_at(in_slot(gear_, flank, at.point + off * at.normal), table);
}

Pose FacePath::above_tips(Pose at) const {
  const Vec3 above(gear_.r_pitch, 0.0, gear_.z_tip - kAboveTips_mm);
  at[2] = pose_at(above, at[3])[2];
  return at;
}

}  // namespace volcomp::face_gear
