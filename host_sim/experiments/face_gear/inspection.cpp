#include "host_sim/experiments/face_gear/inspection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "comp/probe/face_relief.hpp"
#include "comp/probe/face_touch.hpp"
#include "firmware/node/probe/flank_probe.hpp"
#include "host_sim/experiments/face_gear/truth.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::face_gear {
namespace {

constexpr int kFrameSlots = 3;

struct GridCell {
  std::size_t row;
  std::size_t column;
};
// Cells of a flank for the frame: its centre, and four far out.
constexpr std::array<GridCell, 5> kFrameCells{
    {{kCentreRow, kCentreColumn}, {1, 1}, {1, 13}, {5, 13}, {5, 1}}};

}  // namespace

FaceInspector::FaceInspector(FaceStation& station, const FaceGear& gear, const FaceGrid& grid,
                             double ball_radius)
    : station_(station), gear_(gear), grid_(grid), radius_(ball_radius) {}

FaceFlank FaceInspector::flank_of(const FlankName& name) const {
  FaceFlank flank;
  host::require(choose_flank(gear_, name.side, name.slot, flank), "flank");
  return flank;
}

FaceStationTouch FaceInspector::touch(const FlankName& name, std::size_t row, std::size_t column) {
  const FaceGridNode& node = grid_[row][column];
  FaceStationTouch found = station_.touch(name, {node.point, node.normal}, row, column);
  const FaceTouch here = judge_touch(gear_, flank_of(name), {radius_, kGate_mm}, found.ball);
  ++agreement_.touches;
  if (here.verdict != found.judgement.verdict || here.foot.reason != found.judgement.foot)
    ++agreement_.verdicts;
  const std::int64_t apart =
      std::int64_t{found.judgement.distance_nm} - node::distance_nm(here.distance);
  agreement_.largest_nm = std::max(agreement_.largest_nm, std::abs(apart));
  return found;
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
  const Vec3 ball = touch(name, kCentreRow, kCentreColumn).ball;
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
  for (int k = 0; k < kFrameSlots; ++k) {
    for (const int side : kFaceSides) {
      const FlankName name{side, k * gear_.teeth / kFrameSlots};
      for (const GridCell& cell : kFrameCells)
        points.push_back({flank_of(name), touch(name, cell.row, cell.column).ball});
    }
  }
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
  for (std::size_t c = 0; c < kGridColumns; ++c) {
    for (std::size_t i = 0; i < kGridRows; ++i) {
      const std::size_t r = c % 2 == 0 ? i : kGridRows - 1 - i;  // there and back
      const FaceStationTouch found = touch(name, r, c);
      if (found.judgement.verdict != Reason::ok) {
        result.missing.push_back(
            fmt::format("row {}, column {}: {}", r + 1, c + 1, sentence(found.judgement.verdict)));
        continue;
      }
      const FaceFoot foot = distance_from_relieved_face(gear_, flank, found.ball);
      result.map.set(r, c, kUmPerMm * (foot.distance - radius_));
    }
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
  for (int k = 0; k < gear_.teeth; ++k) {
    const FlankName name{side, k};
    const Vec3 ball = touch(name, kCentreRow, kCentreColumn).ball;
    const FaceFoot foot = distance_from_relieved_face(gear_, flank_of(name), ball);
    host::require(refuse(foot.reason), fmt::format("pitch, slot {}", k));
    host::require(round.record(k, side, foot.distance - radius_, gear_.arm), "pitch");
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
