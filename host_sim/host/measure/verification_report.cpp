// A verification as a report page.

#include <fmt/format.h>

#include "host_sim/host/measure/verification.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/volume_map.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

json diagonals_group(const VerificationResult& r) {
  json charts = json::array();
  for (const DiagonalCurves& c : r.curves) {
    json after = series_of("after", c.distance_mm, c.after_um);
    after["emphasis"] = true;
    json series{series_of("before", c.distance_mm, c.before_um), after};
    if (c.predicted) {
      json predicted = series_of("predicted by the tables", c.distance_mm, c.predicted->after_um);
      predicted["style"] = "dashed";
      series.push_back(predicted);
    }
    charts.push_back({{"type", "lines"},
                      {"id", "diagonal-" + c.name},
                      {"title", c.name},
                      {"x", axis_label("distance", "mm")},
                      {"y", axis_label("deviation", "µm")},
                      {"series", series}});
  }
  return {{"type", "group"},
          {"id", "diagonals"},
          {"title", "Diagonals before and after"},
          {"shared_y", true},
          {"charts", charts},
          {"note", "Mean of all runs and both directions, relative to the first target."}};
}

json figures_table(const VerificationResult& r) {
  json table = verification_figures(r);
  table["note"] =
      "E: bidirectional systematic deviation, B: reversal, M: range of the mean of both "
      "directions, "
      "A: accuracy, R: repeatability; E_d and B_d: the largest of all diagonals of a kind (ISO "
      "230-6, ISO 230-2). As measured: the figure of the standard, which noise makes larger. "
      "Corrected, interval and upper bound: of the figure without noise, 95 %; the bound of E_d "
      "and "
      "B_d holds for every diagonal of the kind. Volume: lengths of the error vectors after "
      "aligning "
      "the workpiece frame.";
  return table;
}

json systematic_bars(const VerificationResult& r) {
  json names = json::array();
  json before = json::array();
  json after = json::array();
  for (const FigureComparison& f : r.figures) {
    if (f.name != "E") continue;
    names.push_back(f.where);
    before.push_back(f.before.um);
    after.push_back(f.after.um);
  }
  return {{"type", "bars"},
          {"id", "systematic"},
          {"title", "Bidirectional systematic deviation E"},
          {"categories", names},
          {"y", axis_label("E", "µm")},
          {"series",
           {{{"name", "before"}, {"values", before}}, {{"name", "after"}, {"values", after}}}}};
}

// Draws every n-th point, at most kMostArrows, so that the arrows stay distinct.
json volume_chart(const VerificationInput& input) {
  constexpr std::size_t kMostArrows = 500;
  const std::vector<VolumePoint> before = aligned_by_place(*input.volume_before);
  const std::vector<VolumePoint> after = aligned_by_place(*input.volume_after);
  const std::size_t every = (before.size() + kMostArrows - 1) / kMostArrows;
  std::vector<Vec3> places;
  VolumeArrows without{"before", {}};
  VolumeArrows with{"after", {}};
  for (std::size_t i = 0; i < before.size(); i += every) {
    places.push_back(before[i].at_mm);
    without.error.push_back(before[i].error_mm);
    with.error.push_back(after[i].error_mm);
  }
  return volume_map("Error vectors in the volume", places, {without, with},
                    fmt::format("After aligning the workpiece frame; {} of {} places.",
                                places.size(), before.size()));
}

json uncertainty_section(const VerificationResult& r) {
  json rows = json::array();
  for (const Contribution& c : r.largest_contributions)
    rows.push_back({c.name, 2.0 * c.u_um});
  for (const std::string& name : r.left_out)
    rows.push_back({name + ": left out", nullptr});
  return {{"type", "table"},
          {"id", "uncertainty"},
          {"title", "ISO/TR 230-9: instrument and surroundings, of E where they do most"},
          {"columns", {{{"title", "contribution"}}, column("U (k = 2)", "µm", 2)}},
          {"rows", rows},
          {"note",
           "Contributions are independent. The scatter of the machine is not among them; the "
           "intervals hold it together with these. A difference is significant where the intervals "
           "before and after do not touch."}};
}

}  // namespace

json verification_document(const VerificationInput& input, const VerificationResult& r,
                           const RunContext& run, Origins origins) {
  origins.data = "measured: what the files hold";
  origins.warnings = r.remarks;
  ReportParts parts;
  parts.title = "Verification by diagonals";
  parts.subtitle = "The same points measured before and after compensation";
  parts.verdict = Verdict{r.ok, r.verdict};
  parts.before_after = figures_table(r);
  if (input.volume_before) parts.plots.push_back(volume_chart(input));
  parts.plots.push_back(diagonals_group(r));
  parts.plots.push_back(systematic_bars(r));
  parts.details.push_back(uncertainty_section(r));
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

}  // namespace volcomp::host
