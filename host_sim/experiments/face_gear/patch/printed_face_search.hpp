#pragma once
// The search of the paper for the angle of a face gear (docs/papers/face-gear.md, eq. 27 and 28),
// to show what it costs: the gear is turned by step (d/range)² towards contact, at most by `step`.

#include <algorithm>
#include <cmath>

#include "comp/machine/frame.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "comp/probe/face_relief.hpp"

namespace volcomp::face_gear {

struct PrintedFaceSearch {
  double step = 0.0;             // θ_0, rad
  double range = 0.0;            // l_max, mm
  bool radius_taken_off = true;  // d = distance − radius; false: d = distance, as printed
  double tolerance = 1e-4;       // of the distance from contact, mm
  int most_evaluations = 60000;
};

// As relieved_face_angle; residuals_too_large (count of evaluations, deviation) where the search
// does not end in time. `out` then holds where it stands.
inline Status printed_face_angle(const FaceGear& gear, const FaceContact& contact, double start,
                                 const PrintedFaceSearch& search, FaceAngle& out) {
  if (!contact.centre.allFinite()) return refuse(Reason::not_finite);
  out = {};
  out.gamma = start;
  while (out.evaluations < search.most_evaluations) {
    const Vec3 q = turned(axis_rotation(Axis::z, out.gamma), contact.centre);
    const FaceFoot foot = distance_from_relieved_face(gear, contact.flank, q);
    if (!has_distance(foot.reason)) return refuse(foot.reason);
    out.rest = foot.distance - contact.ball_radius;
    ++out.evaluations;
    if (std::abs(out.rest) <= search.tolerance) return {};
    const double d = search.radius_taken_off ? out.rest : foot.distance;
    const double part = std::min(std::abs(d) / search.range, 1.0);
    out.gamma += contact.flank.side * std::copysign(search.step * part * part, out.rest);
  }
  Where where;
  where.count = out.evaluations;
  where.deviation = out.rest;
  where.has_deviation = true;
  return refuse(Reason::residuals_too_large, where);
}

}  // namespace volcomp::face_gear
