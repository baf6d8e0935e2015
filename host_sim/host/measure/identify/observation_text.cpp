#include "host_sim/host/measure/identify/observation_text.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/plan_values.hpp"

namespace volcomp::host::identify {
namespace {

std::string header_of_axes(const MachineFile& machine) {
  std::string text;
  for (const AxisFile& axis : machine.axes)
    text += fmt::format("{} [{}],", axis.letter, axis.rotary ? "deg" : "mm");
  text += "tip";
  for (const AxisFile& axis : machine.axes)
    text += fmt::format(",direction {}", axis.letter);
  return text;
}

std::string cells_of_axes(const MachineFile& machine, const Pose& q, const Directions& d,
                          const std::string& tip) {
  std::string text;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    text += machine.axes[a].rotary ? fmt::format("{:.9f},", q.at(a) / kRadPerDegree)
                                   : fmt::format("{:.6f},", q.at(a));
  text += tip;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    text += d.at(a) > 0.0 ? ",+" : d.at(a) < 0.0 ? ",-" : ",0";
  return text;
}

std::string header_of_readings(ObservationKind kind) {
  switch (kind) {
    case ObservationKind::tracer:
      return "length [mm]";
    case ObservationKind::bar:
      return "radial [um]";
    case ObservationKind::rtest:
      return "DX [um],DY [um],DZ [um]";
    default:
      return "displacement [mm]";
  }
}

}  // namespace

std::string touches_csv(const MeasurementPlan& plan, const std::vector<LatchedTouch>& touches) {
  std::string text = "setup,sphere," + header_of_axes(plan.machine) + '\n';
  for (const LatchedTouch& t : touches)
    text += fmt::format("{},{},{}\n", plan.problem.setups[t.setup].name, t.sphere,
                        cells_of_axes(plan.machine, t.q, t.d, plan.problem.styli[t.stylus].name));
  return text;
}

std::string readings_csv(const MeasurementPlan& plan, const SetUp& setup) {
  const bool long_way = setup.kind == ObservationKind::tracer ||
                        setup.kind == ObservationKind::diagonal ||
                        setup.kind == ObservationKind::step;
  std::string text =
      fmt::format("{},{}\n", header_of_axes(plan.machine), header_of_readings(setup.kind));
  const std::size_t components = setup.components();
  for (std::size_t i = 0; i < setup.q.size(); ++i) {
    const auto stylus = plan.problem.stylus_of(setup, i);
    text += cells_of_axes(plan.machine, setup.q[i], setup.d[i],
                          stylus ? plan.problem.styli[*stylus].name : "");
    for (std::size_t c = 0; c < components; ++c)
      text += long_way ? fmt::format(",{:.7f}", setup.y[components * i + c])
                       : fmt::format(",{:.4f}", kUmPerMm * setup.y[components * i + c]);
    text += '\n';
  }
  return text;
}

}  // namespace volcomp::host::identify
