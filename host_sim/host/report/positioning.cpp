#include "host_sim/host/report/positioning.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

double scale_of(const Positioning& axis) { return axis.rotary ? kUradPerRad : kUmPerMm; }

DirectionRuns direction(const std::vector<std::vector<double>>& runs, std::size_t targets) {
  DirectionRuns d;
  const auto n = static_cast<double>(runs.size());
  for (std::size_t t = 0; t < targets; ++t) {
    double sum = 0.0;
    for (const auto& run : runs)
      sum += run.at(t);
    const double mean = sum / n;
    double squares = 0.0;
    for (const auto& run : runs)
      squares += (run[t] - mean) * (run[t] - mean);
    d.mean.push_back(mean);
    d.deviation.push_back(runs.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0);
  }
  return d;
}

json direction_json(const DirectionRuns& d, double scale) {
  return {{"mean", scaled(d.mean, scale)}, {"s", scaled(d.deviation, scale)}};
}

json figures_json(const Iso230Figures& f, double scale) {
  return {{"A", scale * f.A},
          {"R", scale * f.R},
          {"E", scale * f.E},
          {"B", scale * f.B},
          {"M", scale * f.M}};
}

// The plots of an axis side by side, axes in the order they were measured in.
std::vector<Positioning> by_axis(const std::vector<Positioning>& axes) {
  std::vector<Positioning> sorted;
  const auto shown = [&sorted](char letter) {
    return std::any_of(sorted.begin(), sorted.end(),
                       [letter](const Positioning& axis) { return axis.letter == letter; });
  };
  for (const Positioning& first : axes) {
    if (shown(first.letter)) continue;
    std::copy_if(axes.begin(), axes.end(), std::back_inserter(sorted),
                 [&first](const Positioning& axis) { return axis.letter == first.letter; });
  }
  return sorted;
}

json plot(const Positioning& axis) {
  const double scale = scale_of(axis);
  return {{"type", "iso230_2"},
          {"id", fmt::format("positioning-{}-{}", axis.letter, axis.when)},
          {"title", fmt::format("{}, {}", axis.letter, axis.when)},
          {"x", axis_label("position", axis.rotary ? "deg" : "mm")},
          {"y", axis_label("deviation", axis.rotary ? "µrad" : "µm")},
          {"positions", axis.rotary ? scaled(axis.at, kDegPerRad) : axis.at},
          {"up", direction_json(axis.up, scale)},
          {"down", direction_json(axis.down, scale)},
          {"figures", figures_json(axis.figures, scale)}};
}

}  // namespace

Positioning evaluate_positioning(char letter, bool rotary, std::string when, std::vector<double> at,
                                 const std::vector<std::vector<double>>& up,
                                 const std::vector<std::vector<double>>& down) {
  Positioning p;
  p.letter = letter;
  p.rotary = rotary;
  p.when = std::move(when);
  p.up = direction(up, at.size());
  p.down = direction(down, at.size());
  p.at = std::move(at);
  require(iso230_figures({{p.up.mean.data(), p.up.mean.size()},
                          {p.up.deviation.data(), p.up.deviation.size()}},
                         {{p.down.mean.data(), p.down.mean.size()},
                          {p.down.deviation.data(), p.down.deviation.size()}},
                         p.figures),
          fmt::format("positioning of {}", letter));
  return p;
}

json positioning_group(const std::vector<Positioning>& axes, const std::string& note) {
  json charts = json::array();
  for (const Positioning& axis : by_axis(axes))
    charts.push_back(plot(axis));
  const bool one_kind = std::all_of(axes.begin(), axes.end(), [&axes](const Positioning& axis) {
    return axis.rotary == axes.front().rotary;
  });
  return chart_group("positioning", "Positioning after ISO 230-2", charts, note, one_kind);
}

json positioning_table(const std::vector<Positioning>& axes, const std::string& note) {
  json rows = json::array();
  for (const Positioning& axis : by_axis(axes)) {
    const Iso230Figures& f = axis.figures;
    json row = {fmt::format("{}, {}", axis.letter, axis.when)};
    for (const double value : {f.A, f.A_up, f.A_down, f.R, f.R_up, f.R_down, f.E, f.B, f.M})
      row.push_back(scale_of(axis) * value);
    row.push_back(axis.rotary ? "µrad" : "µm");
    rows.push_back(row);
  }
  json columns = json::array({{{"title", "axis"}}});
  for (const char* name : {"A", "A ↑", "A ↓", "R", "R ↑", "R ↓", "E", "B", "M"})
    columns.push_back(column(name, "", 2));
  columns.push_back({{"title", "unit"}});
  return with_id("positioning-figures",
                 table_section("Positioning figures after ISO 230-2", columns, rows), note);
}

}  // namespace volcomp::host
