#include "host_sim/host/measure/gear_inspection_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr double kDegreesPerRad = 180.0 / kPi;
constexpr std::array<const char*, 2> kEditions{"ISO 1328-1:1995", "ISO 1328-1:2013"};
constexpr std::array<const char*, 2> kEditionKeys{"iso1328_1995", "iso1328_2013"};
// By GearDeviation.
constexpr std::array<const char*, kGearDeviations> kSymbols{"f_pt", "F_p",  "F_a",  "f_fa", "f_Ha",
                                                            "F_b",  "f_fb", "f_Hb", "F_r"};

const char* symbol_of(GearDeviation deviation) {
  return kSymbols.at(static_cast<std::size_t>(deviation));
}

// "8", ">12", or "-" where the edition has no grades for a gear of this size.
std::string shown_grade(const InspectedGear& g, const std::optional<int>& grade, std::size_t s) {
  if (!g.covered.at(s)) return "-";
  return grade ? std::to_string(*grade) : fmt::format(">{}", last_grade(kGearStandards.at(s)));
}

std::string shown_tooth(const InspectedTrace& trace) {
  return trace.kind == GearTraceKind::pitch ? "all" : std::to_string(trace.tooth + 1);
}

// A line for each deviation of each trace, with value and grade by edition.
json figure_rows(const InspectedGear& g) {
  json rows = json::array();
  for (const InspectedTrace& trace : g.traces)
    for (const GearFigure& figure : trace.figures)
      rows.push_back({name_of(trace.kind), kFlankNames.at(trace.side), shown_tooth(trace),
                      symbol_of(figure.deviation), figure.um[0], shown_grade(g, figure.grade[0], 0),
                      figure.um[1], shown_grade(g, figure.grade[1], 1)});
  return rows;
}

json grade_json(const InspectedGear& g, const std::optional<int>& grade, std::size_t s) {
  return g.covered.at(s) && grade ? json(*grade) : json();
}

json trace_json(const InspectedGear& g, const InspectedTrace& trace) {
  json figures = json::object();
  for (const GearFigure& figure : trace.figures) {
    json& out = figures[symbol_of(figure.deviation)];
    for (std::size_t s = 0; s < kEditions.size(); ++s)
      out[kEditionKeys.at(s)] = {{"um", figure.um.at(s)},
                                 {"grade", grade_json(g, figure.grade.at(s), s)}};
  }
  json out{{"trace", name_of(trace.kind)},
           {"flank", kFlankNames.at(trace.side)},
           {"points", trace.points},
           {"figures", figures}};
  out["tooth"] = trace.kind == GearTraceKind::pitch ? json() : json(trace.tooth + 1);
  return out;
}

json tooth_rows(const InspectedGear& g) {
  json rows = json::array();
  for (const ToothSummary& t : g.teeth)
    rows.push_back({name_of(t.kind), kFlankNames.at(t.side), t.teeth, symbol_of(t.deviation),
                    t.mean_um[0], t.worst_um[0], t.mean_um[1], t.worst_um[1]});
  return rows;
}

json tooth_section(const InspectedGear& g) {
  return table_section("Several teeth (a grade is about the worst)",
                       {plain_column("trace"), plain_column("flank"), plain_column("teeth"),
                        plain_column(""), column("1995 mean", "µm", 2), column("worst", "µm", 2),
                        column("2013 mean", "µm", 2), column("worst", "µm", 2)},
                       tooth_rows(g));
}

std::string run_out_line(const InspectedGear& g) {
  const InspectedRunOut& r = *g.run_out;
  return fmt::format(
      "F_r {:.2f} µm with a ball of {:g} mm, centre {:.3f} mm from the axis: grade {} "
      "(1995), {} (2013); eccentricity {:.2f} µm",
      r.um.total, r.ball_mm, r.radius_mm, shown_grade(g, r.grade[0], 0),
      shown_grade(g, r.grade[1], 1), r.um.eccentricity);
}

std::string span_line(const PitchSpan& span) {
  return fmt::format("F_pk over {} pitches, {} flanks: {:.2f} µm", span.pitches,
                     kFlankNames.at(span.side), span.um);
}

json spans_json(const InspectedGear& g) {
  json out = json::array();
  for (const PitchSpan& span : g.spans)
    out.push_back(
        {{"flank", kFlankNames.at(span.side)}, {"pitches", span.pitches}, {"F_pk_um", span.um}});
  return out;
}

json run_out_json(const InspectedGear& g) {
  if (!g.run_out) return {};
  json out{{"ball_mm", g.run_out->ball_mm},
           {"radius_mm", g.run_out->radius_mm},
           {"F_r_um", g.run_out->um.total},
           {"eccentricity_um", g.run_out->um.eccentricity}};
  for (std::size_t s = 0; s < kEditions.size(); ++s)
    out["grade"][kEditionKeys.at(s)] = grade_json(g, g.run_out->grade.at(s), s);
  return out;
}

json teeth_json(const InspectedGear& g) {
  json out = json::array();
  for (const ToothSummary& t : g.teeth) {
    json of{{"trace", name_of(t.kind)},
            {"flank", kFlankNames.at(t.side)},
            {"teeth", t.teeth},
            {"figure", symbol_of(t.deviation)}};
    for (std::size_t s = 0; s < kEditions.size(); ++s)
      of[kEditionKeys.at(s)] = {{"mean_um", t.mean_um.at(s)}, {"worst_um", t.worst_um.at(s)}};
    out.push_back(std::move(of));
  }
  return out;
}

}  // namespace

std::string inspection_text(const InvoluteGear& gear, const InspectedGear& inspected) {
  const json figures =
      table_section("",
                    {plain_column("trace"), plain_column("flank"), plain_column("tooth"),
                     plain_column(""), column("1995", "µm", 2), plain_column("grade"),
                     column("2013", "µm", 2), plain_column("class")},
                    figure_rows(inspected));
  std::vector<std::string> lines;
  for (const std::string& warning : inspected.warnings)
    lines.push_back("warning: " + warning);
  for (std::size_t s = 0; s < kEditions.size(); ++s)
    lines.push_back(fmt::format("{}: {}", kEditions.at(s),
                                inspected.covered.at(s)
                                    ? shown_grade(inspected, inspected.grade.at(s), s)
                                    : "has no grades for a gear of this size"));
  for (const PitchSpan& span : inspected.spans)
    lines.push_back(span_line(span));
  if (inspected.run_out) lines.push_back(run_out_line(inspected));
  lines.push_back(fmt::format(
      "The grade is the worst of F_a, F_b, f_pt and F_p as far as they were measured. {}; the "
      "formulas were not checked against the printed standards.",
      inspected.settings.filter ? "The filter of the edition of 2013 was applied for both"
                                : "No filter was applied"));
  json sections = json::array();
  sections.push_back(
      text_section("", {fmt::format("{} teeth, module {:g} mm, pressure angle {:g} deg, helix "
                                    "angle {:g} deg, width {:g} mm",
                                    gear.teeth, gear.module, kDegreesPerRad * gear.pressure_angle,
                                    kDegreesPerRad * gear.helix_angle, gear.width)}));
  sections.push_back(figures);
  if (!inspected.teeth.empty()) sections.push_back(tooth_section(inspected));
  sections.push_back(text_section("", lines));
  return text_of_sections(sections);
}

std::string inspection_csv(const InspectedGear& inspected) {
  std::string text = "trace,flank,tooth,figure,1995 [um],1995 grade,2013 [um],2013 class\n";
  for (const json& row : figure_rows(inspected)) {
    std::vector<std::string> cells;
    for (const json& cell : row)
      cells.push_back(cell.is_string() ? cell.get<std::string>()
                                       : fmt::format("{:.4f}", cell.get<double>()));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

json inspection_json(const InvoluteGear& gear, const InspectedGear& inspected) {
  json traces = json::array();
  for (const InspectedTrace& trace : inspected.traces)
    traces.push_back(trace_json(inspected, trace));
  json grades = json::object();
  for (std::size_t s = 0; s < kEditions.size(); ++s)
    grades[kEditionKeys.at(s)] = {{"covered", inspected.covered.at(s)},
                                  {"grade", grade_json(inspected, inspected.grade.at(s), s)}};
  return {{"gear",
           {{"teeth", gear.teeth},
            {"module_mm", gear.module},
            {"pressure_angle_rad", gear.pressure_angle},
            {"helix_angle_rad", gear.helix_angle},
            {"tip_diameter_mm", gear.tip_diameter},
            {"width_mm", gear.width}}},
          {"grade", grades},
          {"traces", traces},
          {"teeth", teeth_json(inspected)},
          {"run_out", run_out_json(inspected)},
          {"spans", spans_json(inspected)},
          {"filtered", inspected.settings.filter},
          {"warnings", inspected.warnings}};
}

}  // namespace volcomp::host
