#include "host_sim/host/measure/identify/identified_document.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/found_document.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/measure/identify/identified_report.hpp"
#include "host_sim/host/measure/identify/plan_picture.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

Verdict verdict_of(const Identified& found) {
  const Consistency& c = found.consistency;
  return {c.good(),
          fmt::format("The readings {} each other: chi-square {:.1f} of {} degrees of freedom, "
                      "99 % limit {:.1f}. Functional point over the travels: u {:.2f} µm rms.",
                      c.good() ? "agree with" : "contradict", c.chi2, c.dof, c.chi2_99,
                      kUmPerMm * found.volume.rms)};
}

json residual_chart(const MeasurementPlan& plan, const Identified& found) {
  constexpr double kRare = 3.0;  // 3 of 1000 readings are beyond it
  const std::vector<SetUp>& setups = plan.problem.setups;
  std::vector<std::vector<double>> x(setups.size());
  std::vector<std::vector<double>> y(setups.size());
  for (std::size_t n = 0; n < found.residuals.size(); ++n) {
    const Residual& r = found.residuals[n];
    x[r.of.setup].push_back(static_cast<double>(n + 1));
    y[r.of.setup].push_back(r.over_sigma);
  }
  json series = json::array();
  for (std::size_t k = 0; k < setups.size(); ++k)
    series.push_back(points_of(setups[k].name.c_str(), x[k], y[k]));
  json chart = lines_chart("residuals", "Residuals", {{"label", "reading"}, {"digits", 0}},
                           {{"label", "residual / σ"}, {"digits", 2}}, std::move(series),
                           "What the estimate leaves of every reading, over its stated standard "
                           "uncertainty. Of noise as stated 3 of 1000 are beyond ±3.");
  chart["limit"] = {-kRare, kRare};
  return chart;
}

// Null where no set-up could be left out.
json leave_out_chart(const MeasurementPlan& plan, const Identified& found) {
  std::vector<std::string> names;
  std::vector<double> share;
  for (std::size_t k = 0; k < found.consistency.setups.size(); ++k) {
    const SetUpCheck& c = found.consistency.setups[k];
    if (!c.left_out) continue;
    names.push_back(plan.problem.setups[k].name);
    share.push_back(*c.left_out / chi2_limit_99(static_cast<double>(*c.left_out_dof)));
  }
  if (names.empty()) return {};
  json chart = bar_chart("leave-out", "Every set-up against the others", names,
                         {{"label", "chi-square / 99 % limit"}, {"digits", 2}},
                         json::array({bars_of("chi-square without it less", share)}),
                         "By how much chi-square falls without a set-up, over its 99 % limit: "
                         "beyond 1 the others do not predict it.");
  chart["limit"] = 1.0;
  return chart;
}

}  // namespace

json identified_plots(const MeasurementPlan& plan, const Identified& found) {
  json plots = json::array();
  if (!found.functions.empty())
    plots.push_back(function_curves(
        plan, found.functions,
        "Body, moving side; mean of the two directions. Bands: U (k = 2), twice the standard "
        "uncertainty."));
  for (json& map : volume_maps(plan, found.sections))
    plots.push_back(std::move(map));
  plots.push_back(residual_chart(plan, found));
  if (json chart = leave_out_chart(plan, found); !chart.is_null())
    plots.push_back(std::move(chart));
  plots.push_back(plan_picture(plan));
  return plots;
}

json identified_details(const MeasurementPlan& plan, const Identified& found) {
  json details = identified_sections(plan, found);
  details.push_back(weakest_table(plan, found.weakest));
  return details;
}

json identified_document(const MeasurementPlan& plan, const Identified& found,
                         const RunContext& run, Origins origins) {
  origins.data = "measured: what the files hold";
  ReportParts parts;
  parts.title = "Errors of " + plan.machine.name;
  parts.subtitle =
      fmt::format("{} set-ups, {} rows, {} unknowns; {:g} °C", plan.problem.setups.size(),
                  found.rows, found.unknowns, plan.temperature_C);
  parts.verdict = verdict_of(found);
  parts.plots = identified_plots(plan, found);
  parts.details = identified_details(plan, found);
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

}  // namespace volcomp::host::identify
