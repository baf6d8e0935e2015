#include "host_sim/host/measure/identify/found_document.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/error_functions.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

std::string letter_of(const MeasurementPlan& plan, std::size_t axis) {
  std::string letter;
  letter = plan.machine.axes[axis].letter;
  return letter;
}

json grid_axis(const MeasurementPlan& plan, std::size_t axis, const std::vector<double>& values) {
  return {{"label", letter_of(plan, axis)}, {"unit", "mm"}, {"values", values}};
}

json volume_map_of(const MeasurementPlan& plan, const VolumeSection& section) {
  json u = json::array();
  for (const std::vector<double>& row : section.u)
    u.push_back(scaled(row, kCover * kUmPerMm));
  const std::string right = letter_of(plan, section.right);
  const std::string up = letter_of(plan, section.up);
  std::string others;
  for (std::size_t a = 0; a < plan.machine.axes.size(); ++a) {
    if (a == section.right || a == section.up) continue;
    others += fmt::format("{}{} {}", others.empty() ? "" : ", ", letter_of(plan, a),
                          plan.problem.is_slide(a) ? "in the middle" : "at its reference");
  }
  return with_id(fmt::format("volume-{}{}", right, up),
                 {{"type", "heatmap"},
                  {"title", fmt::format("Uncertainty over {} and {}", right, up)},
                  {"x", grid_axis(plan, section.right, section.column)},
                  {"y", grid_axis(plan, section.up, section.row)},
                  {"z", {{"label", "U (k = 2)"}, {"unit", "µm"}, {"values", std::move(u)}}}},
                 fmt::format("Expanded uncertainty of the error of the functional point, beside "
                             "the best rigid motion over all travels{}{}.",
                             others.empty() ? "" : "; ", others));
}

}  // namespace

json function_curves(const MeasurementPlan& plan, const std::vector<FoundFunction>& functions,
                     const std::string& note) {
  std::vector<ErrorCurves> curves;
  for (const FoundFunction& f : functions) {
    const AxisFile& axis = plan.machine.axes[f.quantity.axis];
    if (curves.empty() || curves.back().letter != axis.letter) {
      const std::vector<ErrorMotion> none(f.at.size(), ErrorMotion::Zero());
      curves.push_back({axis.letter, axis.rotary, f.at, none, none, {}});
    }
    ErrorCurves& c = curves.back();
    c.known.at(f.quantity.channel) = true;
    for (std::size_t k = 0; k < f.value.size(); ++k) {
      const auto channel = static_cast<Eigen::Index>(f.quantity.channel);
      c.value[k](channel) = f.value[k].value;
      c.half_width[k](channel) = kCover * f.value[k].u;
    }
  }
  return error_functions_group("Error functions", curves, note);
}

json volume_maps(const MeasurementPlan& plan, const std::vector<VolumeSection>& sections) {
  json maps = json::array();
  for (const VolumeSection& section : sections)
    maps.push_back(volume_map_of(plan, section));
  return maps;
}

json weakest_table(const MeasurementPlan& plan, const std::vector<WeakValue>& weakest) {
  json rows = json::array();
  for (const WeakValue& w : weakest) {
    const AxisFile& axis = plan.machine.axes[w.quantity.axis];
    const bool function = w.quantity.kind == QuantityKind::function;
    rows.push_back(json::array(
        {w.quantity.name,
         function
             ? json(fmt::format("{} {:.4g} {}", axis.letter, axis.rotary ? kDegPerRad * w.at : w.at,
                                axis.rotary ? "deg" : "mm"))
             : json(),
         kCover * shown(w.quantity, w.u), shown_unit(w.quantity), w.times, w.with, w.correlation}));
  }
  return with_id(
      "weakest",
      table_section("Known least",
                    {plain_column("value"), plain_column("at"), column("U (k = 2)", "", 2),
                     plain_column(""), column("over the median", "", 1),
                     plain_column("correlated most with"), column("correlation", "", 2)},
                    rows),
      "Values whose uncertainty is largest against the median of their kind, lengths or angles, "
      "and what the readings tell them apart from least. Readings in which these two differ help "
      "most.");
}

}  // namespace volcomp::host::identify
