#include "host_sim/experiments/xyfz/functionals.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/metrology/tables/squareness.hpp"
#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/sim/instruments/ball_bar.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

constexpr std::size_t kFirstAngle = 3;  // of the six channels

Planes difference_on(const sim::TrueMachine& truth, const host::SquarenessFile& place) {
  host::SquarenessFile lines = place;
  lines.circle_radius.reset();
  host::SquarenessFile circles = place;
  circles.circle_radius = kBallBar_mm;
  const XyfzSquareness less =
      close_squareness(sim::measure_squareness(truth, circles, sim::no_noise(), {}),
                       sim::measure_squareness(truth, lines, sim::no_noise(), {}));
  return {host::kUradPerRad * less.a_xy, host::kUradPerRad * less.a_xz,
          host::kUradPerRad * less.a_yz};
}

// The machine without some of its error functions.
sim::TrueMachine without(sim::TrueMachine machine, bool angles) {
  for (sim::TrueAxis& axis : machine.axis) {
    for (std::size_t c = 0; c < axis.channel.size(); ++c) {
      if ((c >= kFirstAngle) != angles) continue;
      axis.channel.at(c) = {};
      axis.reversal.at(c) = 0.0;
    }
  }
  return machine;
}

double rms_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values)
    squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

std::vector<double> values_of(const std::vector<CirclesLessLines>& machines,
                              Planes CirclesLessLines::*part, std::size_t plane) {
  std::vector<double> values;
  values.reserve(machines.size());
  for (const CirclesLessLines& m : machines)
    values.push_back((m.*part).at(plane));
  return values;
}

}  // namespace

CirclesLessLines circles_less_lines(const sim::TrueMachine& truth, const host::MachineFile& file) {
  return {difference_on(truth, *file.squareness),
          difference_on(without(truth, true), *file.squareness),
          difference_on(without(truth, false), *file.squareness)};
}

json functionals_table(const std::vector<CirclesLessLines>& machines) {
  json rows = json::array();
  for (std::size_t plane = 0; plane < kPlaneNames.size(); ++plane) {
    const std::vector<double> all = values_of(machines, &CirclesLessLines::all, plane);
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    rows.push_back({kPlaneNames.at(plane), rms_of(all), *least, *most,
                    rms_of(values_of(machines, &CirclesLessLines::without_angles, plane)),
                    rms_of(values_of(machines, &CirclesLessLines::angles, plane))});
  }
  json table = host::table_section(
      fmt::format("Squareness by circles less along lines, {} machines", machines.size()),
      {host::plain_column("plane", "plane"), host::column("rms", "µrad", 1, "rms_urad"),
       host::column("least", "µrad", 1, "least_urad"), host::column("most", "µrad", 1, "most_urad"),
       host::column("without angles: rms", "µrad", 1, "without_angles_rms_urad"),
       host::column("angles alone: rms", "µrad", 1, "angles_rms_urad")},
      std::move(rows));
  table["name"] = "circles_less_lines";
  return host::with_id(
      "functionals", std::move(table),
      fmt::format("What the form of the axes makes of squareness: a perfect bar on circles of {:g} "
                  "mm less one along three lines, about the same point of each machine.",
                  kBallBar_mm));
}

json functionals_json(const CirclesLessLines& machine) {
  return {{"all_urad", machine.all},
          {"without_angles_urad", machine.without_angles},
          {"angles_urad", machine.angles}};
}

CirclesLessLines functionals_of(const json& machine) {
  constexpr std::size_t kPlanes = kPlaneNames.size();
  return {host::numbers_of<kPlanes>(machine.at("all_urad"), "all_urad"),
          host::numbers_of<kPlanes>(machine.at("without_angles_urad"), "without_angles_urad"),
          host::numbers_of<kPlanes>(machine.at("angles_urad"), "angles_urad")};
}

}  // namespace volcomp::xyfz
