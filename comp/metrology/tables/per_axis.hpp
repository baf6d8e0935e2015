#pragma once
// What a controller with one-dimensional tables only (pitch and cross tables) can represent of a
// volumetric model: E_k ≈ const_k + Σ_j f_kj(q_j), nine functions; the rest is reported as a
// number.

#include <algorithm>
#include <array>
#include <cmath>

#include "comp/machine/frame.hpp"

namespace volcomp {

// Uniform knots of one of the three linear axes.
struct KnotGrid {
  double q0 = 0.0;
  double pitch = 1.0;
  std::size_t knots = 2;

  [[nodiscard]] double at(std::size_t i) const { return q0 + static_cast<double>(i) * pitch; }
};

template <std::size_t Capacity>
struct PerAxisTables {
  Vec3 constant = Vec3::Zero();
  std::array<std::array<Vec3, Capacity>, 3> f{};  // f[axis][knot], all three components, mm
  Vec3 residual_max = Vec3::Zero();               // per component over all knots of the grid
  double residual_rms = 0.0;                      // over all components and knots
};

namespace detail {

template <class Visit>
void for_each_knot(const std::array<KnotGrid, 3>& grid, const Visit& visit) {
  for (std::size_t i = 0; i < grid[0].knots; ++i) {
    for (std::size_t j = 0; j < grid[1].knots; ++j) {
      for (std::size_t k = 0; k < grid[2].knots; ++k) {
        visit(std::array<std::size_t, 3>{i, j, k},
              Vec3(grid[0].at(i), grid[1].at(j), grid[2].at(k)));
      }
    }
  }
}

template <std::size_t Capacity, class ErrorAt>
void measure_residual(const ErrorAt& error_at, const std::array<KnotGrid, 3>& grid,
                      PerAxisTables<Capacity>& out) {
  double squares = 0.0;
  std::size_t count = 0;
  out.residual_max.setZero();
  for_each_knot(grid, [&](const std::array<std::size_t, 3>& at, const Vec3& q) {
    const Vec3 rest =
        error_at(q) - out.constant - out.f[0][at[0]] - out.f[1][at[1]] - out.f[2][at[2]];
    out.residual_max = out.residual_max.cwiseMax(rest.cwiseAbs());
    squares += rest.squaredNorm();
    count += 3;
  });
  out.residual_rms = std::sqrt(squares / static_cast<double>(count));
}

}  // namespace detail

// Least-squares best tables on the grid: means over the other two axes. `error_at(Vec3 q)` in mm;
// knots ≤ Capacity.
template <std::size_t Capacity, class ErrorAt>
void per_axis_grid_mean(const ErrorAt& error_at, const std::array<KnotGrid, 3>& grid,
                        PerAxisTables<Capacity>& out) {
  out.constant.setZero();
  for (auto& column : out.f)
    column.fill(Vec3::Zero());
  const auto total = static_cast<double>(grid[0].knots * grid[1].knots * grid[2].knots);
  detail::for_each_knot(grid, [&](const std::array<std::size_t, 3>& at, const Vec3& q) {
    const Vec3 e = error_at(q);
    out.constant += e / total;
    for (std::size_t j = 0; j < 3; ++j)
      out.f[j][at[j]] += e * (static_cast<double>(grid[j].knots) / total);
  });
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < grid[j].knots; ++i)
      out.f[j][i] -= out.constant;
  }
  detail::measure_residual(error_at, grid, out);
}

}  // namespace volcomp
