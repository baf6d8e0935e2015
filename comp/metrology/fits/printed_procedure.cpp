#include "comp/metrology/fits/printed_procedure.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace volcomp {

Status reading_figures(Span<const double> difference, ReadingFigures& out) {
  if (difference.empty()) return refuse(Reason::too_few_points);
  for (std::size_t i = 0; i < difference.size(); ++i) {
    Where where;
    where.index = static_cast<int>(i);
    if (!std::isfinite(difference[i])) return refuse(Reason::not_finite, where);
  }
  const auto n = static_cast<double>(difference.size());
  ReadingFigures f;
  for (const double d : difference)
    f.mean += d / n;
  double sum = 0.0;
  for (const double d : difference)
    sum += (d - f.mean) * (d - f.mean);
  f.deviation = std::sqrt(sum / std::max(1.0, n - 1.0));
  const auto [low, high] = std::minmax_element(difference.begin(), difference.end());
  f.range = *high - *low;
  out = f;
  return {};
}

// n times the same rows: least squares sees the mean of their right sides, and the rank is that of
// one block.
Status printed_x_solution(Span<const double> difference, double start, PrintedSolution& out) {
  ReadingFigures figures;
  if (const Status s = reading_figures(difference, figures); !s.ok()) return s;
  if (!std::isfinite(start)) return refuse(Reason::not_finite);
  Eigen::Matrix<double, 6, 3> rows;  // transposed
  rows.col(0) << 1.0, 0.0, 0.0, 0.0, 1.0, -1.0;
  rows.col(1) << 0.0, 1.0, 0.0, -1.0, 0.0, start;
  rows.col(2) << 0.0, 0.0, 1.0, 1.0, -start, 0.0;
  const Vec3 right(figures.mean, 0.0, 0.0);
  const Mat3 gram = rows.transpose() * rows;
  out.rank = static_cast<int>(Eigen::FullPivLU<Mat3>(gram).rank());
  out.least = rows * (gram.inverse() * right);
  return {};
}

}  // namespace volcomp
