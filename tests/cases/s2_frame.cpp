// Cases of docs/papers/face-gear.md: the frame of a face gear, from one ball and from many.

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "comp/metrology/faces/face_frame.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"
#include "tests/cases/s2_face_case.hpp"

namespace volcomp::cases {
namespace {

json frame_angle(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const FaceContact contact{face_flank_of(gear, in), number(in.at("r")), vector3(in.at("Q"))};
  double gamma = 0.0;
  require(face_angle(gear, contact, gamma));
  if (in.at("relieved").get<bool>()) {
    FaceAngle found;
    require(relieved_face_angle(gear, contact, gamma, 1e-12, found));
    return {{"gamma", found.gamma}, {"gamma_base", gamma}};
  }
  const double pitch = 2.0 * kPi / gear.teeth;
  return {{"gamma", gamma}, {"gamma_mod_2pi_over_N2", gamma - pitch * std::floor(gamma / pitch)}};
}

json machine_frame(const json& in) {
  const FacePlacement placement{vector3(in.at("L")), number(in.at("phi"))};
  const Vec3 p = vector3(in.at("p_gear"));
  const Vec3 there = to_machine(placement, p);
  if ((to_gear(placement, there) - p).norm() > 1e-12)
    throw std::runtime_error("the way back ends elsewhere");
  return {{"p_machine", to_json(there)}};
}

FrameFreedom freedom_of(const json& dof) {
  if (dof == json{5}) return FrameFreedom::turn;
  if (dof == json{0, 1, 2}) return FrameFreedom::shift;
  if (dof == json{0, 1, 5}) return FrameFreedom::plane;
  if (dof == json{0, 1, 2, 5}) return FrameFreedom::shift_turn;
  if (dof == json{0, 1, 2, 3, 4, 5}) return FrameFreedom::all;
  throw std::runtime_error("no group of motions");
}

json lsq_frame(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  std::vector<FaceTouchPoint> points;
  for (std::size_t k = 0; k < in.at("Q").size(); ++k) {
    FaceTouchPoint point;
    require(choose_flank(gear, in.at("side").at(k).get<int>(), in.at("slot").at(k).get<int>(),
                         point.flank));
    point.centre = vector3(in.at("Q").at(k));
    points.push_back(point);
  }
  FaceFrameSettings settings;
  settings.freedom = freedom_of(in.at("dof"));
  settings.ball_radius = number(in.at("r"));
  std::vector<double> residuals(points.size());
  FaceFrame fit;
  require(fit_face_frame(gear, points, settings, residuals, fit));
  return {{"R", rows_of(fit.frame.R)},
          {"t", to_json(fit.frame.t)},
          {"rms", fit.rms},
          {"residuals", residuals}};
}

}  // namespace

void add_s2_frame(Handlers& handlers) {
  handlers["s2.frame_angle"] = frame_angle;
  handlers["s2.machine_frame"] = machine_frame;
  handlers["s2.lsq_frame"] = lsq_frame;
}

}  // namespace volcomp::cases
