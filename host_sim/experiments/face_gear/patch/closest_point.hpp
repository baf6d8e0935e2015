#pragma once
// The point of a patch nearest to a given one, and the signed distance from it.
//
// Newton's method is the one to use. The subdivision of the paper (docs/papers/face-gear.md) stands
// beside it for comparison: it takes ten times as many evaluations, returns a distance without
// sign, and may lose the nearest point: in the nodes of the paper's Table 3 it is up to 0.13 µm off
// with 10 × 10 cells, 20 µm with 4 × 4.

#include <array>

#include "host_sim/experiments/face_gear/patch/spline_patch.hpp"

namespace volcomp::face_gear {

inline constexpr int kMostNewtonSteps = 30;

struct NewtonStep {
  double distance = 0.0;  // of the place before the step, without sign, mm
  double step = 0.0;      // largest change of u or v
};

struct ClosestPoint {
  double u = 0.0;
  double v = 0.0;
  Vec3 foot = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, at the foot, on the side of `outward`
  double distance = 0.0;       // along the normal, positive on the side of `outward`, mm
  int iterations = 0;
  std::array<NewtonStep, kMostNewtonSteps> step{};  // the first `iterations` of them
};

// Newton with the second derivatives of the patch, kept within it: beyond an edge the foot is on
// the edge. Starts at the node nearest to `q` (105 evaluations); 3 to 6 iterations to 1e-12 of u
// and v. Refused: not_finite, zero_normal, not_converged (count) after
// kMostNewtonSteps.
Status closest_point(const SplinePatch& patch, const Vec3& q, const Vec3& outward,
                     ClosestPoint& out);

// A level halves the window at least: 1e-12 needs 40.
inline constexpr int kMostLevels = 64;

struct SubdivisionLevel {
  double cell = 0.0;      // width of a cell, the larger one of u and v
  double distance = 0.0;  // of the nearest corner, mm
};

struct SubdivisionSearch {
  double u = 0.0;
  double v = 0.0;
  Vec3 foot = Vec3::Zero();
  double distance = 0.0;  // without sign; too large by up to the last step where q is on the patch
  int levels = 0;
  int evaluations = 0;
  std::array<SubdivisionLevel, kMostLevels> level{};  // the first `levels` of them
};

// The paper's search: evaluate the corners of cells × cells, keep the cells around the nearest
// corner, repeat until a cell is narrower than `accuracy` in u and v. A window shrinks to 2/cells,
// so fewer than 4 cells are refused (2 never shrink it): bad_setting 'cells' unless 4…100,
// 'accuracy' unless 1e-12…1, not_finite.
Status closest_point_by_subdivision(const SplinePatch& patch, const Vec3& q, int cells,
                                    double accuracy, SubdivisionSearch& out);

}  // namespace volcomp::face_gear
