#include "host_sim/experiments/l300g/report.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/l300g/figures.hpp"
#include "host_sim/experiments/l300g/gear_charts.hpp"
#include "host_sim/experiments/l300g/traced_grinder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/error_functions.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

// --- probe

json residual_chart(const MandrelCalibration& c) {
  std::array<std::vector<double>, 2> y;
  std::array<std::vector<double>, 2> residual;
  for (std::size_t i = 0; i < c.y.size(); ++i) {
    const std::size_t below = c.z[i] > c.fit.geometric.z ? 0 : 1;
    y[below].push_back(c.y[i]);
    residual[below].push_back(kUmPerMm * c.residual(i));
  }
  return host::lines_chart(
      "residuals", "Probe calibration: residuals on the mandrel", host::axis_label("Y", "mm"),
      host::axis_label("distance from the circle", "µm"),
      {host::points_of("above the mandrel", y[0], residual[0]),
       host::points_of("below the mandrel", y[1], residual[1])},
      fmt::format("{} touches in one half plane, nothing compensated. R_c {:.4f} mm, r_c = R_c - R "
                  "= {:.4f} mm, Y0 {:.4f} mm, Z0 {:.4f} mm, rms {:.2f} µm.",
                  c.y.size(), c.fit.geometric.radius, c.rc, c.fit.geometric.y, c.fit.geometric.z,
                  kUmPerMm * c.fit.rms));
}

json effect_row(const std::string& what, const MandrelEffect& e) {
  return {what, kUmPerMm * e.radius, kUmPerMm * e.y0, kUmPerMm * e.z0, kUmPerMm * e.rms};
}

json sensitivities(const L300gResult& r) {
  json rows = json::array();
  rows.push_back(effect_row(fmt::format("arm believed {:g} µm too long", kUmPerMm * kLongerArm_mm),
                            r.longer_arm));
  for (std::size_t i = 0; i < kHigherPivots_mm.size(); ++i)
    rows.push_back(
        effect_row(fmt::format("pivot {:g} mm above the axis of A, ignored", kHigherPivots_mm[i]),
                   r.higher_pivot[i]));
  return host::with_id(
      "sensitivities",
      host::table_section(
          "What the calibration cannot tell from the radius",
          {host::plain_column("machine"), host::column("R_c", "µm", 3), host::column("Y0", "µm", 3),
           host::column("Z0", "µm", 3), host::column("rms", "µm", 4)},
          rows),
      fmt::format("The residuals hardly show them. Standard uncertainty of r_c with the assumed "
                  "inputs: {:.2f} µm.",
                  kUmPerMm * r.calibration.u_rc));
}

// --- identification

json error_functions(const L300gResult& r) {
  const sim::TracedErrors& found = r.identification;
  return host::error_functions_group(
      fmt::format("The {} identified error functions",
                  host::kChannels.size() * found.functions.size()),
      found.functions,
      fmt::format("Motion of the body itself, in its moving frame, with the places of B and A and "
                  "the constants of A in them; Y is along the bed by definition. {} unknowns from "
                  "{} readings. Bands: ±2 standard uncertainties.",
                  found.unknowns, found.readings));
}

json place_table(const L300gResult& r) {
  json rows = json::array();
  for (const sim::TracedValue& v : r.identification.values) {
    const double scale = v.angular ? host::kUradPerRad : kUmPerMm;
    rows.push_back({v.name, scale * v.found, scale * v.u, v.angular ? "µrad" : "µm"});
  }
  return host::with_id(
      "places",
      host::table_section("Where B, A and the gear on A are",
                          {host::plain_column("value"), host::column("identified", "", 2),
                           host::column("standard uncertainty", "", 2), host::plain_column("unit")},
                          rows),
      "0: location on the fixed side (ISO 230-7); 1: constant on the moving side, that is how the "
      "datum of the gear, which the stations are measured from, lies on A.");
}

json printed_table(const L300gResult& r) {
  json rows = json::array();
  for (std::size_t a = 0; a < r.printed.own.size(); ++a) {
    const bool rotary = r.machine.axes[a].rotary;
    const double scale = rotary ? host::kUradPerRad : kUmPerMm;
    const ReadingFigures& own = r.printed.own.at(a);
    rows.push_back({std::string(1, r.machine.axes[a].letter), scale * own.mean,
                    scale * own.deviation, scale * own.range, rotary ? "µrad" : "µm"});
  }
  return host::with_id(
      "printed",
      host::table_section("What the procedure as printed can give",
                          {host::plain_column("axis"), host::column("mean reading", "", 3),
                           host::column("standard deviation", "", 3), host::column("range", "", 3),
                           host::plain_column("unit")},
                          rows),
      fmt::format("Eq. 18 of the paper repeats the same three rows for every station: rank {} of "
                  "6. Its shortest solution for X is EX {:.4f} µm, EB {:.2e} rad, EC {:.2e} rad: "
                  "the mean reading, and nothing else.",
                  r.printed.x.rank, kUmPerMm * r.printed.x.least(0), r.printed.x.least(4),
                  r.printed.x.least(5)));
}

// --- points

json feed_chart(const L300gResult& r) {
  const FeedCheck& feeds = r.feeds;
  return host::lines_chart(
      "feeds", fmt::format("The same place at {} feeds", feeds.feed_mm_min.size()),
      host::axis_label("feed", "mm/min"),
      host::axis_label("normal to the flank, from the mean", "nm"),
      {host::points_of("as latched", feeds.feed_mm_min, feeds.raw_nm),
       host::points_of("corrected by the node", feeds.feed_mm_min, feeds.corrected_nm)},
      fmt::format("Spread {:.1f} nm as latched, {:.1f} nm corrected for the delays of probe and "
                  "axes.",
                  feeds.raw_spread_nm(), feeds.corrected_spread_nm()));
}

// --- the document

// What was found besides the gear, in words.
json found_text(const L300gResult& r) {
  const MandrelCalibration& c = r.calibration;
  const Vec3 orientation = host::kUradPerRad * r.orientation;
  return host::in_summary(host::with_id(
      "found",
      host::text_section(
          "Probe, machine and touches",
          {fmt::format("probe: {} touches of the mandrel, R_c {:.4f} mm, r_c {:.4f} mm ± {:.2f} "
                       "µm, Y0 {:.4f} mm, Z0 {:.4f} mm, rms {:.2f} µm",
                       c.y.size(), c.fit.geometric.radius, c.rc, kUmPerMm * c.u_rc,
                       c.fit.geometric.y, c.fit.geometric.z, kUmPerMm * c.fit.rms),
           fmt::format("identification: 24 functions and the places of B, A and gear; error of the "
                       "ball {:.3f} µm rms all over the travels, {:.3f} µm at most, predicted "
                       "{:.3f} µm; chi-square {:.2f} a degree of freedom; the paper's eq. 18 has "
                       "rank {} of 6",
                       kUmPerMm * r.identification.rms_mm, kUmPerMm * r.identification.largest_mm,
                       kUmPerMm * r.identification.u_rms_mm, r.identification.chi2_over_dof,
                       r.printed.x.rank),
           fmt::format("orientation of the probe against the gear at the pitch point: {:.1f}, "
                       "{:.1f}, {:.1f} µrad; X, Y and B correct what it does to the ball, not "
                       "itself",
                       orientation.x(), orientation.y(), orientation.z()),
           fmt::format("one place at 10 to 1000 mm/min: {:.1f} nm apart as latched, {:.1f} nm as "
                       "corrected",
                       r.feeds.raw_spread_nm(), r.feeds.corrected_spread_nm()),
           fmt::format("a probe with lobing in 36 directions: up to {:.2f} µm wrong with a "
                       "constant radius, {:.2f} µm with a map",
                       r.lobing.raw_um, r.lobing.corrected_um)})));
}

json before_after(const L300gResult& r) {
  std::vector<host::BeforeAfter> lines;
  const auto grade = [](const std::optional<int>& g) {
    return grade_text(g, GearStandard::iso1328_1995);
  };
  const std::size_t teeth = r.options.rules.traces.teeth;
  const std::string worst = teeth > 1 ? fmt::format(" (worst of {} teeth)", teeth) : "";
  const auto traces = [&](const char* what, auto member) {
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      const host::FlankTrace& before = (r.before.*member)[side];
      const host::FlankTrace& after = (r.after.*member)[side];
      lines.push_back({fmt::format("{}{}, {} flank", what, worst, kSideNames[side]),
                       before.figures.total, after.figures.total,
                       (r.truth.*member)[side].figures.total, grade(before.grade_1995),
                       grade(after.grade_1995)});
    }
  };
  traces("profile F_α", &GearInspection::profile);
  traces("lead F_β", &GearInspection::lead);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const host::PitchRound& before = r.before.pitch[side];
    const host::PitchRound& after = r.after.pitch[side];
    const host::PitchRound& truth = r.truth.pitch[side];
    lines.push_back({fmt::format("pitch F_p, {} flanks", kSideNames[side]), before.figures.total,
                     after.figures.total, truth.figures.total, grade(before.grade_1995),
                     grade(after.grade_1995)});
    lines.push_back({fmt::format("pitch f_pt, {} flanks", kSideNames[side]), before.figures.single,
                     after.figures.single, truth.figures.single, "", ""});
  }
  return host::before_after_table(
      lines,
      "Deviations of the gear as the machine finds them, with zero tables and with those of "
      "the identified error functions. Grades by ISO 1328-1:1995; that of a pitch is the worse of "
      "F_p and f_pt.");
}

std::string scatter_text(const L300gOptions& o) {
  const sim::ProbeClass& probe = sim::kProbeClasses.at(o.probe);
  if (o.probe == 0) return "; its touches do not scatter";
  return fmt::format("; class {}: {}; radius {}; {} touches of each point{}", probe.name,
                     sim::probe_text(probe),
                     o.map_radius ? "mapped on a sphere" : "that of the mandrel", o.rules.touches,
                     o.rules.filter ? ", filtered" : "");
}

std::string tracer_text(const L300gOptions& o) {
  const sim::TracedPlan plan = traced_plan();
  return fmt::format(
      "tracing interferometer at four stations, {} places and {} reflectors each: {}", plan.places,
      plan.reflectors.size() + 1, sim::scatter_text(plan, tracer_of(o)));
}

host::Origins origins(const L300gResult& r) {
  const L300gOptions& o = r.options;
  host::Origins origins;
  origins.settings = {
      {"errors of the machine", o.errors},
      {"path", o.path == PathStyle::fixed_a ? "A stands still, B touches" : "generating"},
      {"origin", o.origin == Origin::nominal ? "machine file" : "fit of the mandrel"},
      {"tables", kTableKinds.at(static_cast<std::size_t>(o.tables))},
      {"seed", fmt::format("{} (phases of waves, noise of the lobing check)", o.seed)}};
  origins.inputs = r.inputs;
  origins.instruments = {
      tracer_text(o),
      "touch probe of the machine: delays and radius of the machine file, corrected by the node" +
          scatter_text(o)};
  if (r.on_centre)
    origins.instruments.push_back(
        fmt::format("gear measuring centre: {:g} µm of each point, {:g} µm of the slope of each "
                    "trace (standard deviations)",
                    CentreErrors{}.point_um, CentreErrors{}.slope_um));
  origins.chosen = {"amounts and signs of the errors, such that they add up"};
  origins.untouched = {"deviations and grades of the gear"};
  return origins;
}

}  // namespace

json l300g_document(const L300gResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "L300G: gear inspection before and after compensation";
  parts.subtitle =
      "Simulated gear grinder after Yang et al.; every touch through drives, bus and node";
  parts.verdict = l300g_verdict(r);
  parts.before_after = before_after(r);
  parts.plots = {profile_charts(r), lead_charts(r), pitch_charts(r), error_functions(r)};
  parts.details = {gear_table(r),    found_text(r),  residual_chart(r.calibration),
                   sensitivities(r), place_table(r), printed_table(r),
                   feed_chart(r)};
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(r));
  return host::report_document(std::move(parts));
}

std::string l300g_summary(const L300gResult& r) {
  return host::terminal_text(l300g_document(r, {}));
}

}  // namespace volcomp::l300g
