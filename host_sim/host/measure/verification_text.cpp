// A verification as text, as a table and as JSON.

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"
#include "host_sim/host/measure/verification.hpp"

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

std::string plus_minus(const Figure& f) {
  return f.U_um ? fmt::format("{:9.2f} ± {:<7.2f}", f.um, *f.U_um)
                : fmt::format("{:9.2f} ± {:<7}", f.um, "?");
}

std::string reduction(const FigureComparison& f) {
  return f.before.um > 0.0 ? fmt::format("{:8.2f} %", f.reduction_percent())
                           : fmt::format("{:>10}", "-");
}

std::string figure_lines(const VerificationResult& r) {
  std::string text = fmt::format("{:<16}{:<9}{:>12} {:<9}{:>10} {:<9}{:>9}\n", "", "figure",
                                 "before, µm", "", "after, µm", "", "reduction");
  std::string where;
  for (const FigureComparison& f : r.figures) {
    text += fmt::format("{:<16}{:<9}{} {} {}  {}\n", f.where == where ? "" : f.where, f.name,
                        plus_minus(f.before), plus_minus(f.after), reduction(f), code(f.change));
    where = f.where;
  }
  return text;
}

std::string uncertainty_lines(const VerificationResult& r) {
  std::string text;
  if (!r.largest_contributions.empty()) {
    text += "uncertainty (k = 2) of E, at most:";
    for (const Contribution& c : r.largest_contributions)
      text += fmt::format(" {} {:.2f} µm,", c.name, 2.0 * c.u_um);
    text.back() = '\n';
  }
  if (!r.left_out.empty())
    text += fmt::format("left out of the uncertainty: {}\n", fmt::join(r.left_out, "; "));
  return text;
}

std::string prediction_lines(const VerificationResult& r) {
  std::string text;
  for (const DiagonalCurves& c : r.curves) {
    if (!c.predicted) continue;
    double predicted = 0.0;
    for (const double um : c.predicted->after_um)
      predicted = std::max(predicted, std::abs(um));
    text += fmt::format(
        "{}: the tables predict {:.2f} µm at most; measured after differs by {:.2f} µm at most, "
        "{:.2f} µm rms\n",
        c.name, predicted, c.predicted->max_difference_um, c.predicted->rms_difference_um);
  }
  return text;
}

json figure_json(const Figure& f) {
  return {{"um", f.um}, {"U_um", f.U_um ? json(*f.U_um) : json()}};
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

std::string verification_text(const VerificationInput& input, const VerificationResult& r) {
  std::string text = fmt::format(
      "before: {}\nafter:  {}\n{} diagonals, {} targets, {} run{} per direction\n\n",
      input.before.name, input.after.name, r.curves.size(),
      input.before.diagonals[0].targets.size(), r.least_runs, r.least_runs == 1 ? "" : "s");
  text += figure_lines(r) + "\n" + uncertainty_lines(r) + prediction_lines(r);
  for (const std::string& remark : r.remarks)
    text += remark + "\n";
  return text + fmt::format("{} {}\n", r.ok ? "PASS" : "FAIL", r.verdict);
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
  json figures = json::array();
  for (const FigureComparison& f : r.figures) {
    figures.push_back(
        {{"where", f.where},
         {"figure", f.name},
         {"before", figure_json(f.before)},
         {"after", figure_json(f.after)},
         {"reduction_percent", f.before.um > 0.0 ? json(f.reduction_percent()) : json()},
         {"change", code(f.change)},
         {"decides", f.decides}});
  }
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
          {"limit_um", input.limit_um ? json(*input.limit_um) : json()},
          {"figures", figures},
          {"diagonals", diagonals},
          {"uncertainty_of_E", contributions},
          {"left_out", r.left_out},
          {"remarks", r.remarks}};
}

}  // namespace volcomp::host
