// The tables, the picture and the verdict of machines.hpp.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/experiments/xyfz/charts.hpp"
#include "host_sim/experiments/xyfz/machines.hpp"
#include "host_sim/experiments/xyfz/report.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

constexpr std::size_t kPaperModel = 1;  // of ModelKind
constexpr std::size_t kClosedModel = 2;
constexpr double kWantedMachines = 0.9;
constexpr double kMedian = 0.5;
constexpr double kFewest = 0.05;  // quantile that all but few campaigns reach

json quantile_or_null(const std::vector<DrawResult>& draws, std::size_t model, double fraction) {
  return draws.empty() ? json() : json(rate_quantile(draws, model, fraction));
}

// A row a model: the machines beside each other without noise, all campaigns with noise.
json models_of_machines(const MachinesResult& r) {
  const std::vector<DrawResult> noise_free = r.all_noise_free();
  const std::vector<DrawResult> draws = r.all_draws();
  json rows = json::array();
  for (std::size_t m = 0; m + 1 < kModeNames.size(); ++m)
    rows.push_back({kModeTitles.at(m + 1), kModeNames.at(m + 1),
                    rate_quantile(noise_free, m, kMedian), rate_quantile(noise_free, m, 0.0),
                    rate_quantile(noise_free, m, 1.0), quantile_or_null(draws, m, kMedian),
                    quantile_or_null(draws, m, kFewest), r.reaching(m)});
  json columns =
      json::array({host::plain_column("reduction on PNP"), host::hidden_column("model"),
                   host::column("noise-free: median", "%", 2, "noise_free/median"),
                   host::column("least", "%", 2, "noise_free/least"),
                   host::column("most", "%", 2, "noise_free/most"),
                   host::column("campaigns: median", "%", 2, "campaigns/median"),
                   host::column("5 % quantile", "%", 2, "campaigns/p05"),
                   host::plain_column(fmt::format("machines that reach {} %", kPaperRate),
                                      "machines_reaching_paper")});
  json table = host::table_section(fmt::format("The models on {} machines", r.machine.size()),
                                   std::move(columns), std::move(rows));
  table["name"] = "models";
  return host::with_id(
      "models", table,
      "Noise-free: one figure a machine. Campaigns: all of all machines together. A machine "
      "reaches it where its median campaign does, or without noise its only one.");
}

json machine_rows(const MachinesResult& r) {
  json rows = json::array();
  for (const StudiedMachine& m : r.machine) {
    json row = {m.seed};
    for (const std::size_t model : {kPaperModel, kClosedModel}) {
      row.push_back(m.noise_free.rate(model));
      row.push_back(quantile_or_null(m.draws, model, kMedian));
      row.push_back(quantile_or_null(m.draws, model, kFewest));
    }
    row.push_back(
        m.draws.empty() ? json() : json(100.0 * share_reaching(m.draws, kClosedModel, kPaperRate)));
    row.push_back(m.noise_free.residual_um);
    row.push_back(m.tuning.angle_scale);
    row.push_back(m.tuning.scale_error);
    rows.push_back(std::move(row));
  }
  return rows;
}

json table_of_machines(const MachinesResult& r) {
  json table =
      host::table_section("Machine by machine",
                          {host::plain_column("machine seed", "machine_seed"),
                           host::column("paper: noise-free", "%", 2, "abbe/noise_free"),
                           host::column("paper: median", "%", 2, "abbe/median"),
                           host::column("paper: 5 %", "%", 2, "abbe/p05"),
                           host::column("closed: noise-free", "%", 2, "abbe_closed/noise_free"),
                           host::column("closed: median", "%", 2, "abbe_closed/median"),
                           host::column("closed: 5 %", "%", 2, "abbe_closed/p05"),
                           host::column(fmt::format("campaigns that reach {} %", kPaperRate), "%",
                                        0, "abbe_closed/percent_reaching_paper"),
                           host::hidden_column("noise_free_residual_um"),
                           host::hidden_column("angle_scale"), host::hidden_column("scale_error")},
                          machine_rows(r));
  table["name"] = "machines";
  const std::string noise =
      r.options.draws == 0
          ? "without noise"
          : fmt::format("without noise, and median and 5 % quantile of {} campaigns",
                        r.options.draws);
  return host::with_id(
      "machines", table,
      fmt::format("Reduction of the PNP maximum by the Abbe model as in the paper and by the one "
                  "with squareness closed: {}. Machines: the error functions of a seed, tuned, as "
                  "a perfect ball bar along lines would find them, to {} µm on PNP and {} µm left "
                  "by the naive model.",
                  noise, kPaperRaw_um, kPaperNaive_um));
}

json chart_of_machines(const MachinesResult& r) {
  std::vector<double> seeds;
  json series = json::array();
  for (const std::size_t model : {kPaperModel, kClosedModel}) {
    std::vector<double> rates;
    for (const StudiedMachine& m : r.machine)
      rates.push_back(m.draws.empty() ? m.noise_free.rate(model)
                                      : rate_quantile(m.draws, model, kMedian));
    series.push_back(host::bars_of(kModeNames.at(model + 1), rates));
  }
  for (const StudiedMachine& m : r.machine)
    seeds.push_back(static_cast<double>(m.seed));
  json chart =
      host::bar_chart("machines-chart",
                      r.options.draws == 0 ? "Each machine, noise-free" : "Median of each machine",
                      seeds, host::axis_label("reduction of the PNP maximum", "%"), series,
                      fmt::format("By machine seed. Line: the paper's {} %.", kPaperRate));
  chart["limit"] = kPaperRate;
  return chart;
}

json histogram_of_campaigns(const MachinesResult& r) {
  json series = json::array();
  for (const std::size_t model : {kPaperModel, kClosedModel}) {
    std::vector<double> rates;
    for (const DrawResult& d : r.all_draws())
      rates.push_back(d.rate(model));
    series.push_back(host::bars_of(kModeNames.at(model + 1), rates));
  }
  return {{"type", "histogram"},
          {"id", "campaigns"},
          {"title", fmt::format("{} noisy campaigns on {} machines",
                                r.options.machines * r.options.draws, r.machine.size())},
          {"x", host::axis_label("reduction of the PNP maximum", "%")},
          {"series", series},
          {"limit", kPaperRate}};
}

host::Origins origins_of(const MachinesResult& r) {
  host::Origins o;
  o.data = "simulated: no machine was measured; the paper's own curves are not available";
  o.settings = {
      {"noise seed", std::to_string(r.options.seed)},
      {"machine seeds", fmt::format("{} to {}", r.machine.front().seed, r.machine.back().seed)},
      {"noisy campaigns", fmt::format("{} on each machine", r.options.draws)}};
  if (!r.passed_over.empty())
    o.settings.emplace_back("machine seeds passed over, no machine with the paper's raw figures",
                            fmt::format("{}", fmt::join(r.passed_over, ", ")));
  o.inputs = r.inputs;
  o.instruments = instruments_of(r.options, r.noise);
  o.tuned = {
      fmt::format("angle scale and scale error of X of each machine, so that PNP reads {} "
                  "µm and the naive model leaves {} µm",
                  kPaperRaw_um, kPaperNaive_um)};
  o.chosen = {
      "amplitudes of the error functions by class; squareness so that a perfect ball bar "
      "along lines reads the values of the machine file"};
  o.untouched = {"the residuals of the two Abbe models"};
  return o;
}

}  // namespace

host::Verdict machines_verdict(const MachinesResult& r) {
  const std::size_t closed = r.reaching(kClosedModel);
  const std::size_t paper = r.reaching(kPaperModel);
  const auto wanted = kWantedMachines * static_cast<double>(r.machine.size());
  host::Verdict v;
  v.ok = static_cast<double>(closed) >= wanted && closed >= paper;
  v.text = fmt::format(
      "{} the closed model reaches the paper's {} % on {} of {} machines ({:g} % wanted), the "
      "paper's own variant on {}.",
      r.options.draws == 0 ? "Noise-free" : "In its median campaign", kPaperRate, closed,
      r.machine.size(), 100.0 * kWantedMachines, paper);
  const std::vector<DrawResult> draws = r.all_draws();
  if (!draws.empty())
    v.text += fmt::format(
        " Of all {} campaigns the closed model removes {:.1f} % in the median and {:.1f} % at the "
        "5 % quantile, the paper's variant {:.1f} and {:.1f} %.",
        draws.size(), rate_quantile(draws, kClosedModel, kMedian),
        rate_quantile(draws, kClosedModel, kFewest), rate_quantile(draws, kPaperModel, kMedian),
        rate_quantile(draws, kPaperModel, kFewest));
  return v;
}

json machines_document(const MachinesResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "XYFZ machine: the same campaigns on many machines";
  parts.subtitle =
      "Simulated three-axis machines after Zhao et al. 2020, each tuned to the paper's two raw "
      "figures, measured, tabled, compensated, measured again";
  parts.verdict = machines_verdict(r);
  parts.before_after = models_of_machines(r);
  parts.plots = json::array({chart_of_machines(r)});
  if (r.options.draws > 0) parts.plots.push_back(histogram_of_campaigns(r));
  parts.details = json::array({host::in_summary(table_of_machines(r)),
                               host::in_summary(functionals_table(r.all_functionals()))});
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins_of(r));
  return host::report_document(std::move(parts));
}

std::string machines_summary(const MachinesResult& r) {
  return host::terminal_text(machines_document(r, {}));
}

json machines_figures(const MachinesResult& r) {
  json figures = r.settings;
  // "machines" is their list there, their number is its length.
  figures.erase("machines");
  figures["machines"] = host::figures_of_table(table_of_machines(r));
  figures["models"] = host::figures_of_table(models_of_machines(r));
  figures["circles_less_lines"] = host::figures_of_table(functionals_table(r.all_functionals()));
  figures["passed_over"] = r.passed_over;
  figures["version"] = host::kVersion;
  return figures;
}

}  // namespace volcomp::xyfz
