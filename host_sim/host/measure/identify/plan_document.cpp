#include "host_sim/host/measure/identify/plan_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/found_document.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/measure/identify/plan_picture.hpp"
#include "host_sim/host/measure/identify/plan_report.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

Verdict verdict_of(const PlanPrediction& predicted) {
  if (!predicted.solvable)
    return {false, fmt::format("The plan does not determine everything. Not seen: {}.",
                               fmt::join(predicted.rank.unseen, ", "))};
  return {true, fmt::format("The plan determines everything. Functional point over the travels: "
                            "u {:.2f} µm rms; on the average {:.2f} µm are left at 95 % of the "
                            "places.",
                            kUmPerMm * predicted.volume.rms, kUmPerMm * predicted.volume.p95)};
}

json order_chart(const MeasurementPlan& plan, const PlanPrediction& predicted) {
  std::vector<std::string> names;
  for (const std::size_t k : predicted.order)
    names.push_back(plan.problem.setups[k].name);
  return bar_chart("order", "What each set-up adds", names, axis_label("u left, rms", "µm"),
                   json::array({bars_of("u left", scaled(predicted.rms_u, kUmPerMm))}),
                   "Standard uncertainty of the functional point over the travels, beside the best "
                   "rigid motion, with this set-up and all to its left, each chosen because it "
                   "adds most. What is not seen yet counts with 20 µm and 50 µrad.");
}

}  // namespace

json plan_document(const MeasurementPlan& plan, const PlanPrediction& predicted,
                   const RunContext& run, Origins origins) {
  origins.data = "predicted from the plan: nothing was measured";
  ReportParts parts;
  parts.title = "What a plan for " + plan.machine.name + " will see";
  parts.subtitle = fmt::format("{} set-ups, {} rows, {} unknowns", plan.problem.setups.size(),
                               predicted.rows, predicted.unknowns);
  parts.verdict = verdict_of(predicted);
  if (predicted.solvable) {
    if (!predicted.functions.empty())
      parts.plots.push_back(function_curves(
          plan, predicted.functions,
          "Bands: U (k = 2), twice the standard uncertainty that measuring will leave, about "
          "zero."));
    for (json& map : volume_maps(plan, predicted.sections))
      parts.plots.push_back(std::move(map));
  }
  parts.plots.push_back(order_chart(plan, predicted));
  parts.plots.push_back(plan_picture(plan));
  parts.details = plan_prediction_sections(plan, predicted);
  if (predicted.solvable) parts.details.push_back(weakest_table(plan, predicted.weakest));
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

}  // namespace volcomp::host::identify
