// A verification as verdict, text, table and JSON.

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/verification.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

// "not significant", or with `spelled_out` as part of a sentence.
const char* word(Change change, bool spelled_out = false) {
  switch (change) {
    case Change::better:
      return "better";
    case Change::worse:
      return "worse";
    case Change::not_significant:
      break;
  }
  return spelled_out ? "no significant difference" : "not significant";
}

json number_or_null(const std::optional<double>& value) { return value ? json(*value) : json(); }

// No interval says that nothing is there.
std::string noise_or(double um) { return um > 0.0 ? fmt::format("{:.2f}", um) : "below the noise"; }

std::string within_limit(const FigureComparison& f, double limit) {
  const std::string bound = !f.after.interval ? ""
                            : f.after.interval->upper95 > 0.0
                                ? fmt::format(", upper bound {:.2f} µm", f.after.interval->upper95)
                                : ", upper bound below the noise";
  if (f.after.most_um() <= limit) return fmt::format("within {:g} µm{}", limit, bound);
  if (f.after.um <= limit) return fmt::format("not within {:g} µm for certain{}", limit, bound);
  return fmt::format("more than {:g} µm{}", limit, bound);
}

// --- cells of the table of figures

json row_of(const FigureComparison& f, const Figure& figure, const char* when) {
  json row{f.where, f.name, when, figure.um};
  if (figure.interval) {
    const FigureInterval& i = *figure.interval;
    row.push_back(noise_or(i.corrected));
    row.push_back(fmt::format("{:.2f} … {:.2f}", i.low, i.high));
    row.push_back(noise_or(i.upper95));
  } else {
    for (int i = 0; i < 3; ++i)
      row.push_back("-");
  }
  return row;
}

std::string difference_of(const FigureComparison& f) {
  return fmt::format("{}{}", word(f.change), f.by_statistics() ? "" : ", without statistics");
}

json figure_json(const Figure& f) {
  json j{{"um", f.um}};
  const auto add = [&](const char* name, double FigureInterval::*member) {
    j[name] = f.interval ? json(*f.interval.*member) : json();
  };
  add("corrected_um", &FigureInterval::corrected);
  add("low_um", &FigureInterval::low);
  add("high_um", &FigureInterval::high);
  add("upper95_um", &FigureInterval::upper95);
  return j;
}

json figures_json(const VerificationResult& r) {
  json figures = json::array();
  for (const FigureComparison& f : r.figures)
    figures.push_back(
        {{"where", f.where},
         {"figure", f.name},
         {"before", figure_json(f.before)},
         {"after", figure_json(f.after)},
         {"reduction_percent", f.before.um > 0.0 ? json(f.reduction_percent()) : json()},
         {"change", word(f.change)},
         {"by_statistics", f.by_statistics()},
         {"decides", f.decides}});
  return figures;
}

std::string figure_csv(const Figure& f) {
  if (!f.interval) return ",,,,";
  const FigureInterval& i = *f.interval;
  return fmt::format(",{:.4f},{:.4f},{:.4f},{:.4f}", i.corrected, i.low, i.high, i.upper95);
}

// --- lines below it

void add_intervals(const VerificationInput& input, const VerificationResult& r,
                   std::vector<std::string>& lines) {
  const bool any = std::any_of(r.figures.begin(), r.figures.end(), [](const FigureComparison& f) {
    return f.before.interval || f.after.interval;
  });
  if (!any) return;
  std::vector<std::string> stated;
  for (const StatedValue& s : r.stated)
    stated.push_back(fmt::format("{} {:g}", s.key, s.value));
  lines.push_back(fmt::format("intervals: scatter of the runs{}{}; {} draws, seed {}",
                              stated.empty() ? "" : " and ", fmt::join(stated, ", "), input.draws,
                              input.seed));
}

void add_uncertainty(const VerificationResult& r, std::vector<std::string>& lines) {
  std::vector<std::string> parts;
  for (const Contribution& c : r.largest_contributions)
    parts.push_back(fmt::format("{} {:.2f} µm", c.name, 2.0 * c.u_um));
  if (!parts.empty())
    lines.push_back(fmt::format(
        "ISO/TR 230-9, instrument and surroundings only: U (k = 2) of E is {:.2f} µm at most: {}",
        *expanded_um(r.largest_contributions), fmt::join(parts, ", ")));
  if (!r.left_out.empty())
    lines.push_back(fmt::format("left out of the uncertainty: {}", fmt::join(r.left_out, "; ")));
}

void add_predictions(const VerificationResult& r, std::vector<std::string>& lines) {
  for (const DiagonalCurves& c : r.curves) {
    if (!c.predicted) continue;
    double predicted = 0.0;
    for (const double um : c.predicted->after_um)
      predicted = std::max(predicted, std::abs(um));
    lines.push_back(fmt::format(
        "{}: the tables predict {:.2f} µm at most; measured after differs by {:.2f} µm at most, "
        "{:.2f} µm rms",
        c.name, predicted, c.predicted->max_difference_um, c.predicted->rms_difference_um));
  }
}

json curves_json(const DiagonalCurves& c) {
  json j{{"name", c.name},
         {"distance_mm", c.distance_mm},
         {"before_um", c.before_um},
         {"after_um", c.after_um}};
  if (c.predicted) {
    j["predicted_um"] = c.predicted->after_um;
    j["prediction_max_difference_um"] = c.predicted->max_difference_um;
    j["prediction_rms_difference_um"] = c.predicted->rms_difference_um;
  }
  return j;
}

}  // namespace

void judge(const VerificationInput& input, VerificationResult& r) {
  r.ok = true;
  std::vector<std::string> parts;
  for (const FigureComparison& f : r.figures) {
    if (f.name == "E" && f.change == Change::worse && !input.limit_um) {
      r.ok = false;
      parts.push_back(fmt::format("{} is significantly worse", f.where));
    }
    if (!f.decides) continue;
    const bool good =
        input.limit_um ? f.after.most_um() <= *input.limit_um : f.change == Change::better;
    r.ok = r.ok && good;
    const bool statistics = input.limit_um ? f.after.interval.has_value() : f.by_statistics();
    parts.push_back(fmt::format(
        "{} {} {:.2f} µm before, {:.2f} µm after ({}{})", f.where, f.name, f.before.um, f.after.um,
        input.limit_um ? within_limit(f, *input.limit_um) : word(f.change, true),
        statistics ? "" : ", without statistics"));
  }
  r.verdict = fmt::format("{}", fmt::join(parts, ", "));
}

json verification_figures(const VerificationResult& r) {
  json rows = json::array();
  for (const FigureComparison& f : r.figures) {
    json before = row_of(f, f.before, "before");
    before.push_back("");
    before.push_back("");
    json after = row_of(f, f.after, "after");
    after.push_back(f.before.um > 0.0 ? json(f.reduction_percent()) : json());
    after.push_back(difference_of(f));
    rows.push_back(std::move(before));
    rows.push_back(std::move(after));
  }
  json table = table_section(
      "Figures",
      {plain_column("where"), plain_column("figure"), plain_column("when"),
       column("as measured", "µm", 2), column("corrected", "µm", 2), column("95 %", "µm", 2),
       column("upper bound", "µm", 2), column("reduction", "%", 2), plain_column("difference")},
      rows);
  table["id"] = "figures";
  return table;
}

std::string verification_text(const VerificationInput& input, const VerificationResult& r) {
  std::vector<std::string> remarks;
  add_intervals(input, r, remarks);
  add_uncertainty(r, remarks);
  add_predictions(r, remarks);
  remarks.insert(remarks.end(), r.remarks.begin(), r.remarks.end());
  return text_of(
      {{"sections",
        {text_section("", {"before: " + input.before.name, "after:  " + input.after.name,
                           fmt::format("{} diagonals, {} targets, {} run{} per direction",
                                       r.curves.size(), input.before.diagonals[0].targets.size(),
                                       r.least_runs, r.least_runs == 1 ? "" : "s")}),
         verification_figures(r), text_section("", remarks)}},
       {"verdict", {{"ok", r.ok}, {"text", r.verdict}}}});
}

std::string verification_csv(const VerificationResult& r) {
  std::string text = "where,figure,before [um],after [um],reduction [%],change";
  for (const char* when : {"before", "after"})
    text += fmt::format(",{0} corrected [um],{0} low [um],{0} high [um],{0} upper95 [um]", when);
  text += '\n';
  for (const FigureComparison& f : r.figures) {
    text += fmt::format("{},{},{:.4f},{:.4f},{},{}", f.where, f.name, f.before.um, f.after.um,
                        f.before.um > 0.0 ? fmt::format("{:.3f}", f.reduction_percent()) : "",
                        word(f.change));
    text += figure_csv(f.before) + figure_csv(f.after) + '\n';
  }
  return text;
}

json verification_json(const VerificationInput& input, const VerificationResult& r) {
  json contributions = json::array();
  for (const Contribution& c : r.largest_contributions)
    contributions.push_back({{"name", c.name}, {"U_um", 2.0 * c.u_um}});
  json stated = json::array();
  for (const StatedValue& value : r.stated)
    stated.push_back({{"name", value.key}, {"value", value.value}});
  json diagonals = json::array();
  for (const DiagonalCurves& c : r.curves)
    diagonals.push_back(curves_json(c));
  return {{"version", kVersion},        {"before", input.before.name},
          {"after", input.after.name},  {"ok", r.ok},
          {"verdict", r.verdict},       {"limit_um", number_or_null(input.limit_um)},
          {"figures", figures_json(r)}, {"draws", input.draws},
          {"seed", input.seed},         {"stated", stated},
          {"diagonals", diagonals},     {"uncertainty_of_E", contributions},
          {"left_out", r.left_out},     {"remarks", r.remarks}};
}

}  // namespace volcomp::host
