#include "host_sim/experiments/face_gear/patch/spline_patch.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace volcomp::face_gear {
namespace {

// The nodes along one direction of the grid: `lines` polylines of N points each.
struct Polylines {
  Span<const Vec3> points;
  std::size_t lines = 0;
  std::size_t line_step = 0;  // from one line to the next
  std::size_t node_step = 0;  // from one node of a line to the next

  [[nodiscard]] std::size_t index(std::size_t line, std::size_t node) const {
    return line * line_step + node * node_step;
  }
  [[nodiscard]] double step(std::size_t line, std::size_t node, Parametrisation by) const {
    const double length = (points[index(line, node + 1)] - points[index(line, node)]).norm();
    return by == Parametrisation::centripetal ? std::sqrt(length) : length;
  }
};

Status coincident(std::size_t index) {
  Where where;
  where.index = static_cast<int>(index);
  return refuse(Reason::coincident, where);
}

// Lengths from the first node, each line's total taken as 1, averaged over the lines.
template <std::size_t N>
Status mean_parameters(const Polylines& grid, Parametrisation by, std::array<double, N>& out) {
  std::array<double, N> mean{};
  for (std::size_t line = 0; line < grid.lines; ++line) {
    std::array<double, N> reached{};
    for (std::size_t k = 0; k + 1 < N; ++k)
      reached[k + 1] = reached[k] + grid.step(line, k, by);
    if (!(reached[N - 1] > 0.0)) return coincident(grid.index(line, 0));
    for (std::size_t k = 0; k < N; ++k)
      mean[k] += reached[k] / (reached[N - 1] * static_cast<double>(grid.lines));
  }
  mean[N - 1] = 1.0;
  for (std::size_t k = 0; k + 1 < N; ++k) {
    if (!(mean[k + 1] > mean[k])) return coincident(grid.index(0, k + 1));
  }
  out = mean;
  return {};
}

template <std::size_t N>
Status basis_for(const Polylines& grid, Parametrisation by, SplineBasis<N>& out) {
  out = SplineBasis<N>();
  if (by == Parametrisation::uniform) return {};
  std::array<double, N> parameters{};
  if (const Status s = mean_parameters(grid, by, parameters); !s.ok()) return s;
  out = SplineBasis<N>(parameters);
  return {};
}

Status check(Span<const Vec3> points) {
  Where where;
  where.count = static_cast<int>(points.size());
  if (points.size() != kGridCells) return refuse(Reason::length_mismatch, where);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Where at;
    at.index = static_cast<int>(i);
    if (!points[i].allFinite()) return refuse(Reason::not_finite, at);
  }
  return {};
}

template <std::size_t N>
using Collocation = Eigen::Matrix<double, static_cast<int>(N), static_cast<int>(N)>;

template <std::size_t N>
Collocation<N> collocation(const SplineBasis<N>& basis) {
  Collocation<N> matrix = Collocation<N>::Zero();
  for (std::size_t k = 0; k < N; ++k) {
    const BasisValues b = basis.at(basis.parameters()[k]);
    for (std::size_t i = 0; i < 4; ++i)
      matrix(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(b.first + i)) = b.value[i];
  }
  return matrix;
}

// Coefficients of the functions = inverse · values in the nodes. Gauss and Jordan without
// exchanging rows: a collocation matrix of B-splines is totally positive, so its pivots are
// positive and nothing grows (de Boor and Pinkus 1977).
template <std::size_t N>
Collocation<N> inverse_collocation(const SplineBasis<N>& basis) {
  Collocation<N> rest = collocation(basis);
  Collocation<N> inverse = Collocation<N>::Identity();
  for (Eigen::Index k = 0; k < rest.rows(); ++k) {
    const double pivot = rest(k, k);
    rest.row(k) /= pivot;
    inverse.row(k) /= pivot;
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
      if (i == k) continue;
      const double factor = rest(i, k);
      rest.row(i) -= factor * rest.row(k);
      inverse.row(i) -= factor * inverse.row(k);
    }
  }
  return inverse;
}

// Σ_j matrix(i, j) · values[j], for the nodes of one line.
template <std::size_t N>
Vec3 row_times(const Collocation<N>& matrix, std::size_t i, const Vec3* values, std::size_t step) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t j = 0; j < N; ++j)
    sum += matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * values[j * step];
  return sum;
}

}  // namespace

Status SplinePatch::through(Span<const Vec3> points, Parametrisation parametrisation,
                            SplinePatch& out) {
  if (const Status s = check(points); !s.ok()) return s;
  SplinePatch patch;
  const Polylines columns{points, kGridColumns, 1, kGridColumns};
  const Polylines rows{points, kGridRows, kGridColumns, 1};
  if (const Status s = basis_for(columns, parametrisation, patch.profile_); !s.ok()) return s;
  if (const Status s = basis_for(rows, parametrisation, patch.width_); !s.ok()) return s;

  // First along the rows, then along the columns.
  const auto along_width = inverse_collocation(patch.width_);
  const auto along_profile = inverse_collocation(patch.profile_);
  std::array<Vec3, kGridCells> half;
  for (std::size_t i = 0; i < kGridRows; ++i) {
    for (std::size_t j = 0; j < kGridColumns; ++j)
      half[grid_index(i, j)] =
          row_times<kGridColumns>(along_width, j, &points[grid_index(i, 0)], 1);
  }
  for (std::size_t i = 0; i < kGridRows; ++i) {
    for (std::size_t j = 0; j < kGridColumns; ++j)
      patch.control_[grid_index(i, j)] =
          row_times<kGridRows>(along_profile, i, &half[j], kGridColumns);
  }
  out = patch;
  return {};
}

PatchPoint SplinePatch::at(double u, double v) const {
  const BasisValues along_profile = profile_.at(u);
  const BasisValues along_width = width_.at(v);
  PatchPoint p;
  for (std::size_t i = 0; i < 4; ++i) {
    // Along the width first: a point of the column of four, with its derivatives by v.
    Vec3 value = Vec3::Zero();
    Vec3 slope = Vec3::Zero();
    Vec3 curvature = Vec3::Zero();
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3& c = control(along_profile.first + i, along_width.first + j);
      value += along_width.value[j] * c;
      slope += along_width.slope[j] * c;
      curvature += along_width.curvature[j] * c;
    }
    p.point += along_profile.value[i] * value;
    p.du += along_profile.slope[i] * value;
    p.duu += along_profile.curvature[i] * value;
    p.dv += along_profile.value[i] * slope;
    p.duv += along_profile.slope[i] * slope;
    p.dvv += along_profile.value[i] * curvature;
  }
  return p;
}

Vec3 normal_of(const PatchPoint& place, const Vec3& outward) {
  const Vec3 cross = place.du.cross(place.dv);
  const double length = cross.norm();
  if (!(length > 0.0)) return Vec3::Zero();
  return cross.dot(outward) < 0.0 ? Vec3(-cross / length) : Vec3(cross / length);
}

}  // namespace volcomp::face_gear
