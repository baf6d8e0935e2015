// A verification as text, as a table and as JSON.

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/verification.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

const char* code(Change change) {
  switch (change) {
    case Change::better:
      return "better";
    case Change::worse:
      return "worse";
    case Change::not_significant:
      break;
  }
  return "not significant";
}

json number_or_null(const std::optional<double>& value) { return value ? json(*value) : json(); }

void add_uncertainty(const VerificationResult& r, std::vector<std::string>& lines) {
  std::vector<std::string> parts;
  for (const Contribution& c : r.largest_contributions)
    parts.push_back(fmt::format("{} {:.2f} µm", c.name, 2.0 * c.u_um));
  if (!parts.empty())
    lines.push_back(fmt::format("uncertainty (k = 2) of E, at most: {}", fmt::join(parts, ", ")));
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

json uncertainty_column(const char* title, const char* name) {
  json made = column(title, "µm", 2, name);
  made["prefix"] = "± ";
  made["missing"] = "± ?";
  return made;
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

json verification_figures(const VerificationResult& r) {
  json rows = json::array();
  for (const FigureComparison& f : r.figures)
    rows.push_back({f.where, f.name, f.before.um, number_or_null(f.before.U_um), f.after.um,
                    number_or_null(f.after.U_um),
                    f.before.um > 0.0 ? json(f.reduction_percent()) : json(), code(f.change),
                    f.decides});
  json table = table_section(
      "Figures",
      {plain_column("where", "where"), plain_column("figure", "figure"),
       column("before", "µm", 2, "before/um"), uncertainty_column("U before", "before/U_um"),
       column("after", "µm", 2, "after/um"), uncertainty_column("U after", "after/U_um"),
       column("reduction", "%", 2, "reduction_percent"), plain_column("difference", "change"),
       hidden_column("decides")},
      rows);
  table["id"] = "figures";
  table["name"] = "figures";
  return table;
}

std::string verification_text(const VerificationInput& input, const VerificationResult& r) {
  std::vector<std::string> remarks;
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
  std::string text =
      "where,figure,before [um],U before [um],after [um],U after [um],reduction [%],change\n";
  const auto U = [](const Figure& f) { return f.U_um ? fmt::format("{:.4f}", *f.U_um) : ""; };
  for (const FigureComparison& f : r.figures) {
    text += fmt::format("{},{},{:.4f},{},{:.4f},{},{},{}\n", f.where, f.name, f.before.um,
                        U(f.before), f.after.um, U(f.after),
                        f.before.um > 0.0 ? fmt::format("{:.3f}", f.reduction_percent()) : "",
                        code(f.change));
  }
  return text;
}

json verification_json(const VerificationInput& input, const VerificationResult& r) {
  json contributions = json::array();
  for (const Contribution& c : r.largest_contributions)
    contributions.push_back({{"name", c.name}, {"U_um", 2.0 * c.u_um}});
  json diagonals = json::array();
  for (const DiagonalCurves& c : r.curves)
    diagonals.push_back(curves_json(c));
  return {{"version", kVersion},
          {"before", input.before.name},
          {"after", input.after.name},
          {"ok", r.ok},
          {"verdict", r.verdict},
          {"limit_um", number_or_null(input.limit_um)},
          {"figures", figures_of_table(verification_figures(r))},
          {"diagonals", diagonals},
          {"uncertainty_of_E", contributions},
          {"left_out", r.left_out},
          {"remarks", r.remarks}};
}

}  // namespace volcomp::host
