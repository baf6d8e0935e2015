#include "host_sim/experiments/face_gear/patch_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/probe/face_relief.hpp"
#include "host_sim/experiments/face_gear/patch_searches.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_choice.hpp"

namespace volcomp::face_gear {
namespace {

// Control points that Table 3 prints: rows 1 to 5 of the first column and of the last, mm.
struct PrintedControlPoint {
  std::size_t row;
  std::size_t column;
  std::array<double, 3> at;
};
constexpr std::size_t kLastColumn = kGridColumns - 1;
constexpr std::array<PrintedControlPoint, 10> kPrintedControl{
    {{0, 0, {162.4990, 4.2239, 46.6096}},
     {1, 0, {162.5003, 4.0421, 47.1388}},
     {2, 0, {162.4990, 3.7085, 48.2265}},
     {3, 0, {162.5000, 3.4522, 49.1085}},
     {4, 0, {162.4996, 3.1657, 50.0910}},
     {0, kLastColumn, {182.4970, 5.5957, 46.6175}},
     {1, kLastColumn, {182.4986, 5.0840, 47.4118}},
     {2, kLastColumn, {182.5002, 4.9045, 47.6847}},
     {3, kLastColumn, {182.5000, 3.5462, 49.9200}},
     {4, kLastColumn, {182.4996, 2.3873, 51.8216}}}};

SplinePatch patch_through(const FaceGrid& grid, Parametrisation by) {
  std::array<Vec3, kGridCells> points;
  for (std::size_t i = 0; i < kGridCells; ++i)
    points.at(i) = grid.at(i / kGridColumns).at(i % kGridColumns).point;
  SplinePatch patch;
  host::require(SplinePatch::through(points, by, patch), "patch");
  return patch;
}

ControlDifference control_difference(const FaceGrid& grid, Parametrisation by, const char* name) {
  const SplinePatch patch = patch_through(grid, by);
  double largest = 0.0;
  for (const PrintedControlPoint& printed : kPrintedControl) {
    const Vec3 at(printed.at[0], printed.at[1], printed.at[2]);
    const Vec3 off = patch.control(printed.row, printed.column) - at;
    largest = std::max(largest, off.cwiseAbs().maxCoeff());
  }
  return {name, kUmPerMm * largest};
}

double distance_of(const FaceGear& gear, const Vec3& q) {
  const FaceFoot foot = distance_from_relieved_face(gear, {}, q);
  if (!has_distance(foot.reason)) host::require(refuse(foot.reason), "distance from the flank");
  return foot.distance;
}

PatchDistance patch_distance(const FaceGear& gear, const FaceGrid& grid) {
  const SplinePatch patch = patch_through(grid, Parametrisation::uniform);
  PatchDistance d;
  d.relieved = gear.relief.amount > 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < kRasterRows; ++i) {
    for (std::size_t j = 0; j < kRasterColumns; ++j) {
      const double u = static_cast<double>(i) / static_cast<double>(kRasterRows - 1);
      const double v = static_cast<double>(j) / static_cast<double>(kRasterColumns - 1);
      const double off = distance_of(gear, patch.at(u, v).point);
      if (i % kStepsOfACell == 0 && j % kStepsOfACell == 0)
        d.nodes_mm = std::max(d.nodes_mm, std::abs(off));
      d.raster_um.push_back(kUmPerMm * off);
      d.largest_um = std::max(d.largest_um, kUmPerMm * std::abs(off));
      squares += off * off;
    }
  }
  d.rms_um = kUmPerMm * std::sqrt(squares / static_cast<double>(d.raster_um.size()));
  return d;
}

const PatchSearch& search_of(const PatchComparison& c, const std::string& key) {
  for (const PatchSearch& search : c.search)
    if (search.key == key) return search;
  throw host::UserError(key + ": no such search");
}

PatchPromise most_points(const PatchSearch& search, const char* key, double limit) {
  return {key, fmt::format("{}: points", search.name), "",
          static_cast<double>(search.points.value_or(0)), limit};
}

// Far above rounding at a radius of a metre, far below what is measured.
constexpr double kNothing_mm = 1e-11;

PatchPromise no_error(const PatchSearch& search, const char* key) {
  return {key, fmt::format("{}: error", search.name), "mm",
          std::max(search.largest_error_mm, search.nodes_mm), kNothing_mm};
}

PatchPromise no_wrong_sign(const PatchSearch& search, const char* key) {
  return {key, fmt::format("{}: wrong signs", search.name), "",
          static_cast<double>(search.wrong_signs.value_or(0)), 0.0};
}

// Those that hold for every gear: they depend on the searches, not on the flank.
void promise_searches(const PatchComparison& c, std::vector<PatchPromise>& promises) {
  double nodes = 0.0;
  for (const PatchDistance& d : c.patch)
    nodes = std::max(nodes, d.nodes_mm);
  double ended = 0.0;
  double rest = 0.0;
  for (const AngleSearch& a : c.angle) {
    if (a.printed && a.ends) ended += 1.0;
    if (!a.range_mm) rest = std::max(rest, std::abs(a.rest_um));
  }
  const PatchSearch& newton = search_of(c, "newton");
  const PatchSearch& closed = search_of(c, "closed");
  promises = {{"nodes", "patch from the flank in its nodes", "mm", nodes, kNothing_mm},
              most_points(search_of(c, "subdivision_10"), "subdivision_10_points", 1210.0),
              most_points(search_of(c, "subdivision_4"), "subdivision_4_points", 575.0),
              no_error(newton, "newton_error"),
              no_wrong_sign(newton, "newton_signs"),
              no_error(closed, "closed_error"),
              no_wrong_sign(closed, "closed_signs"),
              {"printed_ends", "searches for the angle as printed that end", "", ended, 0.0},
              {"closed_angle", "closed angle: distance less radius", "µm", rest, 0.1}};
}

// What the page prints of the gear of Table 3.
void promise_table_3(const PatchComparison& c, std::vector<PatchPromise>& promises) {
  promises.push_back({"control_uniform", "control points from the print, uniform", "µm",
                      c.control.at(0).largest_um, 1.0});
  promises.push_back(
      {"control_chord", "the same, chord", "µm", c.control.at(1).largest_um, 236.0, true});
  promises.push_back({"control_centripetal", "the same, centripetal", "µm",
                      c.control.at(2).largest_um, 124.0, true});
  const PatchDistance& plain = c.patch.at(0);
  const PatchDistance& relieved = c.patch.at(1);
  promises.push_back({"generated_largest", "patch between its nodes, no relief: largest", "µm",
                      plain.largest_um, 0.13});
  promises.push_back({"generated_rms", "the same, rms", "µm", plain.rms_um, 0.016});
  promises.push_back({"relieved_largest", "patch between its nodes, relief: largest", "µm",
                      relieved.largest_um, 1.25});
  promises.push_back({"relieved_rms", "the same, rms", "µm", relieved.rms_um, 0.3});
  const PatchSearch& newton = search_of(c, "newton");
  promises.push_back(
      {"newton_steps", "Newton: steps", "", static_cast<double>(newton.levels), 6.0});
  promises.push_back({"newton_unsettled", "Newton: places it finds nothing for", "",
                      static_cast<double>(newton.unsettled), 0.0});
  promises.push_back({"closed_unsettled", "closed distance: the same", "",
                      static_cast<double>(search_of(c, "closed").unsettled), 0.0});
}

}  // namespace

PatchComparison compare_patch(const std::string& gear) {
  const host::GearChoice choice = host::choose_face_gear(gear);
  PatchComparison c;
  c.gear_name = gear;
  c.gear = choice.gear;
  c.table_3 = gear == "table3";
  if (!host::is_published_gear(gear)) c.inputs.push_back(host::hashed_file("gear", gear));
  FaceGear plain = choice.gear;
  plain.relief = {};
  host::require(derive(plain), gear);
  FaceGrid plain_grid;
  FaceGrid grid;
  host::require(make_face_grid(plain, choice.plan, plain_grid), gear);
  host::require(make_face_grid(choice.gear, choice.plan, grid), gear);
  if (c.table_3) {
    c.control = {control_difference(grid, Parametrisation::uniform, "uniform"),
                 control_difference(grid, Parametrisation::chord, "chord"),
                 control_difference(grid, Parametrisation::centripetal, "centripetal")};
  }
  c.patch.push_back(patch_distance(plain, plain_grid));
  if (c.gear.relief.amount > 0.0) c.patch.push_back(patch_distance(c.gear, grid));
  c.search = point_searches(patch_through(grid, Parametrisation::uniform), c.gear, grid);
  c.angle = angle_searches(c.gear, plain, plain_grid, c.table_3);
  return c;
}

std::vector<PatchPromise> patch_promises(const PatchComparison& comparison) {
  std::vector<PatchPromise> promises;
  promise_searches(comparison, promises);
  if (comparison.table_3) promise_table_3(comparison, promises);
  return promises;
}

host::Verdict patch_verdict(const PatchComparison& comparison) {
  const std::vector<PatchPromise> promises = patch_promises(comparison);
  std::string broken;
  for (const PatchPromise& p : promises)
    if (!p.holds()) broken += (broken.empty() ? "" : "; ") + p.what;
  if (broken.empty())
    return {true,
            fmt::format("All {} figures are within what the page promises of {}.", promises.size(),
                        comparison.table_3 ? "the gear of Table 3" : "any gear")};
  return {false, "Other than the page promises: " + broken + "."};
}

}  // namespace volcomp::face_gear
