#include "comp/metrology/faces/face_angle.hpp"

#include <cmath>

#include "comp/machine/frame.hpp"
#include "comp/probe/face_relief.hpp"

namespace volcomp {
namespace {

Vec3 turned_about_axis(double angle, const Vec3& v) {
  return turned(axis_rotation(Axis::z, angle), v);
}

// diag(1, −1, −1), its own inverse.
Vec3 flipped(const Vec3& v) { return {v[0], -v[1], -v[2]}; }

Status check(const FaceContact& contact) {
  Where where;
  where.field = "ball_radius";
  if (!contact.centre.allFinite()) return refuse(Reason::not_finite);
  if (!(contact.ball_radius > 0.0)) return refuse(Reason::bad_point, where);
  return {};
}

Status not_reached(const FaceAngle& at) {
  Where where;
  where.count = at.evaluations;
  where.deviation = at.rest;
  where.has_deviation = true;
  return refuse(Reason::residuals_too_large, where);
}

// Distance less radius with the gear turned by at.gamma.
Status evaluate(const FaceGear& gear, const FaceContact& contact, FaceAngle& at) {
  const FaceFoot foot =
      distance_from_relieved_face(gear, contact.flank, turned_about_axis(at.gamma, contact.centre));
  if (!has_distance(foot.reason)) return refuse(foot.reason);
  at.rest = foot.distance - contact.ball_radius;
  ++at.evaluations;
  return {};
}

}  // namespace

Vec3 direction_to_machine(const FacePlacement& placement, const Vec3& direction) {
  return flipped(turned_about_axis(placement.angle, direction));
}

Vec3 to_machine(const FacePlacement& placement, const Vec3& p) {
  return placement.origin + direction_to_machine(placement, p);
}

Vec3 to_gear(const FacePlacement& placement, const Vec3& p) {
  return turned_about_axis(-placement.angle, flipped(p - placement.origin));
}

Status face_angle(const FaceGear& gear, const FaceContact& contact, double& gamma) {
  if (const Status s = check(contact); !s.ok()) return s;
  const Vec3& q = contact.centre;
  const FaceFlank& flank = contact.flank;
  const double half_slot = half_slot_angle(gear, std::hypot(q.x(), q.y()), q.z());
  const double angle = std::atan2(flank.sine, flank.cosine) - std::atan2(q.y(), q.x()) +
                       flank.side * (half_slot - contact.ball_radius / gear.arm);
  const double turn = std::isfinite(angle) ? angle : 0.0;
  const FaceFoot foot = distance_from_face(gear, flank, turned_about_axis(turn, q));
  if (foot.reason != Reason::ok) return refuse(foot.reason);
  gamma = angle;
  return {};
}

Status relieved_face_angle(const FaceGear& gear, const FaceContact& contact, double start,
                           double tolerance, FaceAngle& out) {
  if (const Status s = check(contact); !s.ok()) return s;
  Where where;
  where.field = "tolerance";
  if (!(tolerance >= 1e-12)) return refuse(Reason::bad_setting, where);
  FaceAngle at;
  at.gamma = start;
  while (at.evaluations < kMaxAngleSteps) {
    if (const Status s = evaluate(gear, contact, at); !s.ok()) return s;
    if (std::abs(at.rest) <= tolerance) {
      out = at;
      return {};
    }
    at.gamma += contact.flank.side * at.rest / gear.arm;
  }
  return not_reached(at);
}

}  // namespace volcomp
