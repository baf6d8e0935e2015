#include "host_sim/experiments/face_gear/patch/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcomp::face_gear {
namespace {

constexpr double kSettled = 1e-12;

struct Place {
  double u = 0.0;
  double v = 0.0;
};

Place nearest_node(const SplinePatch& patch, const Vec3& q) {
  Place best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const double u : patch.profile().parameters()) {
    for (const double v : patch.width().parameters()) {
      const double square = (patch.at(u, v).point - q).squaredNorm();
      if (!(square < nearest)) continue;
      nearest = square;
      best = {u, v};
    }
  }
  return best;
}

// Half the squared distance as a function of u and v: gradient and Hessian.
struct Slope {
  Slope(const PatchPoint& p, const Vec3& q) {
    const Vec3 d = p.point - q;
    gu = d.dot(p.du);
    gv = d.dot(p.dv);
    uu = p.du.squaredNorm() + d.dot(p.duu);
    uv = p.du.dot(p.dv) + d.dot(p.duv);
    vv = p.dv.squaredNorm() + d.dot(p.dvv);
    if (uu > 0.0 && uu * vv > uv * uv) return;
    // Far from the patch the full Hessian may point uphill; without curvature it never does.
    uu = p.du.squaredNorm();
    uv = p.du.dot(p.dv);
    vv = p.dv.squaredNorm();
  }

  double gu, gv;
  double uu, uv, vv;
};

// Whether going downhill would leave 0…1.
bool held(double at, double gradient) {
  return (at <= 0.0 && gradient > 0.0) || (at >= 1.0 && gradient < 0.0);
}

double kept_inside(double x) { return std::clamp(x, 0.0, 1.0); }

// One step; a coordinate held by an edge stays there.
Place newton_step(const Place& at, const Slope& s) {
  const bool u_held = held(at.u, s.gu);
  const bool v_held = held(at.v, s.gv);
  if (u_held && v_held) return at;
  if (u_held) return {at.u, kept_inside(at.v - s.gv / s.vv)};
  if (v_held) return {kept_inside(at.u - s.gu / s.uu), at.v};
  const double determinant = s.uu * s.vv - s.uv * s.uv;
  return {kept_inside(at.u - (s.vv * s.gu - s.uv * s.gv) / determinant),
          kept_inside(at.v - (s.uu * s.gv - s.uv * s.gu) / determinant)};
}

// A side of the window of the subdivision.
struct Interval {
  double low = 0.0;
  double high = 1.0;

  [[nodiscard]] double at(int i, int cells) const {
    return i == cells ? high : low + width(cells) * i;
  }
  [[nodiscard]] double width(int cells) const { return (high - low) / cells; }
  // The cells on both sides of corner i, as far as the window has them.
  [[nodiscard]] Interval around(int i, int cells) const {
    return {at(std::max(i - 1, 0), cells), at(std::min(i + 1, cells), cells)};
  }
};

struct Corner {
  int i = 0;
  int j = 0;
  double square = std::numeric_limits<double>::infinity();
};

Corner nearest_corner(const SplinePatch& patch, const Vec3& q, const Interval& u, const Interval& v,
                      int cells) {
  Corner best;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double square = (patch.at(u.at(i, cells), v.at(j, cells)).point - q).squaredNorm();
      if (square < best.square) best = {i, j, square};
    }
  }
  return best;
}

}  // namespace

Status closest_point(const SplinePatch& patch, const Vec3& q, const Vec3& outward,
                     ClosestPoint& out) {
  if (!q.allFinite() || !outward.allFinite()) return refuse(Reason::not_finite);
  Place at = nearest_node(patch, q);
  int iterations = 0;
  std::array<NewtonStep, kMostNewtonSteps> steps{};
  for (bool settled = false; !settled;) {
    if (iterations == kMostNewtonSteps) {
      Where where;
      where.count = iterations;
      return refuse(Reason::not_converged, where);
    }
    const PatchPoint here = patch.at(at.u, at.v);
    const Place next = newton_step(at, Slope(here, q));
    const double step = std::max(std::abs(next.u - at.u), std::abs(next.v - at.v));
    steps.at(static_cast<std::size_t>(iterations)) = {(here.point - q).norm(), step};
    settled = step < kSettled;
    at = next;
    ++iterations;
  }
  const PatchPoint foot = patch.at(at.u, at.v);
  const Vec3 normal = normal_of(foot, outward);
  if (normal.isZero()) return refuse(Reason::zero_normal);
  out = {at.u, at.v, foot.point, normal, (q - foot.point).dot(normal), iterations, steps};
  return {};
}

Status closest_point_by_subdivision(const SplinePatch& patch, const Vec3& q, int cells,
                                    double accuracy, SubdivisionSearch& out) {
  if (!q.allFinite()) return refuse(Reason::not_finite);
  if (cells < 4 || cells > 100) return refuse_value(Reason::bad_setting, "cells", cells);
  if (!(accuracy >= 1e-12 && accuracy <= 1.0))
    return refuse_value(Reason::bad_setting, "accuracy", accuracy);
  SubdivisionSearch search;
  Interval u;
  Interval v;
  while (search.levels < kMostLevels) {
    const Corner best = nearest_corner(patch, q, u, v, cells);
    search.evaluations += (cells + 1) * (cells + 1);
    search.u = u.at(best.i, cells);
    search.v = v.at(best.j, cells);
    search.distance = std::sqrt(best.square);
    const double cell = std::max(u.width(cells), v.width(cells));
    search.level.at(static_cast<std::size_t>(search.levels++)) = {cell, search.distance};
    if (cell < accuracy) break;
    u = u.around(best.i, cells);
    v = v.around(best.j, cells);
  }
  search.foot = patch.at(search.u, search.v).point;
  out = search;
  return {};
}

}  // namespace volcomp::face_gear
