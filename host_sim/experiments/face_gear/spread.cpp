#include "host_sim/experiments/face_gear/spread.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "host_sim/experiments/face_gear/figures.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/gear_choice.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/range_of_draws.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

constexpr double kWantedShare = 15.0 / 16.0;

MeasuredOnce measured_once(const FaceGearResult& run) {
  MeasuredOnce once;
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    StageOnce& stage = once.stage.at(s);
    stage.map = run.map_error.at(s);
    for (std::size_t side = 0; side < 2; ++side)
      stage.pitch.at(side) =
          run.inspection.at(s).pitch.at(side).figures.total - run.true_pitch.at(side).figures.total;
    stage.profile =
        worst_profile(run.inspection.at(s)).value_or(std::numeric_limits<double>::quiet_NaN());
    once.outliers += static_cast<int>(run.inspection.at(s).outliers.size());
  }
  once.good = face_gear_verdict(run).ok;
  return once;
}

// Median, least and most; of nothing: nothing.
json range_row(const std::string& stage, const char* figure, std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  if (values.empty()) return {stage, figure, nullptr, nullptr, nullptr};
  const host::RangeOfDraws range = host::range_of_draws(values);
  return {stage, figure, range.median, range.least, range.most};
}

template <class Value>
std::vector<double> all_of(const SpreadResult& r, std::size_t stage, const Value& value) {
  std::vector<double> values;
  for (const MeasuredOnce& m : r.measurement)
    values.push_back(value(m.stage.at(stage)));
  return values;
}

json seeds_table(const SpreadResult& r) {
  json rows = json::array();
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    const auto add = [&](const char* figure, auto value) {
      rows.push_back(range_row(kFaceStages.at(s), figure, all_of(r, s, value)));
    };
    add("map − gear, rms", [](const StageOnce& o) { return o.map.rms; });
    add("map − gear, largest", [](const StageOnce& o) { return o.map.max; });
    add("F_p − gear, left", [](const StageOnce& o) { return o.pitch[0]; });
    add("F_p − gear, right", [](const StageOnce& o) { return o.pitch[1]; });
    add("profile", [](const StageOnce& o) { return o.profile; });
  }
  json made = host::table_section(
      fmt::format("{} measurements, each of another machine and gear", r.measurement.size()),
      {host::plain_column("measured with", "stage"), host::plain_column("figure", "figure"),
       host::column("median", "µm", 2, "median_um"), host::column("least", "µm", 2, "least_um"),
       host::column("most", "µm", 2, "most_um")},
      rows);
  made["name"] = "spread";
  return host::in_summary(host::with_id("spread", std::move(made), scatter_text(r.options)));
}

json map_error_histogram(const SpreadResult& r) {
  json series = json::array();
  for (std::size_t s = 0; s < kFaceStages.size(); ++s)
    series.push_back({{"name", kFaceStages.at(s)},
                      {"values", all_of(r, s, [](const StageOnce& o) { return o.map.rms; })}});
  return host::with_id("histogram", {{"type", "histogram"},
                                     {"title", "Maps from the gear, rms"},
                                     {"x", host::axis_label("map − gear, rms", "µm")},
                                     {"series", series}});
}

json settings_of(const FaceGearOptions& o, const std::vector<host::HashedInput>& inputs) {
  return {{"inputs", host::hashes_of(inputs)},
          {"gear", o.gear},
          {"flanks", o.flanks},
          {"form", kFormTruths.at(static_cast<std::size_t>(o.form))},
          {"seed", o.seed},
          {"cycle_hz", o.cycle_hz},
          {"probe", sim::kProbeClasses.at(o.probe).name},
          {"radius", o.map_radius ? "mapped" : "file"},
          {"touches", o.touches},
          {"tracer_um", o.tracer_um}};
}

std::size_t class_named(const std::string& name) {
  for (std::size_t i = 0; i < sim::kProbeClasses.size(); ++i)
    if (name == sim::kProbeClasses.at(i).name) return i;
  throw host::UserError("the parts are of a probe that is not known");
}

json stage_json(const StageOnce& o) {
  return {{"map_um", {o.map.rms, o.map.max}},
          {"pitch_um", o.pitch},
          {"profile_um", std::isnan(o.profile) ? json(nullptr) : json(o.profile)}};
}

StageOnce stage_of(const json& j) {
  const std::array<double, 2> map = host::numbers_of<2>(j.at("map_um"), "map_um");
  StageOnce o;
  o.map = {map[0], map[1]};
  o.pitch = host::numbers_of<2>(j.at("pitch_um"), "pitch_um");
  o.profile = j.at("profile_um").is_null()
                  ? std::numeric_limits<double>::quiet_NaN()
                  : host::numbers_of<1>(json::array({j.at("profile_um")}), "profile_um")[0];
  return o;
}

json measured_json(const MeasuredOnce& m) {
  json stages = json::array();
  for (const StageOnce& stage : m.stage)
    stages.push_back(stage_json(stage));
  return {{"stage", std::move(stages)}, {"outliers", m.outliers}, {"good", m.good}};
}

MeasuredOnce measured_of(const json& j) {
  MeasuredOnce once;
  for (std::size_t s = 0; s < once.stage.size(); ++s)
    once.stage.at(s) = stage_of(j.at("stage").at(s));
  once.outliers = j.at("outliers").get<int>();
  once.good = j.at("good").get<bool>();
  return once;
}

int outliers_of(const SpreadResult& r) {
  int all = 0;
  for (const MeasuredOnce& m : r.measurement)
    all += m.outliers;
  return all;
}

}  // namespace

std::size_t SpreadResult::good() const {
  return static_cast<std::size_t>(std::count_if(measurement.begin(), measurement.end(),
                                                [](const MeasuredOnce& m) { return m.good; }));
}

SpreadResult run_spread(const FaceGearOptions& options, const host::DrawPlan& plan,
                        const host::Progress& progress) {
  SpreadResult result;
  result.options = options;
  result.inputs = {host::hashed_file("machine file", options.machine)};
  if (!host::is_published_gear(options.gear))
    result.inputs.push_back(host::hashed_file("gear", options.gear));
  result.settings = settings_of(options, result.inputs);
  result.measurement = host::run_draws(plan, "measurement", progress,
                                       [&](std::size_t draw, const host::Progress& of_draw) {
                                         FaceGearOptions one = options;
                                         one.seed += draw;
                                         return measured_once(run_face_gear(one, of_draw));
                                       });
  return result;
}

host::PartialRun part_of_spread(const SpreadResult& r, const host::DrawPlan& plan) {
  return host::part_of_draws("face-gear", plan, r.settings, r.measurement, measured_json);
}

SpreadResult collect_spread(const host::PartialRun& all) {
  SpreadResult r;
  r.settings = all.run;
  r.options.gear = all.run.at("gear").get<std::string>();
  r.options.seed = all.run.at("seed").get<std::uint64_t>();
  r.options.probe = class_named(all.run.at("probe").get<std::string>());
  r.options.touches = all.run.at("touches").get<int>();
  r.options.tracer_um = all.run.at("tracer_um").get<double>();
  r.measurement = host::results_of_draws(all, measured_of);
  return r;
}

host::Verdict spread_verdict(const SpreadResult& r) {
  const std::size_t all = r.measurement.size();
  const double share = static_cast<double>(r.good()) / static_cast<double>(all);
  return {share >= kWantedShare,
          fmt::format("{} of {} measurements are good, frame, maps and pitch of the compensated "
                      "machine (15 of 16 wanted); points whose touches are too far apart: {}",
                      r.good(), all, outliers_of(r))};
}

nlohmann::json spread_document(const SpreadResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "YK7280: face gears measured on their machines";
  parts.subtitle = "Errors of machine and gear, and scatter, from another seed each time";
  parts.verdict = spread_verdict(r);
  parts.before_after = seeds_table(r);
  parts.plots = json::array({map_error_histogram(r)});
  host::Origins origins;
  origins.settings = {{"gear", r.options.gear},
                      {"seeds", fmt::format("{} to {}", r.options.seed,
                                            r.options.seed + r.measurement.size() - 1)}};
  origins.inputs = r.inputs;
  origins.instruments = {scatter_text(r.options)};
  origins.chosen = {kChosenText};
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
                  {"good", r.good()},
                  {"outliers", outliers_of(r)},
                  {"spread", host::figures_of_table(seeds_table(r))}});
  return figures;
}

}  // namespace volcomp::face_gear
