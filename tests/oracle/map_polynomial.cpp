#include "tests/oracle/map_polynomial.hpp"

#include <cmath>

#include "comp/metrology/fits/pseudo_inverse.hpp"

namespace volcomp::test {
namespace {

constexpr int kTerms = static_cast<int>(kMaxMapTerms);
constexpr double kVoid = 1e-10;  // eigenvalues of the normal matrix below this share are rounding

using Terms = Eigen::Matrix<double, kTerms, 1>;
using Normal = Eigen::Matrix<double, kTerms, kTerms>;

int terms_of(int degree) { return (degree + 1) * (degree + 2) / 2; }

// 1, x, y, x², xy, y² …; zero beyond the degree.
Terms powers(double x, double y, int degree) {
  std::array<double, kMaxMapDegree + 1> xs{1.0};
  std::array<double, kMaxMapDegree + 1> ys{1.0};
  for (std::size_t i = 1; i < xs.size(); ++i) {
    xs[i] = xs[i - 1] * x;
    ys[i] = ys[i - 1] * y;
  }
  Terms terms = Terms::Zero();
  Eigen::Index k = 0;
  for (int d = 0; d <= degree; ++d) {
    for (int j = 0; j <= d; ++j)
      terms(k++) = xs[static_cast<std::size_t>(d - j)] * ys[static_cast<std::size_t>(j)];
  }
  return terms;
}

template <class Visit>
void each_cell(const ErrorMap& map, const Visit& visit) {
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column) {
      if (map.has(row, column))
        visit(scaled_row(static_cast<double>(row)), scaled_column(static_cast<double>(column)),
              map.at(row, column));
    }
  }
}

}  // namespace

double MapPolynomial::at(double x, double y) const {
  return powers(x, y, degree).dot(Eigen::Map<const Terms>(coefficient.data()));
}

Status fit_map(const ErrorMap& map, int degree, MapPolynomial& out) {
  if (degree < 0 || degree > kMaxMapDegree) {
    Where where;
    where.field = "degree";
    where.value = degree;
    where.has_value = true;
    return refuse(Reason::bad_setting, where);
  }
  Normal normal = Normal::Zero();
  Terms right = Terms::Zero();
  each_cell(map, [&](double x, double y, double value) {
    const Terms row = powers(x, y, degree);
    normal += row * row.transpose();
    right += value * row;
  });
  const auto cells = static_cast<double>(kGridCells - map.missing());
  for (int i = terms_of(degree); i < kTerms; ++i)
    normal(i, i) = cells;  // terms that do not take part stay zero
  const LeastSquares<kTerms> solution = pseudo_solve<kTerms>(normal, right, kVoid);
  if (solution.rank < kTerms) {
    Where where;
    where.count = static_cast<int>(cells);
    return refuse(Reason::surface_not_determined, where);
  }
  MapPolynomial fit;
  fit.degree = degree;
  Eigen::Map<Terms>(fit.coefficient.data()) = solution.x;
  double squares = 0.0;
  each_cell(map, [&](double x, double y, double value) {
    const double left = value - fit.at(x, y);
    squares += left * left;
  });
  fit.rms = std::sqrt(squares / cells);
  out = fit;
  return {};
}

}  // namespace volcomp::test
