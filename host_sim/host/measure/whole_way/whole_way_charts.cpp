#include "host_sim/host/measure/whole_way/whole_way_charts.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {

using nlohmann::json;

namespace {

// Distance along a line; else the number of the place.
std::vector<double> along_task(const WholeWayQuestion& q) {
  const std::vector<Pose>& places = q.task.places;
  bool turns = false;
  std::vector<double> way;
  for (const Pose& place : places) {
    double squares = 0.0;
    for (std::size_t a = 0; a < q.machine.axes.size(); ++a) {
      const double step = place[a] - places.front()[a];
      if (q.machine.axes[a].rotary) turns = turns || std::abs(step) > 0.0;
      squares += step * step;
    }
    way.push_back(std::sqrt(squares));
  }
  return q.task.kind == TaskKind::line && !turns ? way : counted(places.size());
}

}  // namespace

json task_charts(const WholeWayQuestion& q, const TaskUncertainty& u) {
  const std::vector<double> x = along_task(q);
  const bool in_mm =
      q.task.kind == TaskKind::line && std::abs(x.back() - x.front()) > 0.0 && !(x.front() > 0.0);
  const json axis = in_mm ? axis_label("distance", "mm") : axis_label("place", "");
  json errors = json::array();
  json spread = json::array();
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> e;
    std::vector<double> low;
    std::vector<double> high;
    std::vector<double> sd;
    std::vector<double> first;
    for (const PlaceUncertainty& place : u.places) {
      const DrawnNumber& n = place.error.at(c);
      e.push_back(kUmPerMm * n.nominal);
      low.push_back(kUmPerMm * n.low);
      high.push_back(kUmPerMm * n.high);
      sd.push_back(kUmPerMm * n.deviation);
      first.push_back(kUmPerMm * n.first_order.value_or(0.0));
    }
    json series = series_of(kErrorComponents.at(c), x, e);
    series["band"] = {{"lo", low}, {"hi", high}};
    errors.push_back(std::move(series));
    spread.push_back(series_of(kErrorComponents.at(c), x, sd));
    json dashed =
        series_of(fmt::format("{} first order", kErrorComponents.at(c)).c_str(), x, first);
    dashed["style"] = "dashed";
    spread.push_back(std::move(dashed));
  }
  return {lines_chart("errors", "Error that the tables predict, with 95 % of the draws", axis,
                      axis_label("E", "µm"), errors),
          lines_chart("uncertainty", "Standard uncertainty: draws and first order", axis,
                      axis_label("u", "µm"), spread)};
}

json share_bars(const TaskUncertainty& u) {
  json names = json::array();
  json series = json::array();
  for (const GroupShare& share : u.shares)
    names.push_back(share.group);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const GroupShare& share : u.shares)
      values.push_back(kUmPerMm * share.u(static_cast<Eigen::Index>(c)));
    series.push_back(bars_of(kErrorComponents.at(c), values));
  }
  return with_id("share-bars", {{"type", "bars"},
                                {"title", "Where it comes from, to first order"},
                                {"categories", names},
                                {"y", axis_label("u", "µm")},
                                {"series", series}});
}

}  // namespace volcomp::host
