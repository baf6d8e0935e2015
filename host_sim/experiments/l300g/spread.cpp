#include "host_sim/experiments/l300g/spread.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/experiments/l300g/machine_errors.hpp"

namespace volcomp::l300g {
namespace {

using nlohmann::json;

bool worse(const std::optional<int>& a, const std::optional<int>& b) {
  return a.value_or(99) > b.value_or(99);
}

MeasuredOnce figures_of(const L300gResult& r) {
  MeasuredOnce m;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    m.profile[side] = r.after.profile[side].figures.total;
    m.lead[side] = r.after.lead[side].figures.total;
    m.pitch[side] = r.after.pitch[side].figures.total;
    m.own_profile[side] = r.after.profile[side].grade_1995 == r.truth.profile[side].grade_1995;
    m.own_lead[side] = r.after.lead[side].grade_1995 == r.truth.lead[side].grade_1995;
    m.before_worse = m.before_worse ||
                     worse(r.before.profile[side].grade_1995, r.truth.profile[side].grade_1995) ||
                     worse(r.before.lead[side].grade_1995, r.truth.lead[side].grade_1995);
  }
  m.profile_teeth = r.after.profile_teeth;
  m.lead_teeth = r.after.lead_teeth;
  if (r.on_centre) {
    const auto total = [](const host::FlankTrace& trace) { return trace.figures.total; };
    m.on_centre = {total(r.on_centre->profile[0]), total(r.on_centre->profile[1]),
                   total(r.on_centre->lead[0]), total(r.on_centre->lead[1])};
  }
  return m;
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
          {"own_profile", m.own_profile},
          {"own_lead", m.own_lead},
          {"on_centre_um", m.on_centre ? json(*m.on_centre) : json()},
          {"profile_teeth", teeth_of(m.profile_teeth)},
          {"lead_teeth", teeth_of(m.lead_teeth)}};
}

MeasuredOnce measured_from(const json& m) {
  const json& centre = m.at("on_centre_um");
  return {host::numbers_of<2>(m.at("profile_um"), "profile_um"),
          host::numbers_of<2>(m.at("lead_um"), "lead_um"),
          host::numbers_of<2>(m.at("pitch_um"), "pitch_um"),
          m.at("before_worse").get<bool>(),
          m.at("own_profile").get<std::array<bool, 2>>(),
          m.at("own_lead").get<std::array<bool, 2>>(),
          teeth_from(m.at("profile_teeth")),
          teeth_from(m.at("lead_teeth")),
          centre.is_null() ? std::optional<std::array<double, 4>>{}
                           : host::numbers_of<4>(centre, "on_centre_um")};
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
                                 [](const MeasuredOnce& m) { return m.own_grades(); });
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

}  // namespace volcomp::l300g
