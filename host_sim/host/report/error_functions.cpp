#include "host_sim/host/report/error_functions.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr Eigen::Index kLengths = 3;  // before the angles

json curve(const ErrorCurves& axis, const std::vector<double>& x, Eigen::Index channel) {
  const double scale = channel < kLengths ? kUmPerMm : kUradPerRad;
  std::vector<double> y;
  for (const ErrorMotion& e : axis.value)
    y.push_back(scale * e(channel));
  json series = series_of(kChannels.at(static_cast<std::size_t>(channel)), x, y);
  if (axis.half_width.empty()) return series;
  std::vector<double> low = y;
  std::vector<double> high = y;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double half = scale * axis.half_width.at(i)(channel);
    low[i] -= half;
    high[i] += half;
  }
  series["band"] = {{"lo", low}, {"hi", high}};
  return series;
}

json chart(const ErrorCurves& axis, bool angles) {
  const std::vector<double> x = scaled(axis.at, axis.rotary ? kDegPerRad : 1.0);
  json series = json::array();
  for (Eigen::Index c = angles ? kLengths : 0; c < (angles ? 2 * kLengths : kLengths); ++c)
    if (axis.known.at(static_cast<std::size_t>(c))) series.push_back(curve(axis, x, c));
  return lines_chart(fmt::format("function-{}-{}", axis.letter, angles ? "angles" : "lengths"),
                     fmt::format("{}: {}", axis.letter, angles ? "angles" : "displacements"),
                     axis_label("position", axis.rotary ? "deg" : "mm"),
                     axis_label("error", angles ? "µrad" : "µm"), series);
}

}  // namespace

json error_functions_group(const std::string& title, const std::vector<ErrorCurves>& axes,
                           const std::string& note) {
  json charts = json::array();
  for (const ErrorCurves& axis : axes) {
    for (const bool angles : {false, true}) {
      json drawn = chart(axis, angles);
      if (!drawn["series"].empty()) charts.push_back(std::move(drawn));
    }
  }
  return chart_group("functions", title, charts, note, false);
}

}  // namespace volcomp::host
