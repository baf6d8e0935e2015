#include "host_sim/host/measure/identify/refusal_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/consistency.hpp"

namespace volcomp::host::identify {
namespace {

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

}  // namespace

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

}  // namespace volcomp::host::identify
