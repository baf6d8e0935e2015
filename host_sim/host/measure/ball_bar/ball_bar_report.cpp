// A circular test as text, as JSON and as a page with the circle drawn.

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_evaluation.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 2> kTravelled{"counter-clockwise", "clockwise"};

double um(double mm) { return kUmPerMm * mm; }
double urad(double rad) { return kUradPerRad * rad; }

json in_um(const std::array<double, 2>& mm) { return json::array({um(mm[0]), um(mm[1])}); }

std::string circles_in_words(const BallBarTest& test) {
  std::string text;
  for (std::size_t d = 0; d < test.circle.size(); ++d) {
    const auto& circles = test.circle.at(d);
    if (circles.empty()) continue;
    text += fmt::format("{}{} {} of {} readings", text.empty() ? "" : ", ", circles.size(),
                        kTravelled.at(d), circles.front().theta.size());
  }
  return text;
}

std::string conditions(const BallBarTest& test) {
  std::string text = fmt::format("plane {}, radius {:g} mm", *test.plane, *test.radius);
  if (test.feed) text += fmt::format(", {:g} mm/min", *test.feed);
  if (test.temperature) text += fmt::format(", {:g} °C", *test.temperature);
  return text;
}

// One figure: raw, and what its interval says.
json figure_row(const std::string& name, double raw_mm, const FigureInterval* interval) {
  json row = json::array({name, um(raw_mm)});
  for (int i = 0; i < 4; ++i)
    row.push_back(nullptr);
  if (interval == nullptr) return row;
  // Without any interval above the noise nothing is said to be there: no 0.00.
  const auto shown = [](double mm) {
    return mm > 0.0 ? json(fmt::format("{:.2f}", um(mm))) : json("below the noise");
  };
  row[2] = shown(interval->corrected);
  row[3] = um(interval->low);
  row[4] = um(interval->high);
  row[5] = shown(interval->upper95);
  return row;
}

json figures_table(const BallBarTest& test, const BallBarEvaluation& e) {
  const std::string plane = *test.plane;
  const std::string back{plane[1], plane[0]};
  const std::array<std::string, 2> order{plane, back};
  json rows = json::array();
  for (std::size_t d = 0; d < e.path.size(); ++d) {
    if (!e.path.at(d)) continue;
    const FigureInterval* interval =
        e.intervals ? (d == 0 ? &e.intervals->ccw : &e.intervals->cw) : nullptr;
    rows.push_back(figure_row("G_" + order.at(d), e.path.at(d)->figures.circular, interval));
  }
  if (e.both)
    rows.push_back(
        figure_row("G(b)_" + plane, e.both->circular, e.intervals ? &e.intervals->both : nullptr));
  for (std::size_t d = 0; d < e.path.size(); ++d) {
    if (!e.path.at(d)) continue;
    const CircleFigures& f = e.path.at(d)->figures;
    rows.push_back(figure_row("F_max_" + order.at(d), f.radial_max, nullptr));
    rows.push_back(figure_row("F_min_" + order.at(d), f.radial_min, nullptr));
    rows.push_back(figure_row("F_max_" + order.at(d) + " centred", f.centred_max, nullptr));
    rows.push_back(figure_row("F_min_" + order.at(d) + " centred", f.centred_min, nullptr));
  }
  if (e.both && test.calibrated)
    rows.push_back(figure_row("D_" + plane, e.both->radius_deviation, nullptr));
  json table = table_section("Figures after ISO 230-4",
                             {plain_column("figure", "figure"), column("value", "µm", 2, "um"),
                              column("corrected", "µm", 2), column("95 % from", "µm", 2),
                              column("to", "µm", 2), column("upper bound", "µm", 2)},
                             std::move(rows));
  table["name"] = "figures";
  return with_id("figures", std::move(table),
                 "G: circular deviation about the centre of least squares; F: radial deviation "
                 "about the centre of the instrument, and centred; a G of noisy readings is too "
                 "large, the corrected value is not. The centre of least squares is the usual "
                 "practical form of the standard's least separation.");
}

class Parts {
 public:
  Parts(const BallBarTest& test, const BallBarEvaluation& e) : test_(test), e_(e) {}

  json table() {
    const CircleParameters& p = e_.decomposition.value;
    const CircleParameters& u = e_.decomposition.u;
    const std::string first(1, (*test_.plane)[0]);
    const std::string second(1, (*test_.plane)[1]);
    const bool both = test_.both();
    add(e_.squareness, urad(p.squareness), urad(e_.u_squareness), "µrad");
    add("scale mismatch " + first + " − " + second, urad(p.scale_mismatch), urad(u.scale_mismatch),
        "µm/m");
    if (both) {
      add("servo mismatch " + first + " − " + second, 1e3 * p.servo_mismatch,
          1e3 * u.servo_mismatch, "ms");
      for (std::size_t i = 0; i < 2; ++i)
        add("reversal " + (i == 0 ? first : second), um(p.reversal.at(i)), um(u.reversal.at(i)),
            "µm");
      for (std::size_t i = 0; i < 2; ++i)
        add("lateral play " + (i == 0 ? first : second), um(p.lateral.at(i)), um(u.lateral.at(i)),
            "µm");
    }
    for (std::size_t i = 0; i < 2; ++i)
      if (e_.settings.cyclic_wavelength.at(i) > 0.0)
        add(fmt::format("cyclic {} at {:g} mm", i == 0 ? first : second,
                        e_.settings.cyclic_wavelength.at(i)),
            um(e_.decomposition.cyclic.at(i)), std::nullopt, "µm");
    if (test_.calibrated) add("radius − nominal", um(p.radius), um(u.radius), "µm");
    add("socket " + first, um(p.centre[0]), um(u.centre[0]), "µm");
    add("socket " + second, um(p.centre[1]), um(u.centre[1]), "µm");
    add("left over, rms", um(e_.decomposition.rms), std::nullopt, "µm");
    json table = table_section("What the form of the circles tells",
                               {plain_column("part", "part"), column("value", "", 2, "value"),
                                column("u", "", 2, "u"), plain_column("unit", "unit")},
                               std::move(rows_));
    table["name"] = "parts";
    return with_id(
        "parts", std::move(table),
        fmt::format("u: standard uncertainty from what is left over{}. A sensor off by ± {:g} µm "
                    "could add {:.1f} µrad to the squareness at worst.",
                    e_.u_squareness > e_.decomposition.u.squareness
                        ? ", of the squareness from the spread between circles"
                        : "",
                    um(kBallBarSensor), urad(e_.sensor_squareness)));
  }

 private:
  void add(const std::string& name, double value, std::optional<double> u, const char* unit) {
    rows_.push_back({name, value, u ? json(*u) : json(), unit});
  }

  const BallBarTest& test_;
  const BallBarEvaluation& e_;
  json rows_ = json::array();
};

json spikes_table(const BallBarEvaluation& e) {
  json rows = json::array();
  for (std::size_t d = 0; d < e.path.size(); ++d) {
    if (!e.path.at(d)) continue;
    json row = json::array({kTravelled.at(d)});
    for (const CircleSpike& spike : e.path.at(d)->spikes)
      row.push_back(spike.known ? json(um(spike.height)) : json());
    rows.push_back(row);
  }
  json table = table_section("Spikes where an axis turns",
                             {plain_column("direction", "direction"), column("0°", "µm", 2, "at/0"),
                              column("90°", "µm", 2, "at/1"), column("180°", "µm", 2, "at/2"),
                              column("270°", "µm", 2, "at/3")},
                             std::move(rows));
  table["name"] = "spikes";
  return with_id("spikes", std::move(table));
}

json polar_chart(const BallBarEvaluation& e) {
  json series = json::array();
  for (std::size_t d = 0; d < e.path.size(); ++d) {
    if (!e.path.at(d)) continue;
    series.push_back(series_of(kTravelled.at(d), scaled(e.path.at(d)->theta, kDegPerRad),
                               scaled(e.path.at(d)->centred, kUmPerMm)));
  }
  return with_id("circle",
                 {{"type", "polar"},
                  {"title", "Circles, radial deviation"},
                  {"x", axis_label("angle", "°")},
                  {"y", axis_label("radial deviation", "µm")},
                  {"series", series}},
                 "About the centre of least squares of each direction; mean of all circles.");
}

json residual_chart(const BallBarEvaluation& e) {
  json series = json::array();
  for (std::size_t d = 0; d < e.path.size(); ++d) {
    if (!e.path.at(d)) continue;
    json one = series_of(kTravelled.at(d), scaled(e.path.at(d)->theta, kDegPerRad),
                         scaled(e.path.at(d)->residual, kUmPerMm));
    series.push_back(one);
  }
  return lines_chart("left-over", "Left over by the decomposition", axis_label("angle", "°"),
                     axis_label("radial deviation", "µm"), series);
}

json interval_json(const FigureInterval& i) {
  return {{"um", um(i.estimate)},
          {"corrected_um", um(i.corrected)},
          {"low_um", um(i.low)},
          {"high_um", um(i.high)},
          {"upper95_um", um(i.upper95)}};
}

}  // namespace

std::string ball_bar_text(const BallBarTest& test, const BallBarEvaluation& e) {
  return text_of({{"sections",
                   {text_section("", {test.name + ": " + conditions(test), circles_in_words(test)}),
                    figures_table(test, e), Parts(test, e).table(), spikes_table(e),
                    text_section("", e.remarks)}}});
}

json ball_bar_json(const BallBarTest& test, const BallBarEvaluation& e,
                   const BallBarSettings& settings) {
  json j{{"version", kVersion},
         {"file", test.name},
         {"plane", *test.plane},
         {"radius_mm", *test.radius},
         {"full_circle", e.full},
         {"sigma_um", um(settings.sigma)},
         {"squareness", e.squareness},
         {"squareness_urad", urad(e.decomposition.value.squareness)},
         {"u_squareness_urad", urad(e.u_squareness)},
         {"centre_um", in_um(e.decomposition.value.centre)},
         {"figures", figures_of_table(figures_table(test, e))},
         {"parts", figures_of_table(Parts(test, e).table())},
         {"spikes", figures_of_table(spikes_table(e))},
         {"remarks", e.remarks}};
  if (test.feed) j["feed_mm_min"] = *test.feed;
  if (e.intervals) {
    j["draws"] = e.draws;
    j["seed"] = settings.seed;
    j["intervals"] = {{"ccw", interval_json(e.intervals->ccw)},
                      {"cw", interval_json(e.intervals->cw)},
                      {"both", interval_json(e.intervals->both)}};
  }
  return j;
}

json ball_bar_document(const BallBarTest& test, const BallBarEvaluation& e, const RunContext& run,
                       Origins origins) {
  origins.data = "measured: what the file holds";
  origins.warnings = e.remarks;
  ReportParts parts;
  parts.title = "Circular test";
  parts.subtitle = conditions(test) + "; " + circles_in_words(test);
  parts.before_after = figures_table(test, e);
  parts.plots = {polar_chart(e), residual_chart(e)};
  parts.details = {Parts(test, e).table(), spikes_table(e)};
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

}  // namespace volcomp::host
