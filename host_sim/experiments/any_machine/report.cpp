#include "host_sim/experiments/any_machine/report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/experiments/any_machine/verification_charts.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::any_machine {
namespace {

using nlohmann::json;

json orientation_chart(const MachineResult& r) {
  return host::lines_chart(
      "orientation", "Direction of the tool, all over the travel", host::axis_label("position", ""),
      host::axis_label("tilt of the tool axis", "µrad"),
      reading_series(r.before.place, r.after.place,
                     [](const PlaceReading& p) { return host::kUradPerRad * p.tilt_rad; }),
      fmt::format("What is left of it acts beside the tool point the tables are for: a tool {:g} "
                  "mm longer is off by up to {:.2f} µm before and {:.2f} µm after.",
                  r.options.tool_length_mm, r.effect_um(r.before), r.effect_um(r.after)));
}

json before_after(const MachineResult& r) {
  std::vector<host::BeforeAfter> lines = judged_figures(r);
  const auto angle = [&lines](const std::string& what, double before_rad, double after_rad) {
    lines.push_back({what, host::kUradPerRad * before_rad, host::kUradPerRad * after_rad});
    lines.back().unit = "µrad";
  };
  lines.push_back({"volume, root mean square", r.before.volume.rms_um, r.after.volume.rms_um});
  angle("orientation of the tool", r.before.tilt_max_rad(), r.after.tilt_max_rad());
  lines.push_back({fmt::format("the same, for a tool {:g} mm longer", r.options.tool_length_mm),
                   r.effect_um(r.before), r.effect_um(r.after)});
  const std::string orienting = orienting_letters(r.machine);
  std::string note = fmt::format(
      "Largest deviations, of the volume at {} places. {} correct the "
      "position; least authority over the travel {:.3f}.",
      r.before.place.size(), correcting_letters(r.machine), r.authority.value);
  if (!orienting.empty()) {
    angle(fmt::format("orientation where {} have their grip on it", orienting),
          r.before.steerable_max_rad(), r.after.steerable_max_rad());
    note += fmt::format(
        " {} correct the direction: tool direction is where they have their grip "
        "on it, at {:g} mm.",
        orienting, r.options.tool_length_mm);
  }
  return host::before_after_table(lines, note);
}

// How the places of the rotary axes were found, if there are any.
std::string locations_text(const sim::RotaryLocations& locations) {
  double mm = 0.0;
  double rad = 0.0;
  for (const sim::LocationValue& v : locations.found) {
    double& largest = v.angular ? rad : mm;
    largest = std::max(largest, v.u);
  }
  std::string text = fmt::format(
      "{} location errors of rotary axes found by a tracer at four stations, standard uncertainty "
      "of "
      "its readings alone up to {:.2f} µm and {:.2f} µrad; runs leave {:.1f} times what these "
      "scatter by",
      locations.found.size(), kUmPerMm * mm, host::kUradPerRad * rad, locations.misfit);
  if (!locations.assumed.empty())
    text += fmt::format(
        "; location not measured: {}, assumed from the machine file, as no place of the "
        "tool tells it from the others",
        fmt::join(locations.assumed, " "));
  return text;
}

// What the figures are of, in words.
json measured_text(const MachineResult& r) {
  const std::string machine = fmt::format(
      "{}, {}, seed {}, {}; {} correct{}", r.machine.name, host::chain_text(r.machine.chain),
      r.options.seed, r.options.noise ? "realistic instruments" : "no noise",
      correcting_letters(r.machine),
      r.machine.chain.description().correcting_count == 1 ? "s" : "");
  std::string sphere = "no sphere test: no rotary axis that three other axes can follow";
  if (!r.before.sphere.empty()) {
    const Vec3& b = r.sphere.ball;
    sphere = fmt::format("ball at {:.1f} {:.1f} {:.1f} mm on the table, {} positions", b.x(), b.y(),
                         b.z(), r.sphere.poses.size());
    if (r.sphere.left_out > 0) sphere += fmt::format(", {} out of reach", r.sphere.left_out);
  }
  std::vector<std::string> texts{machine, sphere};
  if (!r.locations.found.empty()) texts.push_back(locations_text(r.locations));
  return host::in_summary(
      host::with_id("measured", host::text_section("What was measured", texts)));
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
  if (!r.before.place.empty()) parts.plots.push_back(volume_chart(r.machine, r.before, r.after));
  if (!r.before.line.empty()) parts.plots.push_back(line_charts(r.before, r.after));
  if (!r.before.sphere.empty()) parts.plots.push_back(sphere_chart(r.sphere, r.before, r.after));
  if (!r.before.place.empty()) parts.plots.push_back(orientation_chart(r));
  parts.details.push_back(measured_text(r));
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(r));
  return host::report_document(std::move(parts));
}

std::string machine_summary(const MachineResult& r) {
  return host::terminal_text(machine_document(r, {}));
}

}  // namespace volcomp::any_machine
