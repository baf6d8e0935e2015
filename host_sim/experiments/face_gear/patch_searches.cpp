#include "host_sim/experiments/face_gear/patch_searches.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/machine/frame.hpp"
#include "comp/metrology/faces/face_angle.hpp"
#include "comp/probe/face_relief.hpp"
#include "host_sim/experiments/face_gear/patch/printed_face_search.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kAccuracy = 1e-7;  // of u and v, for the subdivision
constexpr double kBallRadius_mm = 0.5;
constexpr double kDegree = kPi / 180.0;

// On the surface, where a map is measured, in the material, at the centre of the ball, further off.
constexpr std::array<double, 4> kOffsets_mm{0.0, -0.5, kBallRadius_mm, 1.5};

// A point whose distance from a surface is known, mm.
struct KnownPlace {
  Vec3 q;
  double distance = 0.0;
};

// Off the patch, in the middle of every cell of the grid.
std::vector<KnownPlace> places_off(const SplinePatch& patch, const Vec3& outward) {
  std::vector<KnownPlace> places;
  for (std::size_t i = 0; i + 1 < kGridRows; ++i) {
    for (std::size_t j = 0; j + 1 < kGridColumns; ++j) {
      const auto& u = patch.profile().parameters();
      const auto& v = patch.width().parameters();
      const PatchPoint at = patch.at(0.5 * (u.at(i) + u.at(i + 1)), 0.5 * (v.at(j) + v.at(j + 1)));
      for (const double offset : kOffsets_mm)
        places.push_back({at.point + offset * normal_of(at, outward), offset});
    }
  }
  return places;
}

// Off the flank, between the parameters of neighbouring nodes.
std::vector<KnownPlace> places_off(const FaceGear& gear, const FaceGrid& grid) {
  std::vector<KnownPlace> places;
  for (std::size_t i = 0; i + 1 < kGridRows; ++i) {
    for (std::size_t j = 0; j + 1 < kGridColumns; ++j) {
      const FaceParameters& low = grid.at(i).at(j).at;
      const FaceParameters& high = grid.at(i + 1).at(j + 1).at;
      const FacePoint on = relieved_face_point(
          gear, {}, {0.5 * (low.theta + high.theta), 0.5 * (low.beta + high.beta)});
      for (const double offset : kOffsets_mm)
        places.push_back({on.point + offset * on.normal, offset});
    }
  }
  return places;
}

std::vector<KnownPlace> nodes_of(const FaceGrid& grid) {
  std::vector<KnownPlace> nodes;
  for (const auto& row : grid) {
    for (const FaceGridNode& node : row)
      nodes.push_back({node.point, 0.0});
  }
  return nodes;
}

// What a search has found for a place: its distance, with its sign where it has one, and its way
// there.
struct Found {
  bool settled = true;
  double distance = 0.0;
  std::vector<SearchLevel> way;  // errors are those of this place
};

// A search that has ended keeps what it has while others go on.
void merge(const Found& one, std::vector<SearchLevel>& course) {
  if (one.way.empty()) return;
  for (std::size_t k = course.size(); k < one.way.size(); ++k) {
    SearchLevel level = one.way[k];
    level.largest_error_mm = k > 0 ? course[k - 1].largest_error_mm : 0.0;
    course.push_back(level);
  }
  for (std::size_t k = 0; k < course.size(); ++k) {
    const SearchLevel& at = one.way[std::min(k, one.way.size() - 1)];
    if (k < one.way.size() && at.step)
      course[k].step = std::max(course[k].step.value_or(0.0), *at.step);
    course[k].largest_error_mm = std::max(course[k].largest_error_mm, at.largest_error_mm);
  }
}

// `find(place)` → Found.
template <class Find>
PatchSearch search_all(PatchSearch search, bool has_sign, const std::vector<KnownPlace>& places,
                       const std::vector<KnownPlace>& nodes, const Find& find) {
  if (has_sign) search.wrong_signs = 0;
  for (const KnownPlace& place : places) {
    const Found found = find(place);
    if (!found.settled) {
      ++search.unsettled;
      continue;
    }
    const double error = std::abs(std::abs(found.distance) - std::abs(place.distance));
    search.largest_error_mm = std::max(search.largest_error_mm, error);
    if (has_sign && found.distance * place.distance < 0.0) ++*search.wrong_signs;
    merge(found, search.course);
  }
  for (const KnownPlace& node : nodes) {
    const Found found = find(node);
    if (found.settled) search.nodes_mm = std::max(search.nodes_mm, std::abs(found.distance));
    if (!found.settled) ++search.unsettled;
  }
  if (!search.course.empty()) search.points = search.course.back().points;
  return search;
}

Found by_subdivision(const SplinePatch& patch, const KnownPlace& place, int cells) {
  SubdivisionSearch s;
  host::require(closest_point_by_subdivision(patch, place.q, cells, kAccuracy, s), "subdivision");
  Found found{true, s.distance, {}};
  const int of_a_level = s.evaluations / s.levels;
  for (int k = 0; k < s.levels; ++k) {
    const SubdivisionLevel& level = s.level.at(static_cast<std::size_t>(k));
    found.way.push_back(
        {(k + 1) * of_a_level, level.cell, std::abs(level.distance - std::abs(place.distance))});
  }
  return found;
}

// Starts in the nearest node, whose distance is known before its derivatives are.
Found by_newton(const SplinePatch& patch, const KnownPlace& place, const Vec3& outward) {
  ClosestPoint c;
  if (!closest_point(patch, place.q, outward, c).ok()) return {false, 0.0, {}};
  Found found{true, c.distance, {}};
  const double truth = std::abs(place.distance);
  for (int k = 0; k <= c.iterations; ++k) {
    const bool last = k == c.iterations;
    const double distance =
        last ? std::abs(c.distance) : c.step.at(static_cast<std::size_t>(k)).distance;
    SearchLevel level;
    level.points = static_cast<int>(kGridCells) + (k > 0 ? k + 1 : 0);
    if (k > 0) level.step = c.step.at(static_cast<std::size_t>(k - 1)).step;
    level.largest_error_mm = std::abs(distance - truth);
    found.way.push_back(level);
  }
  return found;
}

PatchSearch closed_formula(const FaceGear& gear, const FaceGrid& grid) {
  PatchSearch closed{"closed", "closed distance from the flank, no patch"};
  int most = 0;
  const auto find = [&](const KnownPlace& place) {
    const FaceFoot foot = distance_from_relieved_face(gear, {}, place.q);
    most = std::max(most, foot.steps);
    return Found{has_distance(foot.reason), foot.distance, {}};
  };
  closed = search_all(closed, true, places_off(gear, grid), nodes_of(grid), find);
  closed.levels = static_cast<std::size_t>(most);
  return closed;
}

// The paper's ball, printed with two decimals (its radius and side are inferred), and the same for
// gears it does not touch.
FaceContact ball_of(const FaceGrid& plain_grid, bool table_3) {
  if (table_3) return {FaceFlank{}, kBallRadius_mm, Vec3(20.34, 170.14, 47.0)};
  const FaceGridNode& centre = plain_grid.at(kCentreRow).at(kCentreColumn);
  const Vec3 ball = centre.point + kBallRadius_mm * centre.normal;
  return {FaceFlank{}, kBallRadius_mm, turned(axis_rotation(Axis::z, 81.857 * kDegree), ball)};
}

AngleSearch printed_search(const FaceGear& plain, const FaceContact& ball, double range,
                           bool radius_taken_off) {
  PrintedFaceSearch search;
  search.step = 1.0 * kDegree;
  search.range = range;
  search.radius_taken_off = radius_taken_off;
  FaceAngle found;
  const Status status = printed_face_angle(plain, ball, 0.0, search, found);
  if (!status.ok() && status.reason != Reason::residuals_too_large)
    host::require(status, "search for the angle");
  return {radius_taken_off ? "eq. 27, 28, radius taken off" : "eq. 27, 28 as printed",
          !radius_taken_off,
          range,
          status.ok(),
          found.evaluations,
          kUmPerMm * found.rest};
}

}  // namespace

std::vector<PatchSearch> point_searches(const SplinePatch& patch, const FaceGear& gear,
                                        const FaceGrid& grid) {
  const Vec3 outward = grid.at(kCentreRow).at(kCentreColumn).normal;
  const std::vector<KnownPlace> places = places_off(patch, outward);
  const std::vector<KnownPlace> nodes = nodes_of(grid);
  std::vector<PatchSearch> searches{{"subdivision_10", "subdivision, 10 x 10 cells"},
                                    {"subdivision_4", "subdivision, 4 x 4 cells"},
                                    {"newton", "Newton on the patch"}};
  constexpr std::array<int, 2> kCells{10, 4};
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    searches[i] = search_all(searches[i], false, places, nodes, [&](const KnownPlace& place) {
      return by_subdivision(patch, place, kCells.at(i));
    });
    searches[i].levels = searches[i].course.size();
  }
  searches[2] = search_all(searches[2], true, places, nodes, [&](const KnownPlace& place) {
    return by_newton(patch, place, outward);
  });
  searches[2].levels = searches[2].course.size() - 1;  // without the start
  searches.push_back(closed_formula(gear, grid));
  return searches;
}

std::vector<AngleSearch> angle_searches(const FaceGear& gear, const FaceGear& plain,
                                        const FaceGrid& plain_grid, bool table_3) {
  const FaceContact ball = ball_of(plain_grid, table_3);
  std::vector<AngleSearch> searches;
  for (const bool radius_taken_off : {false, true}) {
    for (const double range : {5.0, 2.72, 1.0})
      searches.push_back(printed_search(plain, ball, range, radius_taken_off));
  }
  double closed = 0.0;
  host::require(face_angle(plain, ball, closed), "closed angle");
  const Vec3 q = turned(axis_rotation(Axis::z, closed), ball.centre);
  const double rest = distance_from_face(plain, ball.flank, q).distance - ball.ball_radius;
  searches.push_back({"closed form", false, {}, true, 1, kUmPerMm * rest});
  if (!(gear.relief.amount > 0.0)) return searches;
  FaceAngle relieved;
  constexpr double kTolerance_mm = 1e-4;
  host::require(relieved_face_angle(gear, ball, closed, kTolerance_mm, relieved), "angle");
  searches.push_back({"closed form, then with the relief",
                      false,
                      {},
                      true,
                      1 + relieved.evaluations,
                      kUmPerMm * relieved.rest});
  return searches;
}

}  // namespace volcomp::face_gear
