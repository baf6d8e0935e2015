#include "host_sim/experiments/any_machine/verification_charts.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/volume_map.hpp"

namespace volcomp::any_machine {

using nlohmann::json;

json line_charts(const MachineState& before_all, const MachineState& after_all) {
  json charts = json::array();
  for (std::size_t i = 0; i < before_all.line.size(); ++i) {
    const sim::MeasuredDiagonal& before = before_all.line[i];
    const sim::MeasuredDiagonal& after = after_all.line[i];
    charts.push_back(host::lines_chart(
        "diagonal-" + before.name, before.name, host::axis_label("distance", "mm"),
        host::axis_label("deviation along the diagonal", "µm"),
        {host::series_of("uncompensated", before.distance_mm, before.mean_um),
         host::series_of("compensated", after.distance_mm, after.mean_um)}));
  }
  return host::chart_group("diagonals", "Diagonals of the linear axes", charts,
                           "Mean of both directions; rotary axes at their references.");
}

json sphere_chart(const SpherePlan& plan, const MachineState& before, const MachineState& after) {
  return host::lines_chart(
      "sphere", "Ball on the table, rotary axes turned", host::axis_label("position", ""),
      host::axis_label("off the centre of the ball", "µm"),
      reading_series(before.sphere, after.sphere,
                     [](const PlaceReading& p) { return kUmPerMm * p.deviation_mm.norm(); }),
      fmt::format("Ball at {:.1f} {:.1f} {:.1f} mm of the workpiece frame, found at the first "
                  "position; {} positions could not be reached.",
                  plan.ball.x(), plan.ball.y(), plan.ball.z(), plan.left_out));
}

json volume_chart(const host::MachineFile& machine, const MachineState& before_state,
                  const MachineState& after_state) {
  std::vector<Vec3> places;
  host::VolumeArrows before{"uncompensated", {}};
  host::VolumeArrows after{"compensated", {}};
  const MachineChain& chain = machine.chain;
  for (std::size_t i = 0; i < before_state.place.size(); ++i) {
    places.push_back(ideal_points(chain, before_state.place[i].pose, chain.tool_point()).work);
    before.error.push_back(before_state.place[i].deviation_mm);
    after.error.push_back(after_state.place[i].deviation_mm);
  }
  before.error = host::aligned_errors(places, before.error);
  after.error = host::aligned_errors(places, after.error);
  return host::volume_map(
      "Error vectors all over the travel", places, {before, after},
      "Tool point in the workpiece frame, all axes anywhere on their travels; of the error what "
      "the "
      "correcting axes can reach, after aligning the workpiece frame as for the figures.");
}

}  // namespace volcomp::any_machine
