// Cases of docs/papers/face-gear.md: patches through a grid, closest points, error maps, pitch.

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/error_map.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/experiments/face_gear/patch/closest_point.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s2_face_case.hpp"

namespace volcomp::cases {
namespace {

using face_gear::ClosestPoint;
using face_gear::Parametrisation;
using face_gear::PatchPoint;
using face_gear::SplinePatch;

template <class List>
json list_of(const List& values) {
  json out = json::array();
  for (const auto& value : values)
    out.push_back(value);
  return out;
}

// --- patches

Parametrisation parametrisation_of(const json& name) {
  if (name == "chord") return Parametrisation::chord;
  return name == "centripetal" ? Parametrisation::centripetal : Parametrisation::uniform;
}

SplinePatch patch_of(const json& in) {
  std::vector<Vec3> points;
  for (const json& row : in.at("grid")) {
    for (const json& point : row)
      points.push_back(vector3(point));
  }
  SplinePatch patch;
  require(SplinePatch::through(points, parametrisation_of(in.at("parametrisation")), patch));
  return patch;
}

json control_points(const SplinePatch& patch) {
  json rows = json::array();
  for (std::size_t row = 0; row < kGridRows; ++row) {
    json list = json::array();
    for (std::size_t column = 0; column < kGridColumns; ++column)
      list.push_back(to_json(patch.control(row, column)));
    rows.push_back(list);
  }
  return rows;
}

json places_on(const SplinePatch& patch, const json& uv, const Vec3& outward) {
  json out;
  for (const json& place : uv) {
    const PatchPoint p = patch.at(number(place.at(0)), number(place.at(1)));
    out["S"].push_back(to_json(p.point));
    out["Su"].push_back(to_json(p.du));
    out["Sv"].push_back(to_json(p.dv));
    out["Suu"].push_back(to_json(p.duu));
    out["Suv"].push_back(to_json(p.duv));
    out["Svv"].push_back(to_json(p.dvv));
    out["normal"].push_back(to_json(normal_of(p, outward)));
  }
  return out;
}

json closest_on(const SplinePatch& patch, const json& points, const Vec3& outward) {
  json out;
  for (const json& q : points) {
    ClosestPoint c;
    require(closest_point(patch, vector3(q), outward, c));
    out["u"].push_back(c.u);
    out["v"].push_back(c.v);
    out["foot"].push_back(to_json(c.foot));
    out["signed_distance"].push_back(c.distance);
  }
  return out;
}

json bspline(const json& in) {
  const SplinePatch patch = patch_of(in);
  const Vec3 outward = vector3(in.at("normal_ref"));
  return {{"param_u", list_of(patch.profile().parameters())},
          {"param_v", list_of(patch.width().parameters())},
          {"knots_u", list_of(patch.profile().knots())},
          {"knots_v", list_of(patch.width().knots())},
          {"control", control_points(patch)},
          {"eval", places_on(patch, in.at("uv"), outward)},
          {"closest", closest_on(patch, in.at("Q"), outward)}};
}

// --- maps

// Distance of a ball from a flank less its radius; the nearest slot where the case names none.
double deviation_of(const FaceGear& gear, const json& in, const json& centre, bool nearest) {
  const Vec3 q = vector3(centre);
  const double pitches = std::atan2(q.y(), q.x()) * gear.teeth / (2.0 * kPi);
  const int slot = nearest ? static_cast<int>(std::lround(pitches)) : 0;
  FaceFlank flank;
  require(choose_flank(gear, in.at("side").get<int>(), (slot + gear.teeth) % gear.teeth, flank));
  const FaceFoot foot = distance_from_face(gear, flank, q);
  if (!has_distance(foot.reason)) require(refuse(foot.reason));
  return foot.distance - number(in.at("r"));
}

json rows_of(const ErrorMap& map) {
  json rows = json::array();
  for (std::size_t row = 0; row < kGridRows; ++row) {
    json list = json::array();
    for (std::size_t column = 0; column < kGridColumns; ++column)
      list.push_back(map.at(row, column));
    rows.push_back(list);
  }
  return rows;
}

json error_map(const json& in) {
  const FaceGear gear = face_gear_of(in.at("gear"));
  const int side = in.at("side").get<int>();
  std::vector<double> cells;
  for (const json& row : in.at("ball_centres")) {
    for (const json& centre : row)
      cells.push_back(deviation_of(gear, in, centre, true));
  }
  ErrorMap map;
  require(ErrorMap::from(cells, map));
  json out{{"deviation_mm", rows_of(map)}};
  double centre = 0.0;
  require(zero_at_centre(map, centre));
  const CellStatistics all = statistics_of(map);
  out["zeroed_mm"] = rows_of(map);
  out["zero_rotation_rad"] = side * centre / gear.arm;
  out["max_abs_um"] = kUmPerMm * all.largest;
  out["pv_um"] = kUmPerMm * all.range();
  for (std::size_t column = 0; column < kGridColumns; ++column)
    out["profile_pv_rows2_6_um"].push_back(
        kUmPerMm * statistics_of(map, kProfileRows, {column, column}).range());
  return out;
}

// --- pitch

ToothAngles angles_of(const json& in) {
  ToothAngles angles;
  require(ToothAngles::of(in.at("N2").get<int>(), angles));
  int tooth = 0;
  if (in.contains("delta_rad")) {
    for (const json& delta : in.at("delta_rad"))
      require(angles.record(tooth++, -1, number(delta), 1.0));
    return angles;
  }
  const FaceGear gear = face_gear_of(in.at("gear"));
  const int side = in.at("side").get<int>();
  for (const json& centre : in.at("ball_centres")) {
    const double deviation = deviation_of(gear, in, centre, false);
    require(angles.record(tooth++, side, deviation, gear.arm));
  }
  return angles;
}

json face_pitch(const json& in) {
  const ToothAngles round = angles_of(in);
  const Span<const double> angles = round.angles();
  const double um = kUmPerMm * number(in.at("r1"));
  json out;
  if (!in.contains("delta_rad")) out["delta_rad"] = list_of(angles);
  std::vector<double> single(angles.size());
  require(single_pitches(angles, single, um));
  PitchDeviations d;
  require(evaluate_pitch(angles, d, um));
  out["fpt_um"] = single;
  out["fpt_max_um"] = d.single_signed;
  out["Fp_um"] = d.total;
  const std::size_t k8 = largest_pitch_span(angles.size());
  double largest = 0.0;
  for (std::size_t k = 1; k <= k8; ++k) {
    double sum = 0.0;
    require(cumulative_pitch(angles, k, sum, um));
    largest = std::max(largest, sum);
    if (k == 2 || k == 3 || k == k8) out["Fpk_um"][std::to_string(k)] = sum;
  }
  out["k8"] = k8;
  out["Fpk_max_upto_k8_um"] = largest;
  return out;
}

}  // namespace

void add_s2_maps(Handlers& handlers) {
  handlers["s2.bspline"] = bspline;
  handlers["s2.error_map"] = error_map;
  handlers["s2.pitch"] = face_pitch;
}

}  // namespace volcomp::cases
