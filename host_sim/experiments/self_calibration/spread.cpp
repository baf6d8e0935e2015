#include "host_sim/experiments/self_calibration/spread.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/experiments/self_calibration/figures.hpp"
#include "host_sim/experiments/self_calibration/report.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::self_calibration {
namespace {

using nlohmann::json;

constexpr double kWanted = 0.95;

std::vector<any_machine::JudgedMachine> judged(const Spread& spread) {
  std::vector<any_machine::JudgedMachine> all;
  for (const Draw& d : spread.drawn)
    all.push_back(d.judged);
  return all;
}

double mean_of(const Spread& spread, const std::function<double(const Draw&)>& value) {
  double sum = 0.0;
  for (const Draw& d : spread.drawn)
    sum += value(d);
  return sum / static_cast<double>(spread.drawn.size());
}

json means_json(const Spread& spread) {
  return {{"after_p95_um", mean_of(spread, [](const Draw& d) { return d.after.p95; })},
          {"after_max_um", mean_of(spread, [](const Draw& d) { return d.after.max; })},
          {"after_rms_um", mean_of(spread, [](const Draw& d) { return d.after.rms; })},
          {"predicted_p95_um", mean_of(spread, [](const Draw& d) { return d.predicted.p95; })},
          {"predicted_max_um", mean_of(spread, [](const Draw& d) { return d.predicted.max; })},
          {"predicted_rms_um", mean_of(spread, [](const Draw& d) { return d.predicted.rms; })},
          {"chi2_of_dof", mean_of(spread, [](const Draw& d) { return d.chi2_of_dof; })}};
}

json means_text(const Spread& spread) {
  const json m = means_json(spread);
  return host::in_summary(host::with_id(
      "means",
      host::text_section(
          "Mean over the machines",
          {fmt::format("volume after: 95 % {:.2f} um, worst {:.2f} um, root mean square {:.2f} um",
                       m["after_p95_um"].get<double>(), m["after_max_um"].get<double>(),
                       m["after_rms_um"].get<double>()),
           fmt::format("predicted: 95 % {:.2f} um, worst {:.2f} um, root mean square {:.2f} um",
                       m["predicted_p95_um"].get<double>(), m["predicted_max_um"].get<double>(),
                       m["predicted_rms_um"].get<double>()),
           fmt::format("chi-square over its degrees of freedom {:.2f}",
                       m["chi2_of_dof"].get<double>())})));
}

json settings_of(const Spread& s) {
  return {{"inputs", host::hashes_of(s.inputs)},
          {"machine", s.machine},
          {"plan", s.plan.path},
          {"seed", s.options.seed},
          {"noise", s.options.noise},
          {"places", s.options.places}};
}

json residual_numbers(const VolumeResidual& r) { return {r.rms, r.p95, r.max}; }

VolumeResidual residual_of(const json& values, const char* what) {
  const auto um = host::numbers_of<3>(values, what);
  return {um[0], um[1], um[2]};
}

json draw_json(const Draw& d) {
  json draw = any_machine::judged_json(d.judged);
  draw.update({{"after_um", residual_numbers(d.after)},
               {"predicted_um", residual_numbers(d.predicted)},
               {"chi2_and_coverage", {d.chi2_of_dof, d.coverage}}});
  return draw;
}

Draw draw_of(const json& draw) {
  const auto shares = host::numbers_of<2>(draw.at("chi2_and_coverage"), "chi2_and_coverage");
  return {any_machine::judged_of(draw), residual_of(draw.at("after_um"), "after_um"),
          residual_of(draw.at("predicted_um"), "predicted_um"), shares[0], shares[1]};
}

Draw draw_once(const Options& options, const host::Progress& progress) {
  const Result result = run_self_calibration(options, progress);
  return {{judged_figures(result), verdict(result).ok},
          result.without_unmodelled_reversal(result.after),
          result.predicted,
          misfit(result),
          result.coverage()};
}

}  // namespace

std::size_t Spread::good() const {
  return static_cast<std::size_t>(
      std::count_if(drawn.begin(), drawn.end(), [](const Draw& d) { return d.judged.good; }));
}

double Spread::coverage() const {
  return mean_of(*this, [](const Draw& d) { return d.coverage; });
}

double Spread::coverage_error() const {
  const double mean = coverage();
  const auto count = static_cast<double>(drawn.size());
  const double squares = count * mean_of(*this, [mean](const Draw& d) {
                           return (d.coverage - mean) * (d.coverage - mean);
                         });
  return drawn.size() < 2 ? 0.0 : std::sqrt(squares / (count - 1.0) / count);
}

Spread run_spread(const Options& options, const host::DrawPlan& plan,
                  const host::Progress& progress) {
  Spread spread;
  spread.options = options;
  spread.plan = host::identify::read_plan(options.plan, {{}, true});
  spread.machine = spread.plan.machine.name;
  spread.inputs = {host::hashed_file("measurement plan", options.plan),
                   host::hashed_file("machine file", spread.plan.machine.path)};
  spread.settings = settings_of(spread);
  spread.drawn = host::run_draws(plan, "machine", progress,
                                 [&](std::size_t draw, const host::Progress& of_draw) {
                                   Options one = options;
                                   one.seed = options.seed + draw;
                                   one.leave_out = false;
                                   return draw_once(one, of_draw);
                                 });
  return spread;
}

host::PartialRun part_of_spread(const Spread& spread, const host::DrawPlan& plan) {
  return host::part_of_draws("self-calibration", plan, spread.settings, spread.drawn, draw_json);
}

Spread collect_spread(const host::PartialRun& all) {
  Spread spread;
  spread.settings = all.run;
  spread.options.seed = all.run.at("seed").get<std::uint64_t>();
  spread.options.noise = all.run.at("noise").get<bool>();
  spread.machine = host::text_of_part(all.run.at("machine"), "machine");
  spread.drawn = host::results_of_draws(all, draw_of);
  any_machine::require_same_figures(judged(spread));
  return spread;
}

host::Verdict spread_verdict(const Spread& spread) {
  const auto enough = static_cast<double>(spread.drawn.size()) * kWanted;
  const bool ok = static_cast<double>(spread.good()) >= enough && spread.coverage() >= kWanted;
  return {ok, fmt::format("{} of {} machines are good, {:.1f} ± {:.1f} % of all places are within "
                          "twice their predicted uncertainty (95 % wanted of both).",
                          spread.good(), spread.drawn.size(), 100.0 * spread.coverage(),
                          100.0 * spread.coverage_error())};
}

json spread_document(const Spread& spread, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title =
      fmt::format("{}: {} machines, self-calibrated", spread.machine, spread.drawn.size());
  parts.subtitle = "Simulated machines with errors drawn at random";
  parts.verdict = spread_verdict(spread);
  parts.before_after =
      any_machine::spread_table(judged(spread), "Each with errors, places and noise of its own.");
  parts.plots = json::array({any_machine::what_is_left(judged(spread))});
  parts.details.push_back(means_text(spread));
  parts.provenance = host::provenance(run, origins(spread.options, spread.plan, spread.inputs));
  return host::report_document(std::move(parts));
}

std::string spread_summary(const Spread& spread) {
  return host::terminal_text(spread_document(spread, {}));
}

json spread_figures(const Spread& spread) {
  json out = spread.settings;
  out.update({{"machines", spread.drawn.size()},
              {"good", spread.good()},
              {"coverage", spread.coverage()},
              {"coverage_standard_error", spread.coverage_error()},
              {"mean", means_json(spread)},
              {"figures", host::figures_of_table(any_machine::spread_table(judged(spread), ""))},
              {"ok", spread_verdict(spread).ok},
              {"version", host::kVersion}});
  return out;
}

}  // namespace volcomp::self_calibration
