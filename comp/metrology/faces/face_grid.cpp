#include "comp/metrology/faces/face_grid.hpp"

#include <cmath>

#include "comp/machine/fine_trig.hpp"

namespace volcomp {
namespace {

constexpr int kHalvings = 60;
constexpr int kMostSteps = 30;
constexpr double kEdge = 0.15;    // modules
constexpr double kMargin = 0.05;  // of the face width

// Depth of a row; `part` 0…1 from the first column to the last.
double depth_of(const FaceGridPlan& plan, std::size_t row, double part) {
  const std::size_t fixed = plan.tip_depths.size();
  if (row < fixed) return plan.tip_depths[row];
  const double root = plan.first_root_depth + part * (plan.last_root_depth - plan.first_root_depth);
  const double from = plan.tip_depths[fixed - 1];
  const auto step = static_cast<double>(row - fixed + 1);
  return from + (root - from) * step / static_cast<double>(kGridRows - fixed);
}

// Where the flank has this x at this depth. The slot is narrow: the radius settles at once.
Reason find_parameters(const FaceGear& gear, double x, double z, FaceParameters& at) {
  FaceSection section;
  double rho = x;
  for (int step = 0; step < kMostSteps; ++step) {
    if (const Reason r = cut_flank(gear, rho * rho, z, section); r != Reason::ok) return r;
    at = {section.roll, section.beta};
    const double next = x / fine_sine_cosine_rad(half_slot_angle(gear, rho, z)).cosine;
    if (std::abs(next - rho) <= 1e-14 * rho) return Reason::ok;
    rho = next;
  }
  return Reason::no_regular_flank;
}

Reason find_node(const FaceGear& gear, double x, double z, FaceGridNode& node) {
  if (!std::isfinite(x) || !std::isfinite(z)) return Reason::not_finite;
  if (const Reason r = find_parameters(gear, x, z, node.at); r != Reason::ok) return r;
  const Vec3 generated = face_point(gear, {}, node.at).point;
  if (const Reason r = distance_from_face(gear, {}, generated).reason; r != Reason::ok) return r;
  const FacePoint on = relieved_face_point(gear, {}, node.at);
  node.point = on.point;
  node.normal = on.normal;
  return Reason::ok;
}

}  // namespace

FaceGridPlan face_grid_of_table_3() { return {162.5, 182.5, {46.6, 47.5, 48.4}, 51.285, 54.3142}; }

double fillet_depth(const FaceGear& gear, double x) {
  double low = 0.0;
  double high = 1.4;
  for (int i = 0; i < kHalvings; ++i) {
    const double beta = 0.5 * (low + high);
    (face_point(gear, {}, {gear.theta_tip, beta}).point.x() < x ? low : high) = beta;
  }
  return face_point(gear, {}, {gear.theta_tip, low}).point.z();
}

FaceGridPlan plan_face_grid(const FaceGear& gear) {
  const double margin = kMargin * (gear.r_out - gear.r_in);
  const double edge = kEdge * gear.module;
  FaceGridPlan plan;
  plan.first_x = gear.r_in + margin;
  plan.last_x = gear.r_out - margin;
  plan.first_root_depth = fillet_depth(gear, plan.first_x) - edge;
  plan.last_root_depth = fillet_depth(gear, plan.last_x) - edge;
  for (std::size_t row = 0; row < plan.tip_depths.size(); ++row)
    plan.tip_depths[row] = gear.z_tip + edge * (1.0 + 1.5 * static_cast<double>(row));
  return plan;
}

Status make_face_grid(const FaceGear& gear, const FaceGridPlan& plan, FaceGrid& out) {
  FaceGrid grid;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column) {
      const double part = static_cast<double>(column) / static_cast<double>(kGridColumns - 1);
      const double x = plan.first_x + part * (plan.last_x - plan.first_x);
      const Reason reason = find_node(gear, x, depth_of(plan, row, part), grid[row][column]);
      if (reason == Reason::ok) continue;
      Where where;
      where.index = static_cast<int>(row * kGridColumns + column);
      return refuse(reason, where);
    }
  }
  out = grid;
  return {};
}

}  // namespace volcomp
