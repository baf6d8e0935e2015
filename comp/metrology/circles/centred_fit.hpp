#pragma once
// Least squares of the radius of a path about its own centre, by columns of the nominal angle.

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "comp/metrology/circles/circle_test.hpp"
#include "comp/metrology/fits/fold_row.hpp"

namespace volcomp {

// Deviation of the radius of the path from nominal, mm, where a bar reads `radial` and its socket
// is `centre` beside the nominal one. Exact: without the root a socket 0.2 mm off would put c₁c₂/R²
// into the squareness, 4 µrad at R = 100 mm.
inline double path_deviation(double radius, double theta, double radial,
                             const Eigen::Vector2d& centre) {
  const double along = std::cos(theta) * centre[0] + std::sin(theta) * centre[1];
  const double across = std::cos(theta) * centre[1] - std::sin(theta) * centre[0];
  const double length = radius + radial;
  // √(length² − across²) − length, without what cancels.
  const double bent = across * across / (length + std::sqrt(length * length - across * across));
  return along + radial - bent;
}

// Columns of a fit, as many as are ever needed; one that is 0 everywhere is not used.
inline constexpr int kCircleColumns = 14;
using CircleRow = Eigen::Matrix<double, 1, kCircleColumns>;
using CircleVector = Eigen::Matrix<double, kCircleColumns, 1>;

struct CentredFit {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // of the socket against nominal, mm
  CircleVector x = CircleVector::Zero();             // coefficients, mm; x₁ = x₂ = 0
  CircleVector factor = CircleVector::Zero();        // of their standard uncertainties over `rms`
  double rms = 0.0;  // of the residuals, with their degrees of freedom
  int columns = 0;   // that are used
};

namespace detail {

using CircleTriangle = Eigen::Matrix<double, kCircleColumns + 1, kCircleColumns + 1>;

template <class RowOf>
CircleTriangle fold_circle(const CircleTest& test, const RowOf& row_of,
                           const Eigen::Vector2d& centre) {
  CircleTriangle triangle = CircleTriangle::Zero();
  for_each_reading(test, [&](double theta, double radial, double sense) {
    Eigen::Matrix<double, 1, kCircleColumns + 1> row;
    row << row_of(theta, sense), path_deviation(test.radius, theta, radial, centre);
    fold_row(triangle, row);
  });
  return triangle;
}

// Eigen's solver of triangles would ask the heap.
inline CircleVector substituted_back(
    const Eigen::Matrix<double, kCircleColumns, kCircleColumns>& triangle, CircleVector x) {
  for (int i = kCircleColumns - 1; i >= 0; --i) {
    for (int j = i + 1; j < kCircleColumns; ++j)
      x[i] -= triangle(i, j) * x[j];
    x[i] /= triangle(i, i);
  }
  return x;
}

}  // namespace detail

// row_of(theta, sense): the columns at a reading; the first three are 1, cos θ, sin θ. The centre
// is the one for which the coefficients of the second and the third vanish.
template <class RowOf>
CentredFit fit_centred(const CircleTest& test, const RowOf& row_of) {
  constexpr int kMostSteps = 20;        // three to five are taken
  constexpr double kConverged = 1e-13;  // mm
  CentredFit fit;
  detail::CircleTriangle folded;
  Eigen::Matrix<double, kCircleColumns, kCircleColumns> triangle;
  for (int step = 0; step < kMostSteps; ++step) {
    folded = detail::fold_circle(test, row_of, fit.centre);
    triangle = folded.topLeftCorner<kCircleColumns, kCircleColumns>();
    fit.columns = 0;
    for (int i = 0; i < kCircleColumns; ++i) {
      if (triangle(i, i) > 0.0 || triangle(i, i) < 0.0) {
        ++fit.columns;
      } else {
        triangle(i, i) = 1.0;
      }
    }
    const CircleVector right = folded.topRightCorner<kCircleColumns, 1>();
    fit.x = detail::substituted_back(triangle, right);
    const Eigen::Vector2d off = fit.x.segment<2>(1);
    if (off.cwiseAbs().maxCoeff() < kConverged) break;
    fit.centre -= off;
  }
  double readings = 0.0;
  for_each_reading(test, [&](double, double, double) { readings += 1.0; });
  fit.rms = std::abs(folded(kCircleColumns, kCircleColumns)) /
            std::sqrt(std::max(1.0, readings - fit.columns));
  for (int j = 0; j < kCircleColumns; ++j)
    fit.factor += detail::substituted_back(triangle, CircleVector::Unit(j)).cwiseAbs2();
  fit.factor = fit.factor.cwiseSqrt();
  return fit;
}

}  // namespace volcomp
