#pragma once
// A flank that is known as a grid of points: bicubic, clamped B-spline patch through all of them,
// u along the profile (rows), v along the face width (columns), both 0…1.
//
// Between the nodes of the decoded gear of Table 3 (docs/papers/face-gear.md) it keeps within 0.13
// µm of a flank without relief, and within 1.25 µm of the relieved one, whose curvature jumps.

#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/metrology/faces/measuring_grid.hpp"
#include "host_sim/experiments/face_gear/patch/spline_basis.hpp"

namespace volcomp::face_gear {

// How nodes become parameters. Uniform reproduces the control points of the paper's Table 3.
enum class Parametrisation : std::uint8_t {
  uniform,      // equal steps
  chord,        // by the distance of neighbours
  centripetal,  // by its square root
};

// A place on the patch with all first and second derivatives, mm.
struct PatchPoint {
  Vec3 point = Vec3::Zero();
  Vec3 du = Vec3::Zero();
  Vec3 dv = Vec3::Zero();
  Vec3 duu = Vec3::Zero();
  Vec3 duv = Vec3::Zero();
  Vec3 dvv = Vec3::Zero();
};

class SplinePatch {
 public:
  // `points`: kGridCells, row by row, mm, any frame. Inverts both collocation matrices, on 8 KB of
  // stack: not for the trigger task. Refused, with `out` as it was: length_mismatch (count),
  // not_finite (index), coincident (index of the point) where a parametrisation by length finds no
  // length.
  static Status through(Span<const Vec3> points, Parametrisation parametrisation, SplinePatch& out);

  // u, v within 0…1. Fixed number of operations.
  [[nodiscard]] PatchPoint at(double u, double v) const;

  [[nodiscard]] const Vec3& control(std::size_t row, std::size_t column) const {
    return control_[grid_index(row, column)];
  }
  [[nodiscard]] const SplineBasis<kGridRows>& profile() const { return profile_; }
  [[nodiscard]] const SplineBasis<kGridColumns>& width() const { return width_; }

 private:
  SplineBasis<kGridRows> profile_;
  SplineBasis<kGridColumns> width_;
  std::array<Vec3, kGridCells> control_{};
};

// Unit normal on the side of the patch that `outward` points to; zero where the patch degenerates.
[[nodiscard]] Vec3 normal_of(const PatchPoint& place, const Vec3& outward);

}  // namespace volcomp::face_gear
