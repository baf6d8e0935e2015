#include "host_sim/experiments/self_calibration/figures.hpp"

#include <fmt/format.h>

#include "host_sim/host/machine/chain_string.hpp"

namespace volcomp::self_calibration {
namespace {

using nlohmann::json;

json left_json(const Left& left) {
  return {{"rms_um", left.rms}, {"p95_um", left.p95}, {"max_um", left.max}};
}

}  // namespace

double misfit(const Result& r) {
  const host::identify::Consistency& fit = r.found.consistency;
  return fit.chi2 / static_cast<double>(fit.dof);
}

std::vector<host::BeforeAfter> judged_figures(const Result& r) {
  const Left before = r.left_of_known(r.before);
  const Left after = r.left_of_known(r.after);
  const Left measured_before = r.left(r.before);
  const Left measured_after = r.left(r.after);
  std::vector<host::BeforeAfter> lines{{"volume, 95 % of the places", before.p95, after.p95},
                                       {"volume, worst place", before.max, after.max},
                                       {"volume, root mean square", before.rms, after.rms}};
  if (!r.knows_reversal()) {
    lines.push_back(
        {"the same with reversal, 95 % of the places", measured_before.p95, measured_after.p95});
    lines.push_back(
        {"the same with reversal, worst place", measured_before.max, measured_after.max});
  }
  lines.push_back({"diagonals", r.before.lines_max_um(), r.after.lines_max_um()});
  if (!r.before.sphere.empty())
    lines.push_back(
        {"ball on the table", r.sphere_of_known_um(r.before), r.sphere_of_known_um(r.after)});
  if (!r.before.sphere.empty() && !r.knows_reversal())
    lines.push_back(
        {"the same with reversal", r.before.sphere_um().max_um, r.after.sphere_um().max_um});
  return lines;
}

host::Verdict verdict(const Result& r) {
  const Left before = r.left_of_known(r.before);
  const Left after = r.left_of_known(r.after);
  const Left predicted = r.predicted();
  const bool seen = r.found.rank.nullity_functions == r.plan.problem.model.gauge.size();
  const bool ok = after.p95 <= kOfPrediction * predicted.p95 &&
                  after.max <= kOfBefore * before.max && seen && misfit(r) < kChiSquareOfDof;
  return {ok, fmt::format("95 % of the volume are within {:.2f} um, predicted {:.2f} (at most {:g} "
                          "times that wanted); the worst place has {:.2f} um of {:.1f} (at most "
                          "{:g} of it wanted); chi-square {:.2f} of its degrees of freedom{}.",
                          after.p95, predicted.p95, kOfPrediction, after.max, before.max, kOfBefore,
                          misfit(r), seen ? "" : "; not every error was seen")};
}

json figures(const Result& r) {
  json out{{"machine", r.plan.machine.name},
           {"chain", host::chain_text(r.plan.machine.chain)},
           {"plan", r.plan.path},
           {"seed", r.options.seed},
           {"noise", r.options.noise},
           {"touches", r.touches},
           {"unknowns", r.found.unknowns},
           {"rows", r.found.rows},
           {"chi2", r.found.consistency.chi2},
           {"dof", r.found.consistency.dof},
           {"largest_refinement_um", 1e3 * r.found.largest_refinement},
           {"places", r.before.place.size()},
           {"before", left_json(r.left_of_known(r.before))},
           {"after", left_json(r.left_of_known(r.after))},
           {"with_reversal",
            {{"before", left_json(r.left(r.before))}, {"after", left_json(r.left(r.after))}}},
           {"predicted", left_json(r.predicted())},
           {"diagonals_before_um", r.before.lines_max_um()},
           {"diagonals_after_um", r.after.lines_max_um()},
           {"ok", verdict(r).ok}};
  if (!r.before.sphere.empty()) {
    out["sphere_before_um"] = r.sphere_of_known_um(r.before);
    out["sphere_after_um"] = r.sphere_of_known_um(r.after);
  }
  return out;
}

}  // namespace volcomp::self_calibration
