#include "host_sim/host/measure/identify/plan_prediction.hpp"

#include "host_sim/host/measure/identify/refusal_text.hpp"
#include "host_sim/host/measure/identify/volume.hpp"

namespace volcomp::host::identify {

PlanPrediction predict_plan(const MeasurementPlan& plan, const Progress& progress) {
  progress(0.0, "what the plan can see");
  Problem problem = plan.problem;
  for (SetUp& s : problem.setups)
    s.y.clear();
  PlanPrediction out;
  // What is not seen is told with what is.
  const Refusal refusal = check_problem(problem);
  if (refusal.reason != Reason::not_observable) require_good(plan, refusal);
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
    out.squareness = values.squareness(plan.machine);
    out.volume = volume_of(equations, triangle);
    out.sections = volume_sections(equations, triangle);
    out.weakest = weakest_values(equations, triangle, plan.machine, kWeakest);
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
