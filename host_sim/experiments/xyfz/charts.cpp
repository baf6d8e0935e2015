#include "host_sim/experiments/xyfz/charts.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/error_functions.hpp"
#include "host_sim/host/report/volume_map.hpp"

namespace volcomp::xyfz {

using nlohmann::json;

namespace {

// Bands where there is noise and the knots are the targets: ±2 standard deviations of the mean of
// a reading upwards and one downwards.
host::ErrorCurves curves_of(const BuiltTable& built, char letter) {
  host::ErrorCurves curves;
  curves.letter = letter;
  const bool banded = built.targets == built.table.knots && !built.s_up.front().isZero();
  for (std::size_t i = 0; i < built.table.knots; ++i) {
    curves.at.push_back(built.table.knot(i));
    curves.value.push_back(built.table.at_knot(i, Travel::unknown));
    if (banded)
      curves.half_width.emplace_back(
          (built.s_up.at(i).cwiseAbs2() + built.s_down.at(i).cwiseAbs2()).cwiseSqrt());
  }
  return curves;
}

}  // namespace

json diagonal_charts(const XyfzResult& r, bool faces) {
  json charts = json::array();
  const auto& names = faces ? r.mode[0].face : r.mode[0].body;
  for (std::size_t d = 0; d < names.size(); ++d) {
    json series = json::array();
    for (std::size_t m = 0; m < r.mode.size(); ++m) {
      const sim::MeasuredDiagonal& diagonal = faces ? r.mode[m].face[d] : r.mode[m].body[d];
      series.push_back(host::series_of(kModeNames[m], diagonal.distance_mm, diagonal.mean_um));
    }
    charts.push_back(host::lines_chart(fmt::format("{}-{}", faces ? "face" : "body", names[d].name),
                                       names[d].name, host::axis_label("distance", "mm"),
                                       host::axis_label("deviation", "µm"), series));
  }
  return host::chart_group(
      faces ? "faces" : "diagonals", faces ? "Face diagonals" : "Body diagonals, all modes", charts,
      "Mean of both directions, noise-free, relative to the first point (ISO 230-6). The machine "
      "moved with the offsets applied; nothing was subtracted afterwards.");
}

json draws_sections(const XyfzResult& r) {
  json sections = json::array();
  if (r.draws.empty()) return sections;
  json rows = json::array();
  json series = json::array();
  for (std::size_t m = 0; m < 3; ++m) {
    std::vector<double> rates;
    for (const DrawResult& d : r.draws)
      rates.push_back(d.rate(m));
    rows.push_back({kModeTitles[m + 1], r.draw_quantile(m, 0.5), r.draw_quantile(m, 0.05),
                    r.draw_quantile(m, 0.0)});
    series.push_back(host::bars_of(kModeNames[m + 1], rates));
  }
  sections.push_back(
      {{"type", "histogram"},
       {"id", "draws"},
       {"title", fmt::format("{} noisy campaigns", r.draws.size())},
       {"x", host::axis_label("reduction of the PNP maximum", "%")},
       {"series", series},
       {"limit", kPaperRate},
       {"note",
        fmt::format(
            "Every campaign draws its own instrument errors, arms, temperature and readings. "
            "Line: the paper's {} %. Reached by the closed model in {:.0f} % of them.",
            kPaperRate, 100.0 * r.draws_reaching(kPaperRate))}});
  sections.push_back(host::with_id(
      "draw-quantiles",
      host::table_section("Rate over the noisy campaigns",
                          {host::plain_column("model"), host::column("median", "%", 1),
                           host::column("5 % quantile", "%", 1), host::column("worst", "%", 1)},
                          rows)));
  return sections;
}

json dynamics_sections(const XyfzResult& r) {
  const Dynamics& d = r.dynamics;
  const auto curve = [](const char* name, const Trace& trace) {
    return host::series_of(name, trace.x, trace.y);
  };
  return json::array(
      {host::lines_chart(
           "line", fmt::format("Straight line at {:g} m/min along PNP", kLineFeed_m_min),
           host::axis_label("path", "mm"), host::axis_label("distance from the chord", "µm"),
           {curve("uncompensated", d.line_deviation_raw_um),
            curve("abbe_closed", d.line_deviation_um)}),
       host::lines_chart(
           "line-offset", "Applied minus wanted offset on that line",
           host::axis_label("path", "mm"), host::axis_label("largest of the three axes", "nm"),
           json::array({curve("abbe_closed", d.line_offset_error_nm)}),
           fmt::format("Worst {:.2f} nm over every tick. 1 nm is the bound of the arithmetic, not "
                       "of the machine.",
                       d.line_worst_nm)),
       host::lines_chart(
           "circle",
           fmt::format("Circle in XY, radius {:g} mm, {:g} m/min", kCircleRadius_mm,
                       kCircleFeed_m_min),
           host::axis_label("angle", "deg"), host::axis_label("radial deviation", "µm"),
           {curve("uncompensated", d.circle_raw_um), curve("abbe_closed", d.circle_um)},
           "Best-fit circle removed. Spikes at the quadrants: reversal, which the "
           "direction-dependent tables correct after the hysteresis of the direction.")});
}

json positioning_charts(const XyfzResult& r) {
  return host::positioning_group(
      r.positioning_check,
      fmt::format("Means of {} runs upwards and downwards with bands of ±2 s of the readings; "
                  "dashed, their mean. A spans the bands, E the means of the directions, M their "
                  "mean. Other axes at mid travel.",
                  r.options.runs));
}

json volume_chart(const XyfzResult& r) {
  return host::volume_map(
      "Error vectors over the work volume", r.volume_points,
      {{"uncompensated", host::aligned_errors(r.volume_points, r.volume_error[0])},
       {"abbe_closed", host::aligned_errors(r.volume_points, r.volume_error[1])}},
      "From each point to where the tool really is, after aligning the workpiece frame as for the "
      "figure of the volume.");
}

json error_function_charts(const XyfzResult& r) {
  std::vector<host::ErrorCurves> axes;
  for (std::size_t a = 0; a < r.example->built.size(); ++a)
    axes.push_back(curves_of(*r.example->built[a], r.machine.axes[a].letter));
  return host::error_functions_group(
      "Error functions at the reading heads", axes,
      "Mean of both directions after removing straightness slopes, transferring and re-zeroing. "
      "Bands, where there is noise: ±2 standard deviations of the mean of a reading upwards and "
      "one downwards, at the sensed point.");
}

}  // namespace volcomp::xyfz
