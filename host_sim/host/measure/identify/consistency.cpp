#include "host_sim/host/measure/identify/consistency.hpp"

#include <cmath>

#include "host_sim/host/measure/identify/rank.hpp"

namespace volcomp::host::identify {
namespace {

void hold_against_rest(const Problem& problem, const Solution& all, std::size_t setup,
                       SetUpCheck& check) {
  if (problem.setups.size() < 2) return;
  Problem rest = problem;
  rest.setups.erase(rest.setups.begin() + static_cast<std::ptrdiff_t>(setup));
  if (!(least_singular(rest) > kSingularShare)) return;
  const Equations equations(rest, true);
  const Solution without = solve(equations, all.robust);
  if (!without.converged) return;
  check.left_out = all.chi2 - without.chi2;
  check.left_out_dof = all.dof - without.dof;
}

}  // namespace

bool SetUpCheck::too_quiet() const {
  constexpr double kEnough = 10.0;
  constexpr double kTenth = 0.01;  // squared
  return redundancy >= kEnough && chi2 < kTenth * redundancy;
}

double chi2_limit_99(double dof) {
  constexpr double kNormal99 = 2.3263478740408408;
  const double part = 2.0 / (9.0 * dof);
  return dof * std::pow(1.0 - part + kNormal99 * std::sqrt(part), 3.0);
}

Consistency check_consistency(const Equations& equations, const Solution& solution,
                              bool leave_out) {
  Consistency out;
  out.chi2 = solution.chi2;
  out.dof = solution.dof;
  out.chi2_99 = chi2_limit_99(static_cast<double>(out.dof));
  out.setups.resize(equations.problem().setups.size());
  equations.visit_readings(solution.estimate,
                           [&](const ReadingPlace& at, const VectorXd& row, double residual) {
                             SetUpCheck& check = out.setups[at.setup];
                             ++check.rows;
                             check.redundancy += 1.0 - solution.triangle.reduced(row).squaredNorm();
                             check.chi2 += residual * residual;
                           });
  for (std::size_t k = 0; leave_out && k < out.setups.size(); ++k)
    hold_against_rest(equations.problem(), solution, k, out.setups[k]);
  return out;
}

}  // namespace volcomp::host::identify
