#include "host_sim/host/measure/identify/identification.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/touch_centre.hpp"
#include "host_sim/host/measure/identify/volume.hpp"

namespace volcomp::host::identify {
namespace {

// Place, reason, and what is not seen.
std::string described(const Refusal& refusal) {
  std::string place;
  const auto add = [&](const std::string& part) { place += place.empty() ? part : ", " + part; };
  if (!refusal.setup.empty()) add(fmt::format("set-up \"{}\"", refusal.setup));
  if (!refusal.stylus.empty()) add(fmt::format("stylus \"{}\"", refusal.stylus));
  if (!refusal.artefact.empty()) add(fmt::format("artefact \"{}\"", refusal.artefact));
  if (!refusal.axis.empty()) add("axis " + refusal.axis);
  if (!refusal.field.empty()) add("'" + refusal.field + "'");
  if (refusal.index) add(fmt::format("observation {}", *refusal.index + 1));
  std::string text = fmt::format("{}{}{} [{}]", place, place.empty() ? "" : ": ",
                                 sentence(refusal.reason), code(refusal.reason));
  if (!refusal.names.empty()) text += fmt::format(" Not seen: {}.", fmt::join(refusal.names, ", "));
  return text;
}

// Set-ups without which the rest agrees; where there is none, the one that fits least.
std::vector<std::string> suspects(const Equations& equations, const Solution& solution) {
  const Consistency c = check_consistency(equations, solution);
  std::vector<std::string> names;
  double most = 0.0;
  std::string worst;
  for (std::size_t k = 0; k < c.setups.size(); ++k) {
    const SetUpCheck& s = c.setups[k];
    if (!s.left_out) continue;
    const std::string& name = equations.problem().setups[k].name;
    const double rest = c.chi2 - *s.left_out;
    if (rest <= chi2_limit_99(static_cast<double>(c.dof - *s.left_out_dof))) names.push_back(name);
    if (*s.left_out <= most) continue;
    most = *s.left_out;
    worst = name;
  }
  if (names.empty() && !worst.empty()) names.push_back(worst);
  return names;
}

// The reading that fits least where every set-up has been settled by itself: a wrong name of a
// sphere or a tip, so far off that nothing converges.
std::string least_fitting(const Equations& equations) {
  double most = 0.0;
  ReadingPlace worst;
  equations.visit_readings(equations.start(),
                           [&](const ReadingPlace& at, const VectorXd& /*row*/, double residual) {
                             if (std::abs(residual) <= most) return;
                             most = std::abs(residual);
                             worst = at;
                           });
  return fmt::format(" Observation {} of \"{}\" fits least.", worst.observation + 1,
                     equations.problem().setups[worst.setup].name);
}

void require_good(const MeasurementPlan& plan, const Equations& equations,
                  const Solution& solution) {
  const Refusal refusal = check_solution(solution);
  if (refusal.ok()) return;
  std::string text = fmt::format("{}: {}", plan.path, described(refusal));
  if (refusal.reason == Reason::not_converged) text += least_fitting(equations);
  if (refusal.reason == Reason::contradictory) {
    const std::vector<std::string> names = suspects(equations, solution);
    if (!names.empty())
      text += fmt::format(" The others do not predict \"{}\".", fmt::join(names, "\", \""));
  }
  throw UserError(text);
}

void require_good(const MeasurementPlan& plan, const Refusal& refusal) {
  if (!refusal.ok()) throw UserError(fmt::format("{}: {}", plan.path, described(refusal)));
}

// The van der Corput sequence: evenly over 0…1 for any number of terms.
double evenly(std::size_t n, std::size_t base) {
  double place = 0.0;
  double digit = 1.0;
  for (; n > 0; n /= base) {
    digit /= static_cast<double>(base);
    place += digit * static_cast<double>(n % base);
  }
  return place;
}

// Places spread evenly over the whole travel (J. H. Halton, Numer. Math. 2, 1960).
std::vector<Pose> places_of(const Machine& machine, std::size_t count) {
  constexpr std::array<std::size_t, kMaxAxes> kPrimes{2, 3, 5, 7, 11, 13, 17, 19};
  std::vector<Pose> places(count);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t a = 0; a < machine.chain.axis_count(); ++a) {
      const Travel& travel = machine.travel.at(a);
      places[n].at(a) = travel.lo + (travel.hi - travel.lo) * evenly(n + 1, kPrimes.at(a));
    }
  return places;
}

FoundVolume volume_of(const Equations& equations, const Triangle& triangle) {
  constexpr std::size_t kPlaces = 1000;
  const Machine& machine = equations.problem().machine;
  VolumeUncertainty u = volume_uncertainty(equations, triangle, places_of(machine, kPlaces),
                                           machine.chain.tool_point());
  FoundVolume out;
  out.rms = u.rms_rigid();
  std::sort(u.rigid.begin(), u.rigid.end());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(u.rigid.size())));
  out.p95 = u.rigid[rank - 1];
  out.max = u.rigid.back();
  return out;
}

// Values of rows at an estimate, 0 for a plan, with their uncertainties.
class Values {
 public:
  Values(const Equations& equations, const Triangle& triangle, const VectorXd* x)
      : unknowns_(equations.unknowns()), triangle_(triangle), x_(x) {}

  [[nodiscard]] Measured of(const VectorXd& row) const {
    return {x_ != nullptr ? row.dot(*x_) : 0.0, triangle_.uncertainty(row)};
  }

  [[nodiscard]] std::vector<FoundFunction> functions(const MachineFile& machine) const {
    std::vector<FoundFunction> out;
    for (const Quantity& quantity : unknowns_.quantities()) {
      if (quantity.kind != QuantityKind::function) continue;
      FoundFunction f{quantity, machine.axes[quantity.axis].all_targets(), {}};
      for (const double at : f.at)
        f.value.push_back(of(unknowns_.value_row(quantity, at)));
      out.push_back(std::move(f));
    }
    return out;
  }

  [[nodiscard]] std::vector<FoundValue> singles() const {
    std::vector<FoundValue> out;
    for (const Quantity& quantity : unknowns_.quantities())
      if (quantity.kind != QuantityKind::function)
        out.push_back({quantity, of(unknowns_.value_row(quantity, 0.0))});
    return out;
  }

 private:
  const Unknowns& unknowns_;
  const Triangle& triangle_;
  const VectorXd* x_;
};

// Slope of a straightness over the travel, relative value; none where it is not an unknown.
std::optional<VectorXd> slope_row(const Unknowns& unknowns, const MachineFile& machine, char axis,
                                  std::size_t channel) {
  for (const Quantity& quantity : unknowns.quantities()) {
    const AxisFile& file = machine.axes[quantity.axis];
    if (quantity.kind != QuantityKind::function || quantity.channel != channel ||
        file.letter != axis || file.rotary)
      continue;
    const Travel& travel = unknowns.problem().machine.travel.at(quantity.axis);
    const FunctionBasis basis(travel.lo, travel.hi, travel.periodic, 1);
    const std::vector<double> places = basis.samples();
    const std::vector<double> weights = basis.slope_weights();
    const double side = branch_sign(machine.chain.axis(quantity.axis).branch);
    VectorXd row = VectorXd::Zero(unknowns.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      row += side * weights[k] * unknowns.value_row(quantity, places[k]);
    return row;
  }
  return std::nullopt;
}

// In the datum of Y: SquareDatum, row by row.
std::optional<FoundSquareness> squareness_of(const Unknowns& unknowns, const MachineFile& machine,
                                             const Values& values) {
  const auto slope = [&](char axis, std::size_t channel) {
    return slope_row(unknowns, machine, axis, channel);
  };
  const auto X_y = slope('X', 1);
  const auto X_z = slope('X', 2);
  const auto Y_x = slope('Y', 0);
  const auto Y_z = slope('Y', 2);
  const auto Z_x = slope('Z', 0);
  const auto Z_y = slope('Z', 1);
  if (!X_y || !X_z || !Y_x || !Y_z || !Z_x || !Z_y) return std::nullopt;
  return FoundSquareness{values.of(*X_y + *Y_x), values.of(*Z_x + *X_z), values.of(-*Z_y - *Y_z)};
}

std::vector<Visited> visited_of(const Problem& problem) {
  std::vector<Visited> out;
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    if (problem.model.functions.at(a).segments == 0) continue;
    Visited v{a, HUGE_VAL, -HUGE_VAL};
    for (const SetUp& s : problem.setups) {
      if (s.kind == ObservationKind::runs && s.axis != a) continue;
      for (const Pose& q : s.q) {
        v.lo = std::min(v.lo, q.at(a));
        v.hi = std::max(v.hi, q.at(a));
      }
    }
    out.push_back(v);
  }
  return out;
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

std::unique_ptr<BuiltTables> tables_of(const MeasurementPlan& plan, const Unknowns& unknowns,
                                       const VectorXd& x) {
  std::vector<ErrorTable> tables;
  for (std::size_t a = 0; a < plan.machine.axes.size(); ++a) {
    const AxisFile& axis = plan.machine.axes[a];
    ErrorTable table;
    table.q0 = axis.lo;
    table.knots = axis.targets;
    table.pitch = (axis.hi - axis.lo) / static_cast<double>(axis.targets - 1);
    for (std::size_t i = 0; i < table.knots; ++i) {
      table.forward.at(i) = unknowns.error(a, table.knot(i), 1.0, x);
      table.backward.at(i) = unknowns.error(a, table.knot(i), -1.0, x);
    }
    tables.push_back(table);
  }
  return tables_of_errors(plan.machine, tables);
}

}  // namespace

double FoundFunction::largest_u() const {
  double largest = 0.0;
  for (const Measured& v : value)
    largest = std::max(largest, v.u);
  return largest;
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
  out.squareness = squareness_of(unknowns, plan.machine, values);
  out.volume = volume_of(equations, solution.triangle);
  out.consistency = check_consistency(equations, solution, settings.leave_out);
  out.outliers = solution.outliers;
  out.rank = rank_of(problem);
  out.visited = visited_of(problem);
  out.unknowns = unknowns.size();
  out.rows = solution.triangle.rows();
  out.tables = tables_of(plan, unknowns, solution.estimate.x);
  progress(1.0, "done");
  return out;
}

Foreseen foresee(const MeasurementPlan& plan, const Progress& progress) {
  progress(0.0, "what the plan can see");
  Problem problem = plan.problem;
  for (SetUp& s : problem.setups)
    s.y.clear();
  Foreseen out;
  out.rank = rank_of(problem);
  const Problem consistent = Equations::made_consistent(problem);
  const Equations equations(consistent, true);
  const Triangle triangle = triangle_at(equations, equations.start(), {});
  out.unknowns = equations.unknowns().size();
  out.rows = triangle.rows();
  out.solvable = least_singular(consistent) > kSingularShare;
  if (out.solvable) {
    const Values values(equations, triangle, nullptr);
    out.functions = values.functions(plan.machine);
    out.values = values.singles();
    out.volume = volume_of(equations, triangle);
  }
  progress(0.4, "which set-up adds most");
  constexpr std::size_t kPlaces = 100;  // for every candidate
  const PlanChoice choice =
      choose_setups(consistent, places_of(problem.machine, kPlaces),
                    problem.machine.chain.tool_point(), problem.setups.size());
  out.order = choice.chosen;
  out.rms_u = choice.rms_u;
  progress(1.0, "done");
  return out;
}

}  // namespace volcomp::host::identify
