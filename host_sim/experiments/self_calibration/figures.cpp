#include "host_sim/experiments/self_calibration/figures.hpp"

#include <fmt/format.h>

#include "host_sim/host/machine/chain_string.hpp"

namespace volcomp::self_calibration {
namespace {

using nlohmann::json;

json residual_json(const VolumeResidual& left) {
  return {{"rms_um", left.rms}, {"p95_um", left.p95}, {"max_um", left.max}};
}

}  // namespace

double misfit(const Result& r) {
  const host::identify::Consistency& fit = r.found.consistency;
  return fit.chi2 / static_cast<double>(fit.dof);
}

std::vector<host::BeforeAfter> judged_figures(const Result& r) {
  const VolumeResidual before = r.without_unmodelled_reversal(r.before);
  const VolumeResidual after = r.without_unmodelled_reversal(r.after);
  const VolumeResidual measured_before = r.residual(r.before);
  const VolumeResidual measured_after = r.residual(r.after);
  std::vector<host::BeforeAfter> lines{{"volume, 95 % of the places", before.p95, after.p95},
                                       {"volume, worst place", before.max, after.max},
                                       {"volume, root mean square", before.rms, after.rms}};
  if (!r.models_reversal()) {
    lines.push_back(
        {"the same with reversal, 95 % of the places", measured_before.p95, measured_after.p95});
    lines.push_back(
        {"the same with reversal, worst place", measured_before.max, measured_after.max});
  }
  lines.push_back({"diagonals", r.before.lines_max_um(), r.after.lines_max_um()});
  if (!r.before.sphere.empty())
    lines.push_back({"ball on the table", r.sphere_without_unmodelled_reversal_um(r.before),
                     r.sphere_without_unmodelled_reversal_um(r.after)});
  if (!r.before.sphere.empty() && !r.models_reversal())
    lines.push_back(
        {"the same with reversal", r.before.sphere_um().max_um, r.after.sphere_um().max_um});
  return lines;
}

host::Verdict verdict(const Result& r) {
  const VolumeResidual before = r.without_unmodelled_reversal(r.before);
  const VolumeResidual after = r.without_unmodelled_reversal(r.after);
  const VolumeResidual predicted = r.predicted;
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
           {"before", residual_json(r.without_unmodelled_reversal(r.before))},
           {"after", residual_json(r.without_unmodelled_reversal(r.after))},
           {"with_reversal",
            {{"before", residual_json(r.residual(r.before))},
             {"after", residual_json(r.residual(r.after))}}},
           {"predicted", residual_json(r.predicted)},
           {"coverage", r.coverage()},
           {"diagonals_before_um", r.before.lines_max_um()},
           {"diagonals_after_um", r.after.lines_max_um()},
           {"ok", verdict(r).ok}};
  if (!r.before.sphere.empty()) {
    out["sphere_before_um"] = r.sphere_without_unmodelled_reversal_um(r.before);
    out["sphere_after_um"] = r.sphere_without_unmodelled_reversal_um(r.after);
  }
  return out;
}

}  // namespace volcomp::self_calibration
