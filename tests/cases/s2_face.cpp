// Cases of docs/papers/face-gear.md: flanks of face gears, distances from them and the verdicts on
// touches.

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/probe/face_flank.hpp"
#include "comp/probe/face_touch.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s2_face_case.hpp"

namespace volcomp::cases {
namespace {

json surface(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const FaceFlank flank = face_flank_of(gear, in);
  const FaceParameters at{number(in.at("theta")), number(in.at("beta"))};
  const bool relieved = in.at("relieved").get<bool>();
  const FacePoint p = relieved ? relieved_face_point(gear, flank, at) : face_point(gear, flank, at);
  json out{{"point", to_json(p.point)}, {"normal", to_json(p.normal)}};
  if (relieved) return out;
  const double rho = std::hypot(p.point.x(), p.point.y());
  out["rho"] = rho;
  out["z"] = p.point.z();
  out["zeta_plus_flank"] = half_slot_angle(gear, rho, p.point.z());
  out["theta_undercut"] = undercut_roll(gear, at.beta);
  return out;
}

json limits(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  return {{"base_moment_arm_C", gear.arm},
          {"undercut_radius", gear.undercut_radius},
          {"undercut_beta", gear.undercut_beta},
          {"pointing_radius", gear.pointing_radius}};
}

json closest_point(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const FaceFoot foot = face_foot_of(gear, face_flank_of(gear, in), in);
  return {{"lam", foot.distance},
          {"theta", foot.theta},
          {"beta", foot.beta},
          {"foot", to_json(foot.point)},
          {"normal", to_json(foot.normal)},
          {"status", face_name(foot.reason)}};
}

// The slot nearest to a point: allowed in this diagnostic only.
int nearest_slot(const FaceGear& gear, const Vec3& q) {
  if (!q.allFinite()) return 0;
  const double slots = std::atan2(q.y(), q.x()) * gear.teeth / (2.0 * kPi);
  const int slot = static_cast<int>(std::lround(slots));
  return (slot + gear.teeth) % gear.teeth;
}

json status(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const Vec3 q = vector3(in.at("Q"));
  FaceFlank flank;
  require(choose_flank(gear, in.at("side").get<int>(), nearest_slot(gear, q), flank));
  const FaceFoot foot = distance_from_face(gear, flank, q);
  return {{"status", face_name(foot.reason)}, {"lam", foot.distance}};
}

json touch(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const FaceTouch t = judge_touch(gear, face_flank_of(gear, in),
                                  {number(in.at("r")), number(in.at("gate"))}, vector3(in.at("Q")));
  return {{"verdict", t.verdict == Reason::ok ? "TOUCH_OK" : face_name(t.verdict)},
          {"lam_side", t.distance},
          {"lam_other", t.other}};
}

}  // namespace

void add_s2_face(Handlers& handlers) {
  handlers["s2.surface"] = surface;
  handlers["s2.limits"] = limits;
  handlers["s2.closest_point"] = closest_point;
  handlers["s2.status"] = status;
  handlers["s2.touch"] = touch;
}

}  // namespace volcomp::cases
