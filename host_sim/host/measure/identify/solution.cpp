#include "host_sim/host/measure/identify/solution.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::host::identify {
namespace {

constexpr double kAngleCounts_mm = 300.0;

// Huber's weights of the readings: 1 within 2.5 times their robust spread.
class Weights {
 public:
  Weights(const Equations& equations, const Estimate& e) {
    std::vector<double> sizes;
    equations.visit_readings(e, [&](const ReadingPlace&, const VectorXd&, double residual) {
      sizes.push_back(std::abs(residual));
    });
    spread_ = std::max(1.0, 1.4826 * median(sizes));
  }
  Weights() = default;

  [[nodiscard]] double of(double residual) const {
    constexpr double kBend = 2.5;
    const double size = std::abs(residual) / spread_;
    return size > kBend ? kBend / size : 1.0;
  }
  [[nodiscard]] bool outside(double residual) const {
    constexpr double kOutside = 5.0;
    return std::abs(residual) > kOutside * spread_;
  }

 private:
  double spread_ = std::numeric_limits<double>::infinity();
};

Triangle weighted_triangle(const Equations& equations, const Estimate& e, const Weights& weights,
                           const KnownBefore& known) {
  Triangle triangle(equations.unknowns().size());
  equations.visit_readings(e,
                           [&](const ReadingPlace& /*at*/, const VectorXd& row, double residual) {
                             const double root = std::sqrt(weights.of(residual));
                             triangle.add(root * row, root * residual);
                           });
  equations.visit_known(e, known,
                        [&](const VectorXd& row, double residual) { triangle.add(row, residual); });
  triangle.finish();
  return triangle;
}

double largest_step(const Unknowns& unknowns, const VectorXd& step) {
  double largest = 0.0;
  for (Index i = 0; i < step.size(); ++i)
    largest = std::max(largest, std::abs(step(i)) * (unknowns.is_angle(i) ? kAngleCounts_mm : 1.0));
  return largest;
}

void judge(const Equations& equations, const Weights& weights, Solution& s) {
  s.chi2 = 0.0;
  equations.visit_readings(s.estimate,
                           [&](const ReadingPlace& at, const VectorXd& /*row*/, double residual) {
                             s.chi2 += weights.of(residual) * residual * residual;
                             if (weights.outside(residual)) s.outliers.push_back(at);
                           });
  equations.visit_known(s.estimate, {}, [&](const VectorXd& /*row*/, double residual) {
    s.chi2 += residual * residual;
  });
  s.dof = s.triangle.rows() - equations.unknowns().size();
  s.converged = s.converged && std::isfinite(s.chi2);
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Triangle triangle_at(const Equations& equations, const Estimate& e, const KnownBefore& known) {
  return weighted_triangle(equations, e, Weights(), known);
}

Solution solve_from(const Equations& equations, const Estimate& start, bool robust) {
  const int most_steps = robust ? 200 : 30;
  const double small = robust ? 1e-8 : 1e-10;
  Solution s{start, Triangle(0), 0.0, 0, 0, false, robust, {}};
  Weights weights;
  while (s.steps < most_steps && !s.converged) {
    if (robust && s.steps > 0) weights = Weights(equations, s.estimate);
    s.triangle = weighted_triangle(equations, s.estimate, weights, {});
    const VectorXd step = s.triangle.solve();
    equations.move(step, s.estimate);
    ++s.steps;
    if (!step.allFinite()) break;
    s.converged = largest_step(equations.unknowns(), step) < small;
  }
  judge(equations, robust ? Weights(equations, s.estimate) : Weights(), s);
  return s;
}

Solution solve(const Equations& equations, bool robust) {
  return solve_from(equations, equations.start(), robust);
}

}  // namespace volcomp::host::identify
