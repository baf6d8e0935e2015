// The tables, the pictures and the verdict of paper_figures.hpp.

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/charts.hpp"
#include "host_sim/experiments/xyfz/paper_figures.hpp"
#include "host_sim/experiments/xyfz/report.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

constexpr double kAgree_um = 0.01;
constexpr double kPredict_um = 1.0;
constexpr double kPaperPredictedNaive_um = 47.51;
constexpr double kPaperPredictedAbbe_um = 42.61;
constexpr double kPaperLeftAbbe_um = 5.32;

constexpr std::array<const char*, kLeverNoises> kLeverNoiseNames{"none", "instrument",
                                                                 "instrument_and_temperature"};
constexpr std::array<const char*, kLeverNoises> kLeverNoiseTitles{
    "none", "laser and repeatability", "the same, 0.1 K between set-ups"};

template <class Each, class Value>
std::vector<double> values_of(const std::vector<Each>& draws, const Value& value) {
  std::vector<double> values(draws.size());
  std::transform(draws.begin(), draws.end(), values.begin(), value);
  return values;
}

const std::vector<LeverReadings>& noisiest(const LeverResult& lever) {
  return lever.readings.back().empty() ? lever.readings.front() : lever.readings.back();
}

json lever_row(const LeverResult& lever, std::size_t noise) {
  const std::vector<LeverReadings>& draws = lever.readings.at(noise);
  const std::vector<double> carried =
      values_of(draws, [](const LeverReadings& r) { return r.carried_apart_um(); });
  const auto measured =
      values_of(draws, [](const LeverReadings& r) { return r.measured_apart_um(); });
  const auto found = values_of(draws, [](const LeverReadings& r) { return r.found_mm; });
  const auto with = [&](Reason reason) {
    return std::count_if(draws.begin(), draws.end(),
                         [reason](const LeverReadings& r) { return r.test == reason; });
  };
  const LeverExperiment& e = lever.experiment;
  return {e.name,
          kLeverNoiseTitles.at(noise),
          kLeverNoiseNames.at(noise),
          quantile(measured, 0.5),
          quantile(carried, 0.5),
          quantile(carried, 0.0),
          quantile(carried, 1.0),
          quantile(carried, 0.95),
          e.paper_um,
          e.lever_mm(),
          quantile(found, 0.5),
          quantile(found, 0.0),
          quantile(found, 1.0),
          with(Reason::ok),
          with(Reason::lever_spread_too_small),
          with(Reason::lever_mismatch)};
}

json levers_of(const PaperFigures& r) {
  json rows = json::array();
  for (const LeverResult& lever : r.levers)
    for (std::size_t noise = 0; noise < kLeverNoises; ++noise)
      if (!lever.readings.at(noise).empty()) rows.push_back(lever_row(lever, noise));
  json columns =
      json::array({host::plain_column("X measured", "experiment"), host::plain_column("noise"),
                   host::hidden_column("noise"), host::column("apart", "µm", 2, "measured_um"),
                   host::column("carried: median", "µm", 2, "carried_um/median"),
                   host::column("least", "µm", 2, "carried_um/least"),
                   host::column("most", "µm", 2, "carried_um/most"),
                   host::column("95 %", "µm", 2, "carried_um/p95"),
                   host::column("paper within", "µm", 1, "paper_um"),
                   host::column("lever", "mm", 0, "lever_mm"),
                   host::column("found: median", "mm", 1, "found_mm/median"),
                   host::column("least", "mm", 1, "found_mm/least"),
                   host::column("most", "mm", 1, "found_mm/most"),
                   host::plain_column("self-test good", "self_test/good"),
                   host::plain_column("undecided", "self_test/undecided"),
                   host::plain_column("wrong", "self_test/wrong")});
  json table =
      host::table_section("Positioning at several levers", std::move(columns), std::move(rows));
  table["name"] = "levers";
  return host::with_id(
      "levers", table,
      fmt::format(
          "Largest difference between two places at any target, as measured and carried "
          "to one point by the measured angles; {} draws. Lever: between the first place "
          "and the last, stated, and found by the self-test, which regresses on the angles; "
          "it is undecided where noise hides half the lever.",
          r.options.draws));
}

template <class Value>
json prediction_row(const PaperFigures& r, const std::string& what, const char* name,
                    const std::optional<double>& paper, const Value& value) {
  json row = {what, name, paper ? json(*paper) : json(), value(r.noise_free)};
  const std::vector<double> values = values_of(r.prediction, value);
  for (const double fraction : {0.5, 0.0, 1.0})
    row.push_back(values.empty() ? json() : json(quantile(values, fraction)));
  return row;
}

json prediction_of(const PaperFigures& r) {
  constexpr std::array<std::optional<double>, kModels.size()> predicted{
      kPaperPredictedNaive_um, kPaperPredictedAbbe_um, std::nullopt};
  constexpr std::array<std::optional<double>, kModels.size()> left{kPaperNaive_um,
                                                                   kPaperLeftAbbe_um, std::nullopt};
  json rows = json::array();
  rows.push_back(prediction_row(r, "measured", "measured", kPaperRaw_um,
                                [](const Prediction& p) { return p.measured_max_um(); }));
  for (std::size_t m = 0; m < kModels.size(); ++m)
    rows.push_back(prediction_row(r, fmt::format("predicted, {}", kModeTitles.at(m + 1)),
                                  kModeNames.at(m + 1), predicted.at(m),
                                  [m](const Prediction& p) { return p.predicted_max_um(m); }));
  for (std::size_t m = 0; m < kModels.size(); ++m)
    rows.push_back(prediction_row(r, fmt::format("measured − predicted, {}", kModeTitles.at(m + 1)),
                                  kModeNames.at(m + 1), left.at(m),
                                  [m](const Prediction& p) { return p.left_um(m); }));
  json columns = json::array(
      {host::plain_column("largest on PNP", "what"), host::hidden_column("model"),
       host::column("paper", "µm", 2, "paper_um"),
       host::column("noise-free", "µm", 2, "noise_free_um"),
       host::column("median", "µm", 2, "median_um"), host::column("least", "µm", 2, "least_um"),
       host::column("most", "µm", 2, "most_um")});
  json table = host::table_section("Predicted and measured body diagonal", std::move(columns),
                                   std::move(rows));
  table["name"] = "prediction";
  return host::with_id("prediction", table,
                       "Magnitudes. Subtracted off line, as in the paper: nothing was moved by "
                       "an offset.");
}

json lever_chart(const LeverResult& lever) {
  const LeverReadings& first = noisiest(lever).front();
  const auto chart = [&](const char* which, const LeverCurves& curves) {
    json series = json::array();
    for (std::size_t p = 0; p < curves.size(); ++p) {
      const Vec3& place = lever.experiment.place[p];
      const std::string name = lever.experiment.angle == 0
                                   ? fmt::format("height {:g} mm", place.z())
                                   : fmt::format("sideways {:g} mm", place.y());
      series.push_back(host::series_of(name.c_str(), first.position_mm, curves[p]));
    }
    return host::lines_chart(fmt::format("{}-{}", which, lever.experiment.angle), which,
                             host::axis_label("X", "mm"), host::axis_label("positioning", "µm"),
                             series);
  };
  return host::chart_group(
      fmt::format("levers-{}", lever.experiment.angle),
      fmt::format("Positioning of X measured {}", lever.experiment.name),
      json::array({chart("measured", first.measured), chart("carried", first.carried)}),
      "Means of all runs, one draw. Carried: to one point, by the angles of the same set-up.");
}

// The noise-free curves, and how far those of the draws reach.
json prediction_chart(const PaperFigures& r) {
  const auto banded = [&](const char* name, const std::vector<double>& curve, const auto& of_draw) {
    json series = host::series_of(name, r.noise_free.distance_mm, curve);
    if (r.prediction.empty()) return series;
    std::vector<double> lo = of_draw(r.prediction.front());
    std::vector<double> hi = lo;
    for (const Prediction& p : r.prediction)
      for (std::size_t i = 0; i < lo.size(); ++i) {
        lo[i] = std::min(lo[i], of_draw(p)[i]);
        hi[i] = std::max(hi[i], of_draw(p)[i]);
      }
    series["band"] = {{"lo", lo}, {"hi", hi}};
    return series;
  };
  json series = json::array({banded("measured", r.noise_free.measured_um,
                                    [](const Prediction& p) { return p.measured_um; })});
  for (std::size_t m = 0; m < kModels.size(); ++m)
    series.push_back(banded(kModeNames.at(m + 1), r.noise_free.predicted_um.at(m),
                            [m](const Prediction& p) { return p.predicted_um.at(m); }));
  return host::lines_chart(
      "pnp-predicted", "PNP: measured, and predicted by each model",
      host::axis_label("distance", "mm"), host::axis_label("deviation", "µm"), series,
      fmt::format("Curves: without noise. Bands: from the least to the most of {} draws.",
                  r.prediction.size()));
}

double median_carried_um(const LeverResult& lever) {
  return quantile(
      values_of(noisiest(lever), [](const LeverReadings& r) { return r.carried_apart_um(); }), 0.5);
}

bool levers_good(const LeverResult& lever) {
  const LeverReadings& noise_free = lever.readings.front().front();
  return noise_free.test == Reason::ok && noise_free.carried_apart_um() <= kAgree_um &&
         median_carried_um(lever) <= lever.experiment.paper_um;
}

host::Origins origins_of_figures(const PaperFigures& r) {
  host::Origins o;
  o.data = "simulated: no machine was measured; the paper's own curves are not available";
  o.settings = {{"noise seed", std::to_string(r.options.seed)},
                {"machine seed", std::to_string(r.options.machine_seed)},
                {"draws", std::to_string(r.options.draws)}};
  o.inputs = r.inputs;
  o.instruments = instruments_of(r.options, r.noise);
  for (const json& text : tuned_text(r.tuning))
    o.tuned.push_back(text);
  o.chosen = {
      "amplitudes of the error functions by class; squareness so that a perfect ball bar "
      "along lines reads the values of the machine file"};
  o.untouched = {"readings at the levers, and what the models predict"};
  return o;
}

}  // namespace

host::Verdict paper_figures_verdict(const PaperFigures& r) {
  host::Verdict v;
  v.ok = r.noise_free.left_um(kModels.size() - 1) <= kPredict_um;
  v.text = "Carried to one point, positioning of X agrees";
  for (const LeverResult& lever : r.levers) {
    v.ok = v.ok && levers_good(lever);
    v.text += fmt::format("{} to {:.2f} µm {} (the paper's to {:g})",
                          &lever == &r.levers.front() ? "" : " and", median_carried_um(lever),
                          lever.experiment.name, lever.experiment.paper_um);
  }
  v.text += fmt::format(
      "{}. PNP predicted {:.2f} µm by the naive and {:.2f} µm by the paper's model (the paper: {} "
      "and {}), measured {:.2f}, noise-free.",
      r.options.draws == 0 ? ", noise-free" : fmt::format(", median of {} draws", r.options.draws),
      r.noise_free.predicted_max_um(0), r.noise_free.predicted_max_um(1), kPaperPredictedNaive_um,
      kPaperPredictedAbbe_um, r.noise_free.measured_max_um());
  return v;
}

json paper_figures_document(const PaperFigures& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "XYFZ machine: readings at several levers, and the predicted diagonal";
  parts.subtitle =
      "Simulated three-axis machine after Zhao et al. 2020, its Figs. 8, 11, 19 and 20";
  parts.verdict = paper_figures_verdict(r);
  parts.before_after = levers_of(r);
  parts.plots = json::array();
  for (const LeverResult& lever : r.levers)
    parts.plots.push_back(lever_chart(lever));
  parts.plots.push_back(prediction_chart(r));
  parts.details = json::array({host::in_summary(prediction_of(r))});
  parts.provenance = host::provenance(run, origins_of_figures(r));
  return host::report_document(std::move(parts));
}

std::string paper_figures_summary(const PaperFigures& r) {
  return host::terminal_text(paper_figures_document(r, {}));
}

json paper_figures_json(const PaperFigures& r) {
  return {{"levers", host::figures_of_table(levers_of(r))},
          {"prediction", host::figures_of_table(prediction_of(r))},
          {"draws", r.options.draws},
          {"seed", r.options.seed},
          {"machine_seed", r.options.machine_seed},
          {"tuned", tuned_text(r.tuning)},
          {"version", host::kVersion}};
}

}  // namespace volcomp::xyfz
