#include "host_sim/experiments/l300g/spread.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/experiments/l300g/machine_errors.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/range_of_draws.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

constexpr double kWantedShare = 0.95;

bool same_grades(const GearInspection& a, const GearInspection& b) {
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    if (a.profile[side].grade_1995 != b.profile[side].grade_1995 ||
        a.lead[side].grade_1995 != b.lead[side].grade_1995)
      return false;
  }
  return true;
}

bool worse(const std::optional<int>& a, const std::optional<int>& b) {
  return a.value_or(99) > b.value_or(99);
}

MeasuredOnce figures_of(const L300gResult& r) {
  MeasuredOnce m;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    m.profile[side] = r.after.profile[side].figures.total;
    m.lead[side] = r.after.lead[side].figures.total;
    m.pitch[side] = r.after.pitch[side].figures.total;
    m.before_worse = m.before_worse ||
                     worse(r.before.profile[side].grade_1995, r.truth.profile[side].grade_1995) ||
                     worse(r.before.lead[side].grade_1995, r.truth.lead[side].grade_1995);
  }
  m.own_grades = same_grades(r.after, r.truth);
  m.profile_teeth = r.after.profile_teeth;
  m.lead_teeth = r.after.lead_teeth;
  return m;
}

std::string filter_text(const InspectionRules& rules) {
  constexpr std::size_t kWanted = 150;
  if (!rules.filter) return "no filter";
  return fmt::format(
      "Gaussian filter of ISO 1328-1:2013, a thirtieth of the range and at least 0.25 mm{}",
      rules.traces.points < kWanted ? fmt::format(" (that edition asks for {} points)", kWanted)
                                    : "");
}

json teeth_of(const std::array<SeveralTeeth, 2>& teeth) {
  return {{"mean_um", {teeth[0].mean, teeth[1].mean}},
          {"of_mean_trace_um", {teeth[0].of_mean_trace, teeth[1].of_mean_trace}}};
}

std::array<SeveralTeeth, 2> teeth_from(const json& j) {
  const auto mean = host::numbers_of<2>(j.at("mean_um"), "mean_um");
  const auto of_mean = host::numbers_of<2>(j.at("of_mean_trace_um"), "of_mean_trace_um");
  return {{{mean[0], of_mean[0]}, {mean[1], of_mean[1]}}};
}

json measured_json(const MeasuredOnce& m) {
  return {{"profile_um", m.profile},
          {"lead_um", m.lead},
          {"pitch_um", m.pitch},
          {"before_worse", m.before_worse},
          {"own_grades", m.own_grades},
          {"profile_teeth", teeth_of(m.profile_teeth)},
          {"lead_teeth", teeth_of(m.lead_teeth)}};
}

MeasuredOnce measured_from(const json& m) {
  return {host::numbers_of<2>(m.at("profile_um"), "profile_um"),
          host::numbers_of<2>(m.at("lead_um"), "lead_um"),
          host::numbers_of<2>(m.at("pitch_um"), "pitch_um"),
          m.at("before_worse").get<bool>(),
          m.at("own_grades").get<bool>(),
          teeth_from(m.at("profile_teeth")),
          teeth_from(m.at("lead_teeth"))};
}

// One row a deviation and flank.
json table(const SpreadResult& r) {
  json rows = json::array();
  const std::size_t teeth = r.options.rules.traces.teeth;
  const auto add = [&](const std::string& what, std::size_t side, double own, auto value) {
    std::vector<double> values;
    for (const MeasuredOnce& m : r.measurement)
      values.push_back(value(m));
    const host::RangeOfDraws range = host::range_of_draws(values);
    rows.push_back({what, kSideNames.at(side), own, range.median, range.least, range.most});
  };
  // Of several teeth the worst, the mean of their figures, and the figure of their mean trace.
  const auto add_trace = [&](const std::string& what, std::size_t side, double own, auto worst,
                             auto several) {
    const auto mean = [&](const MeasuredOnce& m) { return (m.*several)[side].mean; };
    const auto of_mean = [&](const MeasuredOnce& m) { return (m.*several)[side].of_mean_trace; };
    add(teeth > 1 ? fmt::format("{}, worst of {} teeth", what, teeth) : what, side, own,
        [&](const MeasuredOnce& m) { return (m.*worst)[side]; });
    if (teeth == 1) return;
    add(what + ", mean of them", side, own, mean);
    add(what + " of the mean trace", side, own, of_mean);
  };
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    add_trace("F_alpha", side, r.truth.profile[side].figures.total, &MeasuredOnce::profile,
              &MeasuredOnce::profile_teeth);
    add_trace("F_beta", side, r.truth.lead[side].figures.total, &MeasuredOnce::lead,
              &MeasuredOnce::lead_teeth);
    add("F_p", side, r.truth.pitch[side].figures.total,
        [side](const MeasuredOnce& m) { return m.pitch[side]; });
  }
  json made = host::table_section(
      fmt::format("{} measurements of the gear, compensated", r.measurement.size()),
      {host::plain_column("figure", "figure"), host::plain_column("flank", "flank"),
       host::column("of the gear", "µm", 2, "own_um"), host::column("median", "µm", 2, "median_um"),
       host::column("least", "µm", 2, "least_um"), host::column("most", "µm", 2, "most_um")},
      rows);
  made["name"] = "spread";
  return host::in_summary(
      host::with_id("spread", std::move(made),
                    fmt::format("Probe {}: {}; radius {}; {} touch{} of a point, {} points within "
                                "a range, {}. Readings of the tracer that "
                                "identifies the axes scatter by {:.2g} µm.",
                                sim::kProbeClasses.at(r.options.probe).name,
                                sim::probe_text(sim::kProbeClasses.at(r.options.probe)),
                                r.options.map_radius ? "mapped on a sphere" : "that of the mandrel",
                                r.options.rules.touches, r.options.rules.touches == 1 ? "" : "es",
                                r.options.rules.traces.points, filter_text(r.options.rules),
                                r.options.tracer_um)));
}

json histogram(const SpreadResult& r) {
  std::vector<double> values;
  for (const MeasuredOnce& m : r.measurement)
    values.insert(values.end(), m.profile.begin(), m.profile.end());
  return host::with_id("histogram", {{"type", "histogram"},
                                     {"title", "Total profile deviation F_alpha, both flanks"},
                                     {"x", host::axis_label("F_alpha", "µm")},
                                     {"series", {{{"name", "measured"}, {"values", values}}}}});
}

// So that parts can be put together without its file.
json gear_settings(const InvoluteGear& g) {
  return {{"teeth", g.teeth},
          {"module_mm", g.module},
          {"pressure_angle_rad", g.pressure_angle},
          {"tip_diameter_mm", g.tip_diameter},
          {"width_mm", g.width}};
}

InvoluteGear gear_of(const json& settings) {
  InvoluteGear g;
  g.teeth = settings.at("teeth").get<int>();
  g.module = settings.at("module_mm").get<double>();
  g.pressure_angle = settings.at("pressure_angle_rad").get<double>();
  g.tip_diameter = settings.at("tip_diameter_mm").get<double>();
  g.width = settings.at("width_mm").get<double>();
  host::require(derive(g), "gear of the parts");
  return g;
}

json settings_of(const L300gOptions& o, const std::vector<host::HashedInput>& inputs,
                 const InvoluteGear& gear) {
  return {{"inputs", host::hashes_of(inputs)},
          {"gear", gear_settings(gear)},
          {"errors", o.errors},
          {"path", o.path == PathStyle::fixed_a ? "fixed-a" : "generate"},
          {"origin", o.origin == Origin::nominal ? "nominal" : "mandrel"},
          {"tables", kTableKinds.at(static_cast<std::size_t>(o.tables))},
          {"seed", o.seed},
          {"cycle_hz", o.cycle_hz},
          {"probe", sim::kProbeClasses.at(o.probe).name},
          {"radius", o.map_radius ? "mapped" : "mandrel"},
          {"tracer_um", o.tracer_um},
          {"touches", o.rules.touches},
          {"filter", o.rules.filter},
          {"teeth", o.rules.traces.teeth},
          {"points", o.rules.traces.points}};
}

std::size_t probe_named(const std::string& name) {
  for (std::size_t i = 0; i < sim::kProbeClasses.size(); ++i)
    if (name == sim::kProbeClasses.at(i).name) return i;
  throw host::UserError("the parts are of a probe that is not known");
}

}  // namespace

double SpreadResult::share_of_own_grades() const {
  const auto own = std::count_if(measurement.begin(), measurement.end(),
                                 [](const MeasuredOnce& m) { return m.own_grades; });
  return static_cast<double>(own) / static_cast<double>(measurement.size());
}

SpreadResult run_spread(const L300gOptions& options, const host::DrawPlan& plan,
                        const host::Progress& progress) {
  SpreadResult result;
  result.options = options;
  result.inputs = {host::hashed_file("machine file", options.machine)};
  if (!is_named(options.errors))
    result.inputs.push_back(host::hashed_file("errors of the machine", options.errors));
  const InvoluteGear gear = gear_to_measure(options.gear);
  if (!options.gear.empty()) result.inputs.push_back(host::hashed_file("gear", options.gear));
  result.truth = true_gear(gear);
  result.settings = settings_of(options, result.inputs, gear);
  result.measurement = host::run_draws(plan, "measurement", progress,
                                       [&](std::size_t draw, const host::Progress& of_draw) {
                                         L300gOptions one = options;
                                         one.draw = static_cast<std::uint32_t>(draw);
                                         return figures_of(run_l300g(one, of_draw));
                                       });
  return result;
}

host::PartialRun part_of_spread(const SpreadResult& r, const host::DrawPlan& plan) {
  return host::part_of_draws("l300g", plan, r.settings, r.measurement, measured_json);
}

SpreadResult collect_spread(const host::PartialRun& all) {
  SpreadResult r;
  r.truth = true_gear(gear_of(all.run.at("gear")));
  r.settings = all.run;
  r.options.errors = all.run.at("errors").get<std::string>();
  r.options.seed = all.run.at("seed").get<std::uint64_t>();
  r.options.probe = probe_named(all.run.at("probe").get<std::string>());
  r.options.map_radius = all.run.at("radius").get<std::string>() == "mapped";
  r.options.tracer_um = all.run.at("tracer_um").get<double>();
  r.options.rules = {
      all.run.at("touches").get<std::size_t>(),
      all.run.at("filter").get<bool>(),
      {all.run.at("teeth").get<std::size_t>(), all.run.at("points").get<std::size_t>()}};
  r.measurement = host::results_of_draws(all, measured_from);
  return r;
}

host::Verdict spread_verdict(const SpreadResult& r) {
  const double share = r.share_of_own_grades();
  const bool good = share >= kWantedShare;
  const auto worse_before = std::count_if(r.measurement.begin(), r.measurement.end(),
                                          [](const MeasuredOnce& m) { return m.before_worse; });
  return {
      good,
      fmt::format(
          "the compensated machine gives the gear its own grades in {:.0f} % of {} "
          "measurements, profile and lead ({:g} % wanted); uncompensated it gave a worse one in {}",
          100.0 * share, r.measurement.size(), 100.0 * kWantedShare, worse_before)};
}

nlohmann::json spread_document(const SpreadResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "L300G: the gear measured with a probe that scatters";
  parts.subtitle =
      "Simulated gear grinder after Yang et al.; every touch through drives, bus and node";
  parts.verdict = spread_verdict(r);
  parts.before_after = table(r);
  parts.plots = json::array({histogram(r)});
  host::Origins origins;
  origins.settings = {
      {"errors of the machine", r.options.errors},
      {"seed", fmt::format("{}, draws 0 to {}", r.options.seed, r.measurement.size() - 1)}};
  origins.inputs = r.inputs;
  origins.instruments = {
      fmt::format("touch probe of the class {}: scatter of each touch, on the "
                  "mandrel and on the gear",
                  sim::kProbeClasses.at(r.options.probe).name),
      fmt::format("tracer of the identification: {:.2g} µm of a reading", r.options.tracer_um)};
  origins.chosen = {"amounts and signs of the errors, such that they add up"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string spread_summary(const SpreadResult& r) {
  return host::terminal_text(spread_document(r, {}));
}

nlohmann::json spread_figures(const SpreadResult& r) {
  json figures = r.settings;
  figures.update({{"version", host::kVersion},
                  {"measurements", r.measurement.size()},
                  {"share_of_own_grades", r.share_of_own_grades()},
                  {"spread", host::figures_of_table(table(r))}});
  return figures;
}

}  // namespace volcomp::l300g
