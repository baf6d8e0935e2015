#include "host_sim/host/measure/identify/plan_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

// Approach, touch, retract.
constexpr double kTouch_s = 5.0;

std::size_t planned_spheres(const MeasurementPlan& plan) {
  std::size_t count = 0;
  for (const SetUp& s : plan.problem.setups)
    if (s.kind == ObservationKind::centre) count += s.q.size();
  return count;
}

}  // namespace

std::vector<std::string> spheres_by_tip(const std::vector<std::string>& spheres) {
  const std::string sphere_word = ": sphere ";
  const std::string tip_word = " with tip ";
  std::vector<std::string> lines;
  std::string last;
  for (const std::string& text : spheres) {
    const std::size_t tip = text.rfind(tip_word);
    const std::size_t sphere = text.rfind(sphere_word, tip);
    const std::size_t number = sphere + sphere_word.size();
    const std::string place = text.substr(0, sphere) + text.substr(tip);
    if (place != last) lines.push_back(place + ": spheres");
    lines.back() += " " + text.substr(number, tip - number);
    last = place;
  }
  return lines;
}

std::string points_csv(const MeasurementPlan& plan) {
  std::string text = "setup,kind,sphere,tip";
  for (const AxisFile& axis : plan.machine.axes)
    text += fmt::format(",{} [{}]", axis.letter, axis.rotary ? "deg" : "mm");
  text += '\n';
  for (const SetUp& s : plan.problem.setups) {
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      const auto stylus = plan.problem.stylus_of(s, i);
      text += fmt::format("{},{},{},{}", s.name, kKindNames.at(static_cast<std::size_t>(s.kind)),
                          s.sphere.empty() ? "" : std::to_string(s.sphere[i]),
                          stylus ? plan.problem.styli[*stylus].name : "");
      for (std::size_t a = 0; a < plan.machine.axes.size(); ++a)
        text +=
            fmt::format(",{:.6f}", (plan.machine.axes[a].rotary ? kDegPerRad : 1.0) * s.q[i].at(a));
      text += '\n';
    }
  }
  return text;
}

json plan_prediction_sections(const MeasurementPlan& plan, const PlanPrediction& predicted) {
  json sections = json::array();
  std::vector<std::string> seen;
  for (const auto& group : predicted.rank.together)
    seen.push_back(group.size() > 1 ? fmt::format("Seen only together: {}", fmt::join(group, ", "))
                                    : fmt::format("Not seen: {}", group.front()));
  const std::size_t gauge = plan.problem.model.gauge.size();
  seen.push_back(fmt::format("{} combinations of errors are not seen, {} are held by the gauge{}",
                             predicted.rank.nullity_functions, gauge,
                             predicted.solvable
                                 ? ": with it and what is known beforehand everything is determined"
                                 : ": the plan is not enough"));
  sections.push_back(text_section("What the plan sees", seen));
  if (predicted.solvable) {
    if (!predicted.functions.empty())
      sections.push_back(function_section(predicted.functions, false));
    if (json values = value_section(predicted.values, predicted.squareness, false);
        !values.is_null())
      sections.push_back(std::move(values));
  }
  json rows = json::array();
  for (std::size_t n = 0; n < predicted.order.size(); ++n) {
    const SetUp& s = plan.problem.setups[predicted.order[n]];
    rows.push_back(json::array({n + 1, s.name, kKindNames.at(static_cast<std::size_t>(s.kind)),
                                s.q.size(), kUmPerMm * predicted.rms_u[n]}));
  }
  sections.push_back(table_section("Set-ups, each adding most to those before",
                                   {plain_column(""), plain_column("set-up"), plain_column("kind"),
                                    plain_column("observations"), column("u left, rms", "µm", 2)},
                                   rows));
  std::vector<std::string> lines;
  for (const std::string& spheres : spheres_by_tip(plan.unreached))
    lines.push_back("out of reach, left out: " + spheres);
  for (const std::string& name : plan.lacking)
    lines.push_back(fmt::format("\"{}\" is planned at usual places: its file is not there", name));
  lines.push_back(fmt::format("{} rows, {} unknowns", predicted.rows, predicted.unknowns));
  if (const std::size_t spheres = planned_spheres(plan); spheres > 0)
    lines.push_back(fmt::format(
        "{} spheres: {} touches of {:g} s, {:.1f} hours", spheres, kTouchesOfSphere * spheres,
        kTouch_s, kTouch_s * static_cast<double>(kTouchesOfSphere * spheres) / 3600.0));
  if (predicted.solvable) lines.push_back(volume_line(predicted.volume));
  sections.push_back(text_section("Extent and uncertainty", lines));
  return sections;
}

std::string plan_prediction_text(const MeasurementPlan& plan, const PlanPrediction& predicted) {
  return text_of_sections(plan_prediction_sections(plan, predicted));
}

json plan_prediction_json(const MeasurementPlan& plan, const PlanPrediction& predicted) {
  json out = plan_json(plan);
  out["unknowns"] = predicted.unknowns;
  out["rows"] = predicted.rows;
  out["solvable"] = predicted.solvable;
  out["nullity_functions"] = predicted.rank.nullity_functions;
  out["unseen"] = predicted.rank.unseen;
  out["together"] = predicted.rank.together;
  out["functions"] = functions_json(plan, predicted.functions);
  out["values"] = values_json(predicted.values);
  out["u_volume"] = predicted.solvable ? volume_json(predicted.volume) : json();
  out["order"] = json::array();
  for (std::size_t n = 0; n < predicted.order.size(); ++n)
    out["order"].push_back({{"setup", plan.problem.setups[predicted.order[n]].name},
                            {"observations", plan.problem.setups[predicted.order[n]].q.size()},
                            {"rms_u_um", kUmPerMm * predicted.rms_u[n]}});
  out["unreached"] = plan.unreached;
  return out;
}

}  // namespace volcomp::host::identify
