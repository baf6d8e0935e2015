#include "host_sim/experiments/any_machine/report.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/volume_map.hpp"

namespace volcomp::any_machine {
namespace {

using nlohmann::json;

constexpr double kUrad = 1e6;

json line_charts(const MachineResult& r) {
  json charts = json::array();
  for (std::size_t i = 0; i < r.before.line.size(); ++i) {
    const sim::MeasuredDiagonal& before = r.before.line[i];
    const sim::MeasuredDiagonal& after = r.after.line[i];
    charts.push_back({{"type", "lines"},
                      {"id", "diagonal-" + before.name},
                      {"title", before.name},
                      {"x", host::axis_label("distance", "mm")},
                      {"y", host::axis_label("deviation along the diagonal", "µm")},
                      {"series",
                       {host::series_of("uncompensated", before.distance_mm, before.mean_um),
                        host::series_of("compensated", after.distance_mm, after.mean_um)}}});
  }
  return {{"type", "group"},
          {"id", "diagonals"},
          {"title", "Diagonals of the linear axes"},
          {"shared_y", true},
          {"charts", charts},
          {"note", "Mean of both directions; rotary axes at their references."}};
}

template <class Value>
json reading_chart(const std::vector<PlaceReading>& before, const std::vector<PlaceReading>& after,
                   const Value& value) {
  std::vector<double> number;
  std::array<std::vector<double>, 2> y;
  for (std::size_t i = 0; i < before.size(); ++i) {
    number.push_back(static_cast<double>(i + 1));
    y[0].push_back(value(before[i]));
    y[1].push_back(value(after[i]));
  }
  return {{"type", "lines"},
          {"x", host::axis_label("position", "")},
          {"series",
           {host::series_of("uncompensated", number, y[0]),
            host::series_of("compensated", number, y[1])}}};
}

json sphere_chart(const MachineResult& r) {
  json chart = reading_chart(r.before.sphere, r.after.sphere, [](const PlaceReading& p) {
    return kUmPerMm * p.deviation_mm.norm();
  });
  chart["id"] = "sphere";
  chart["title"] = "Ball on the table, rotary axes turned";
  chart["y"] = host::axis_label("off the centre of the ball", "µm");
  chart["note"] = fmt::format(
      "Ball at {:.1f} {:.1f} {:.1f} mm of the workpiece frame, found at the first position; {} "
      "positions could not be reached.",
      r.sphere.ball.x(), r.sphere.ball.y(), r.sphere.ball.z(), r.sphere.left_out);
  return chart;
}

json orientation_chart(const MachineResult& r) {
  json chart = reading_chart(r.before.place, r.after.place,
                             [](const PlaceReading& p) { return kUrad * p.tilt_rad; });
  chart["id"] = "orientation";
  chart["title"] = "Direction of the tool, all over the travel";
  chart["y"] = host::axis_label("tilt of the tool axis", "µrad");
  chart["note"] = fmt::format(
      "What is left of it acts beside the tool point the tables are for: a tool {:g} mm longer is "
      "off by up to {:.2f} µm before and {:.2f} µm after.",
      r.options.tool_length_mm, r.effect_um(r.before), r.effect_um(r.after));
  return chart;
}

json before_after(const MachineResult& r) {
  std::vector<host::BeforeAfter> lines;
  for (std::size_t i = 0; i < r.before.line.size(); ++i)
    lines.push_back({"diagonal " + r.before.line[i].name, r.before.line[i].max_abs_um,
                     r.after.line[i].max_abs_um});
  lines.push_back({fmt::format("volume, {} places", r.before.place.size()), r.before.volume.max_um,
                   r.after.volume.max_um});
  lines.push_back({"volume, root mean square", r.before.volume.rms_um, r.after.volume.rms_um});
  if (!r.before.sphere.empty())
    lines.push_back({fmt::format("ball on the table, {} positions", r.sphere.poses.size()),
                     r.before.sphere_um().max_um, r.after.sphere_um().max_um});
  lines.push_back({fmt::format("orientation, at a tool {:g} mm longer", r.options.tool_length_mm),
                   r.effect_um(r.before), r.effect_um(r.after)});
  const std::string orienting = orienting_letters(r.machine);
  if (!orienting.empty())
    lines.push_back({fmt::format("the same where {} have their grip on the tool", orienting),
                     r.steerable_um(r.before), r.steerable_um(r.after)});
  return host::before_after_table(
      lines, fmt::format("Largest deviations. {} correct the position{}; least authority over the "
                         "travel {:.3f}.",
                         correcting_letters(r.machine),
                         orienting.empty() ? "" : fmt::format(", {} the direction", orienting),
                         r.authority.value));
}

json volume_chart(const MachineResult& r) {
  std::vector<Vec3> places;
  host::VolumeArrows before{"uncompensated", {}};
  host::VolumeArrows after{"compensated", {}};
  const MachineChain& chain = r.machine.chain;
  for (std::size_t i = 0; i < r.before.place.size(); ++i) {
    places.push_back(ideal_points(chain, r.before.place[i].pose, chain.tool_point()).work);
    before.error.push_back(r.before.place[i].deviation_mm);
    after.error.push_back(r.after.place[i].deviation_mm);
  }
  before.error = host::aligned_errors(places, before.error);
  after.error = host::aligned_errors(places, after.error);
  return host::volume_map(
      "Error vectors all over the travel", places, {before, after},
      "Tool point in the workpiece frame, all axes anywhere on their travels; of the error what "
      "the "
      "correcting axes can reach, after aligning the workpiece frame as for the figures.");
}

host::Origins origins(const MachineResult& r) {
  host::Origins origins;
  origins.data = "simulated: no machine was measured";
  origins.settings = {
      {"chain", host::chain_text(r.machine.chain)},
      {"seed", fmt::format("{} (errors of the machine, places, noise)", r.options.seed)}};
  origins.inputs = r.inputs;
  origins.instruments = {r.options.noise ? "realistic" : "perfect"};
  origins.chosen = {"errors of the machine: drawn at random"};
  origins.warnings = r.warnings;
  return origins;
}

}  // namespace

json machine_document(const MachineResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = fmt::format("{}: before and after compensation", r.machine.name);
  parts.subtitle = "Simulated machine with errors drawn at random";
  parts.verdict = machine_verdict(r);
  parts.before_after = before_after(r);
  if (!r.before.place.empty()) parts.plots.push_back(volume_chart(r));
  if (!r.before.line.empty()) parts.plots.push_back(line_charts(r));
  if (!r.before.sphere.empty()) parts.plots.push_back(sphere_chart(r));
  if (!r.before.place.empty()) parts.plots.push_back(orientation_chart(r));
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(r));
  return host::report_document(std::move(parts));
}

}  // namespace volcomp::any_machine
