#include "host_sim/experiments/face_gear/inspection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "comp/probe/face_relief.hpp"
#include "comp/probe/face_touch.hpp"
#include "firmware/node/probe/flank_probe.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::face_gear {
FaceInspector::FaceInspector(FaceStation& station, const FaceGear& gear, const FaceGrid& grid,
                             double ball_radius, const FaceRules& rules)
    : station_(station), gear_(gear), grid_(grid), radius_(ball_radius), rules_(rules) {}

FaceFlank FaceInspector::flank_of(const FlankName& name) const {
  FaceFlank flank;
  host::require(choose_flank(gear_, name.side, name.slot, flank), "flank");
  return flank;
}

void FaceInspector::agree(const FaceTouch& here, const sim::FlankJudgement& node) {
  ++agreement_.touches;
  if (here.verdict != node.verdict || here.foot.reason != node.foot) ++agreement_.verdicts;
  const std::int64_t apart = std::int64_t{node.distance_nm} - node::distance_nm(here.distance);
  agreement_.largest_nm = std::max(agreement_.largest_nm, std::abs(apart));
}

FaceStationTouch FaceInspector::touch(const PlannedTouch& planned) {
  const auto& [name, row, column] = planned;
  const FaceGridNode& node = grid_[row][column];
  const FaceFlank flank = flank_of(name);
  FaceStationTouch mean;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (int k = 0; k < rules_.touches; ++k) {
    const FaceStationTouch one =
        station_.touch(name, {node.point, node.normal}, row, column,
                       k == 0 ? TouchFrom::beside : TouchFrom::where_it_was);
    const FaceTouch here = judge_touch(gear_, flank, {one.radius, kGate_mm}, one.ball);
    agree(here, one.judgement);
    if (k == 0 || one.judgement.verdict != Reason::ok) mean.judgement = one.judgement;
    mean.ball += one.centre_of(radius_) / rules_.touches;
    if (here.foot.reason != Reason::ok) continue;  // no distance
    least = std::min(least, here.distance);
    most = std::max(most, here.distance);
  }
  if (rules_.sigma_mm > 0.0 && most - least > kOutlierSigmas * rules_.sigma_mm)
    outliers_.push_back({name, row, column, kUmPerMm * (most - least)});
  return mean;
}

void FaceInspector::use(const KnownFrame& frame) {
  frame_ = frame;
  station_.believe(frame.mounting);
}

void FaceInspector::check_fresh() const {
  if (frame_.deployment != station_.deployments())
    throw host::UserError("the swing arm was deployed since the frame was found: find it anew");
}

KnownFrame FaceInspector::frame_from_one_ball() {
  const FlankName name{1, 0};
  const Vec3 ball = touch({name, kCentreRow, kCentreColumn}).ball;
  station_.retract();
  const FaceContact contact{flank_of(name), radius_, ball};
  FaceAngle found;
  constexpr double kTolerance_mm = 1e-9;
  host::require(relieved_face_angle(gear_, contact, 0.0, kTolerance_mm, found), "frame angle");
  // p_gear = Rz(γ) p_believed.
  KnownFrame frame;
  frame.mounting = station_.believed();
  frame.mounting.R = frame.mounting.R * axis_rotation(Axis::z, -found.gamma);
  frame.deployment = station_.deployments();
  frame.touches = 1;
  return frame;
}

KnownFrame FaceInspector::frame_from_many() {
  std::vector<FaceTouchPoint> points;
  for (const PlannedTouch& planned : frame_touches(gear_.teeth))
    points.push_back({flank_of(planned.flank), touch(planned).ball});
  station_.retract();
  FaceFrameSettings settings;
  settings.freedom = FrameFreedom::all;
  settings.ball_radius = radius_;
  FaceFrame fit;
  host::require(fit_face_frame(gear_, {points.data(), points.size()}, settings, {}, fit), "frame");
  KnownFrame frame;
  // p_work = mounting p_believed, p_gear = fit p_believed.
  const Frame back{fit.frame.R.transpose(), -(fit.frame.R.transpose() * fit.frame.t)};
  frame.mounting = station_.believed() * back;
  frame.deployment = station_.deployments();
  frame.fit = fit;
  frame.touches = static_cast<int>(points.size());
  return frame;
}

FlankMap FaceInspector::map(const FlankName& name) {
  check_fresh();
  FlankMap result;
  result.flank = name;
  const FaceFlank flank = flank_of(name);
  for (const PlannedTouch& planned : map_touches(name)) {
    const auto [r, c] = std::pair(planned.row, planned.column);
    const FaceStationTouch found = touch(planned);
    if (found.judgement.verdict != Reason::ok) {
      result.missing.push_back(
          fmt::format("row {}, column {}: {}", r + 1, c + 1, sentence(found.judgement.verdict)));
      continue;
    }
    const FaceFoot foot = distance_from_relieved_face(gear_, flank, found.ball);
    result.map.set(r, c, kUmPerMm * (foot.distance - radius_));
  }
  station_.retract();
  double removed = 0.0;
  host::require(zero_at_centre(result.map, removed), "error map");
  ProfileDeviation profile;
  if (profile_deviation(result.map, kProfileRows, profile).ok()) result.profile = profile.value;
  return result;
}

FacePitch FaceInspector::pitch(int side) {
  check_fresh();
  ToothAngles round;
  host::require(ToothAngles::of(gear_.teeth, round), "pitch");
  for (const PlannedTouch& planned : pitch_touches(side, gear_.teeth)) {
    const Vec3 ball = touch(planned).ball;
    const FaceFoot foot = distance_from_relieved_face(gear_, flank_of(planned.flank), ball);
    const int slot = planned.flank.slot;
    host::require(refuse(foot.reason), fmt::format("pitch, slot {}", slot));
    host::require(round.record(slot, side, foot.distance - radius_, gear_.arm), "pitch");
  }
  station_.retract();
  FacePitch pitch;
  const double um = kUmPerMm * gear_.r_pitch;
  for (const double angle : round.angles())
    pitch.position.push_back(um * angle);
  host::require(evaluate_pitch(pitch.position, pitch.figures), "pitch");
  host::require(cumulative_pitch(pitch.position, kPitchSpan, pitch.over_10), "pitch");
  return pitch;
}

}  // namespace volcomp::face_gear
