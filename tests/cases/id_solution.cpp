// Cases of identification: rank of a plan, estimates with their uncertainty, consistency, planning,
// refusals.

#include <cmath>

#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/consistency.hpp"
#include "host_sim/host/measure/identify/rank.hpp"
#include "host_sim/host/measure/identify/volume.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/id_case.hpp"

namespace volcomp::cases {
namespace {

using namespace host::identify;

json rank(const json& in) {
  const PlanRank rank = rank_of(problem_of(in.at("problem")));
  return {{"unknowns", rank.unknowns}, {"rank", rank.rank},
          {"nullity", rank.nullity},   {"nullity_functions", rank.nullity_functions},
          {"unseen", rank.unseen},     {"together", rank.together}};
}

// By name: functions at every fourth sample, the others as they are. `of`: value of a row.
template <class Value>
json values_json(const Unknowns& unknowns, const Value& of) {
  constexpr std::size_t kEvery = 4;
  json out = json::object();
  for (const Quantity& quantity : unknowns.quantities()) {
    const std::vector<double> places = unknowns.places(quantity);
    const char* const unit = quantity.angular() ? "rad" : "mm";
    if (quantity.kind == QuantityKind::function) {
      json& list = out[quantity.angular() ? "angular" : "linear"][quantity.name];
      for (std::size_t k = 0; k < places.size(); k += kEvery)
        list.push_back(of(unknowns.value_row(quantity, places[k])));
      continue;
    }
    const std::string group = quantity.kind == QuantityKind::reversal   ? "reversal_"
                              : quantity.kind == QuantityKind::location ? "location_"
                                                                        : "constant_";
    std::string name = quantity.name;
    if (quantity.kind == QuantityKind::reversal) name = name.substr(4);
    out[group + unit][name] = of(unknowns.value_row(quantity, places[0]));
  }
  return out;
}

json estimate_json(const Equations& equations, const Solution& solution) {
  return values_json(equations.unknowns(),
                     [&](const VectorXd& row) { return solution.value(row); });
}

json solve_exact(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  const Equations equations(problem, true);
  return estimate_json(equations, solve(equations, in.value("robust", false)));
}

json solve_noisy(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  const Equations equations(problem, true);
  const Solution solution = solve(equations, in.value("robust", false));
  json out = estimate_json(equations, solution);
  out["chi2"] = solution.chi2;
  out["dof"] = solution.dof;
  out["u"] = values_json(equations.unknowns(),
                         [&](const VectorXd& row) { return solution.triangle.uncertainty(row); });
  return out;
}

json solve_robust(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  const Equations equations(problem, true);
  const Solution solution = solve(equations, true);
  json out = estimate_json(equations, solution);
  out["chi2"] = solution.chi2;
  out["dof"] = solution.dof;
  out["outliers"] = json::array();
  for (const ReadingPlace& o : solution.outliers)
    out["outliers"].push_back({o.setup, o.observation});
  return out;
}

json consistency(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  const Equations equations(problem, true);
  const Consistency c = check_consistency(equations, solve(equations, false));
  json out = {{"chi2", c.chi2},
              {"dof", c.dof},
              {"chi2_99", c.chi2_99},
              {"consistent", c.good()},
              {"setups", json::array()}};
  for (std::size_t k = 0; k < c.setups.size(); ++k) {
    const SetUpCheck& s = c.setups[k];
    out["setups"].push_back({{"name", problem.setups[k].name},
                             {"rows", s.rows},
                             {"redundancy", s.redundancy},
                             {"chi2", s.chi2},
                             {"leave_out", s.left_out ? json(*s.left_out) : json()},
                             {"leave_out_dof", s.left_out_dof ? json(*s.left_out_dof) : json()}});
  }
  return out;
}

json predict(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  const Equations equations(problem, true);
  const Triangle triangle = triangle_at(equations, equations.start(), {});
  const VolumeUncertainty u =
      volume_uncertainty(equations, triangle, poses_of(in.at("grid")), vector3(in.at("point")));
  return {{"u", values_json(equations.unknowns(),
                            [&](const VectorXd& row) { return triangle.uncertainty(row); })},
          {"u_datum", u.datum},
          {"u_rigid", u.rigid}};
}

json choose(const json& in) {
  const PlanChoice choice =
      choose_setups(problem_of(in.at("problem")), poses_of(in.at("grid")), vector3(in.at("point")),
                    in.at("count").get<std::size_t>());
  return {{"chosen", choice.chosen}, {"rms_u", choice.rms_u}};
}

void require_good(const Refusal& r) {
  if (r.ok()) return;
  json where = json::object();
  if (!r.setup.empty()) where["setup"] = r.setup;
  if (!r.stylus.empty()) where["stylus"] = r.stylus;
  if (!r.artefact.empty()) where["artefact"] = r.artefact;
  if (!r.field.empty()) where["field"] = r.field;
  if (!r.axis.empty()) where["axis"] = r.axis;
  if (r.index) where["index"] = *r.index;
  if (r.nullity_functions) where["nullity_functions"] = *r.nullity_functions;
  throw Refused(refuse(r.reason), where);
}

json refused(const json& in) {
  const Problem problem = problem_of(in.at("problem"));
  require_good(check_problem(problem));
  const Equations equations(problem, true);
  require_good(check_solution(solve(equations, in.value("robust", false))));
  return estimate_json(equations, solve(equations, false));
}

}  // namespace

void add_id_solution(Handlers& handlers) {
  handlers["id.rank"] = rank;
  handlers["id.solve"] = solve_exact;
  handlers["id.solve_noisy"] = solve_noisy;
  handlers["id.solve_robust"] = solve_robust;
  handlers["id.consistency"] = consistency;
  handlers["id.predict"] = predict;
  handlers["id.choose"] = choose;
  handlers["id.refuse"] = refused;
}

}  // namespace volcomp::cases
