#include "host_sim/host/measure/identify/identification.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/refusal_text.hpp"
#include "host_sim/host/measure/identify/touch_centre.hpp"

namespace volcomp::host::identify {
namespace {

std::vector<Visited> visited_of(const Problem& problem) {
  std::vector<Visited> out;
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    if (problem.model.functions.at(a).segments == 0) continue;
    if (const auto range = problem.range_of(a)) out.push_back({a, range->lo, range->hi});
  }
  return out;
}

std::vector<FoundStylus> styli_of(const Unknowns& unknowns, const VectorXd& x) {
  const std::vector<Stylus>& all = unknowns.problem().styli;
  std::vector<FoundStylus> found;
  for (std::size_t s = 0; s < all.size(); ++s)
    if (const auto first = unknowns.stylus(s))
      found.push_back({s, x.segment<3>(*first), all[s].place.value_or(kFree)});
  return found;
}

// Centres as found by a machine with the errors of the estimate; how far the farthest has moved.
double refine_centres(const MeasurementPlan& plan, const Equations& equations, const VectorXd& x,
                      Problem& problem) {
  const Unknowns& unknowns = equations.unknowns();
  const MachineChain& chain = problem.machine.chain;
  double moved = 0.0;
  for (std::size_t k = 0; k < problem.setups.size(); ++k) {
    SetUp& s = problem.setups[k];
    for (std::size_t i = 0; i < plan.touched[k].size(); ++i) {
      const TouchedSphere& touched = plan.touched[k][i];
      std::vector<ErrorSet> errors;
      for (std::size_t t = 0; t < touched.q.size(); ++t)
        errors.push_back(unknowns.errors(touched.q[t], touched.d[t], x));
      Vec3 centre;
      require(refined_centre(chain, problem.styli[s.stylus[i]].offset, touched.q, errors, s.q[i],
                             unknowns.errors(s.q[i], s.d[i], x), centre),
              s.name);
      for (Index c = 0; c < 3; ++c) {
        double& y = s.y[3 * i + static_cast<std::size_t>(c)];
        moved = std::max(moved, std::abs(centre(c) - y));
        y = centre(c);
      }
    }
  }
  return moved;
}

std::vector<Residual> residuals_of(const Equations& equations, const Estimate& estimate) {
  std::vector<Residual> out;
  equations.visit_readings(estimate,
                           [&](const ReadingPlace& of, const VectorXd& /*row*/, double residual) {
                             out.push_back({of, residual});
                           });
  return out;
}

}  // namespace

std::unique_ptr<BuiltTables> tables_of_estimate(const MachineFile& machine,
                                                const Unknowns& unknowns, const VectorXd& x,
                                                std::size_t knots) {
  std::vector<ErrorTable> tables;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    ErrorTable table = table_at_targets(machine.axes[a]);
    for (std::size_t i = 0; i < table.knots; ++i) {
      table.forward.at(i) = unknowns.error(a, table.knot(i), 1.0, x);
      table.backward.at(i) = unknowns.error(a, table.knot(i), -1.0, x);
    }
    tables.push_back(table);
  }
  return tables_of_errors(machine, tables, knots);
}

Identified identify(const MeasurementPlan& plan, const IdentifySettings& settings,
                    const Progress& progress) {
  constexpr int kMostRounds = 10;
  constexpr double kSettled_mm = 1e-5;
  progress(0.0, "checking what can be seen");
  Problem problem = plan.problem;
  require_good(plan, check_problem(problem));
  const Equations equations(problem, true);
  progress(0.3, "solving");
  Solution solution = solve(equations, settings.robust);
  require_good(plan, equations, solution);
  Identified out;
  out.robust = settings.robust;
  const bool has_centres = std::any_of(plan.touched.begin(), plan.touched.end(),
                                       [](const auto& list) { return !list.empty(); });
  double moved = has_centres ? HUGE_VAL : 0.0;
  while (moved > kSettled_mm && out.refinements < kMostRounds) {
    progress(0.5, "refining the centres of spheres");
    moved = refine_centres(plan, equations, solution.estimate.x, problem);
    out.largest_refinement = std::max(out.largest_refinement, moved);
    ++out.refinements;
    solution = solve_from(equations, solution.estimate, settings.robust);
    require_good(plan, equations, solution);
  }
  progress(0.6, settings.leave_out ? "leaving out each set-up" : "uncertainty");
  const Unknowns& unknowns = equations.unknowns();
  const Values values(equations, solution.triangle, &solution.estimate.x);
  out.functions = values.functions(plan.machine);
  out.values = values.singles();
  out.squareness = values.squareness(plan.machine);
  out.styli = styli_of(unknowns, solution.estimate.x);
  out.volume = volume_of(equations, solution.triangle);
  out.sections = volume_sections(equations, solution.triangle);
  out.weakest = weakest_values(equations, solution.triangle, plan.machine, kWeakest);
  out.residuals = residuals_of(equations, solution.estimate);
  out.consistency = check_consistency(equations, solution, settings.leave_out);
  out.outliers = solution.outliers;
  out.rank = rank_of(problem);
  out.visited = visited_of(problem);
  out.unknowns = unknowns.size();
  out.rows = solution.triangle.rows();
  out.tables = tables_of_estimate(plan.machine, unknowns, solution.estimate.x);
  progress(1.0, "done");
  return out;
}

}  // namespace volcomp::host::identify
