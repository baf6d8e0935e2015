#include "comp/probe/face_relief.hpp"

#include "comp/machine/fine_trig.hpp"
#include "comp/probe/face_flank.hpp"

namespace volcomp {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// What is left from the relieved flank to the point, along e1, e2, n.
Vec3 rest_of(const ReliefTangents& at, const FaceTriad& triad, const Vec3& point) {
  return added(triad.from_gear(point), -1.0, at.point);
}

// One step towards where what is left is square to both tangents; 0 where it is not defined.
FaceParameters step_towards(const ReliefTangents& at, const Vec3& rest) {
  const double theta = dot(rest, at.theta);
  const double beta = dot(rest, at.beta);
  const double a = dot(at.theta, at.theta) - dot(rest, at.theta_theta);
  const double b = dot(at.theta, at.beta) - dot(rest, at.theta_beta);
  const double d = dot(at.beta, at.beta) - dot(rest, at.beta_beta);
  const double determinant = a * d - b * b;
  if (!(determinant > 0.0)) return {};
  return {(d * theta - b * beta) / determinant, (a * beta - b * theta) / determinant};
}

bool small(double v) { return v < 1e-9 && v > -1e-9; }

}  // namespace

double relieved_distance(const FaceGear& gear, const FaceFoot& foot) {
  const ReliefAt cut = relief_at(gear.relief, foot.point[2]);
  const double square = 1.0 - foot.normal[2] * foot.normal[2];  // cos² β
  // Above the place the relief is taken at. The distance to the generated flank would be 60 nm less
  // exact here.
  const double height = foot.distance + cut.depth;
  const double tilt = cut.slope * cut.slope * square;
  return height - 0.5 * height * tilt / (1.0 + height * cut.change * square);
}

FaceFoot distance_from_relieved_face(const FaceGear& gear, const FaceFlank& flank, const Vec3& q) {
  FaceFoot foot = distance_from_face(gear, flank, q);
  if (!has_distance(foot.reason) || !(gear.relief.amount > 0.0)) return foot;
  const Vec3 point = to_flank(flank, q);
  FaceParameters at{foot.theta, foot.beta};
  for (foot.steps = 1; foot.steps <= kMaxReliefSteps; ++foot.steps) {
    const FaceTriad triad(gear, at);
    const ReliefTangents tangents = relief_tangents(gear, triad, at);
    const FaceParameters step = step_towards(tangents, rest_of(tangents, triad, point));
    at.theta += step.theta;
    at.beta += step.beta;
    if (!small(step.theta) || !small(step.beta)) continue;
    const FacePoint on = relieved_face_point(gear, flank, at);
    foot.distance = dot(added(q, -1.0, on.point), on.normal);
    foot.theta = at.theta;
    foot.beta = at.beta;
    foot.point = on.point;
    foot.normal = on.normal;
    return foot;
  }
  foot.reason = Reason::no_regular_flank;
  foot.distance = std::numeric_limits<double>::quiet_NaN();
  return foot;
}

}  // namespace volcomp
