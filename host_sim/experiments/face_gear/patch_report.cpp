#include "host_sim/experiments/face_gear/patch_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

template <class Value>
json optional_json(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

// The page shows no truths: as words for people, as they are for programs.
const char* yes_or_no(bool truth) { return truth ? "yes" : "no"; }

// Figures that range over ten decades: as text for people, in full for programs.
std::string short_text(double value) { return fmt::format("{:.2g}", value); }

json with_name(const char* name, json table) {
  table["name"] = name;
  return host::in_summary(std::move(table));
}

json control_table(const PatchComparison& c) {
  json rows = json::array();
  for (const ControlDifference& d : c.control)
    rows.push_back(json::array({d.parameters, d.largest_um}));
  return with_name(
      "control_points",
      host::with_id("control-points",
                    host::table_section("Control points of the patch, against Table 3",
                                        {host::plain_column("parameters", "parameters"),
                                         host::column("largest difference", "µm", 2, "largest_um")},
                                        rows),
                    "Ten control points are printed: rows 1 to 5 of both end columns."));
}

json distance_table(const PatchComparison& c) {
  json rows = json::array();
  for (const PatchDistance& d : c.patch)
    rows.push_back({d.relieved ? "relieved" : "generated", short_text(d.nodes_mm), d.nodes_mm,
                    d.largest_um, d.rms_um});
  return with_name(
      "patch",
      host::with_id("patch",
                    host::table_section(
                        "Patch from the flank whose nodes it runs through",
                        {host::plain_column("flank", "flank"),
                         host::plain_column("in the nodes, mm"), host::hidden_column("nodes_mm"),
                         host::column("between, largest", "µm", 3, "largest_um"),
                         host::column("rms", "µm", 3, "rms_um")},
                        rows),
                    fmt::format("Uniform parameters; {} x {} places on the patch, its distance "
                                "from the closed flank.",
                                kRasterRows, kRasterColumns)));
}

json search_table(const PatchComparison& c) {
  json rows = json::array();
  for (const PatchSearch& s : c.search)
    rows.push_back({s.name, s.levels, optional_json(s.points), kUmPerMm * s.largest_error_mm,
                    short_text(kUmPerMm * s.largest_error_mm), kUmPerMm * s.nodes_mm,
                    short_text(kUmPerMm * s.nodes_mm), optional_json(s.wrong_signs), s.unsettled});
  json signs = host::column("wrong signs", "", 0, "wrong_signs");
  signs["missing"] = "no sign";
  return with_name(
      "searches",
      host::with_id(
          "searches",
          host::table_section(
              "Nearest point: the most it takes, and what it leaves",
              {host::plain_column("search", "search"),
               host::column("levels or steps", "", 0, "levels"),
               host::column("points of the patch", "", 0, "points"),
               host::hidden_column("error_um"), host::plain_column("error, µm"),
               host::hidden_column("nodes_um"), host::plain_column("in the nodes, µm"), signs,
               host::column("not found", "", 0, "unsettled")},
              rows),
          fmt::format("{} places in the middle of the cells: on the surface, 0.5 mm within, 0.5 "
                      "and 1.5 mm off it. The subdivisions end at 1e-7 of u and v, Newton at "
                      "1e-12; Newton starts in the nearest of {} nodes.",
                      4 * (kGridRows - 1) * (kGridColumns - 1), kGridCells)));
}

// Points, step and error of a search after a level; none where it has ended before.
void add_level(const PatchSearch& s, std::size_t k, json& row) {
  if (k >= s.course.size()) {
    for (int column = 0; column < 5; ++column)
      row.push_back(nullptr);
    return;
  }
  const SearchLevel& at = s.course[k];
  const double error_um = kUmPerMm * at.largest_error_mm;
  row.push_back(at.points);
  row.push_back(optional_json(at.step));
  row.push_back(at.step ? json(short_text(*at.step)) : json(nullptr));
  row.push_back(error_um);
  row.push_back(short_text(error_um));
}

void add_level_columns(const std::string& key, const char* name, json& columns) {
  columns.push_back(
      host::column(fmt::format("{}: points", name), "", 0, (key + "/points").c_str()));
  columns.push_back(host::hidden_column((key + "/step").c_str()));
  columns.push_back(host::plain_column("step"));
  columns.push_back(host::hidden_column((key + "/error_um").c_str()));
  columns.push_back(host::plain_column("error, µm"));
}

// One row for each level: the searches on the patch side by side.
json course_table(const PatchComparison& c) {
  constexpr std::array<const char*, 3> kShortNames{"10 x 10", "4 x 4", "Newton"};
  json columns = json::array({host::column("level", "", 0, "level")});
  std::size_t levels = 0;
  for (std::size_t i = 0; i < kShortNames.size(); ++i) {
    levels = std::max(levels, c.search.at(i).course.size());
    add_level_columns(c.search.at(i).key, kShortNames.at(i), columns);
  }
  json rows = json::array();
  for (std::size_t k = 0; k < levels; ++k) {
    json row = json::array({k + 1});
    for (std::size_t i = 0; i < kShortNames.size(); ++i)
      add_level(c.search.at(i), k, row);
    rows.push_back(std::move(row));
  }
  return with_name(
      "convergence",
      host::with_id(
          "convergence",
          host::table_section("Convergence: largest error of the distance after each level",
                              std::move(columns), std::move(rows)),
          "Steps are of u and v: the width of a cell, the last step of Newton. "
          "Newton's first level is the nearest node."));
}

json angle_table(const PatchComparison& c) {
  json rows = json::array();
  for (const AngleSearch& a : c.angle)
    rows.push_back({a.name, optional_json(a.range_mm), a.distances, a.ends, yes_or_no(a.ends),
                    a.rest_um, short_text(a.rest_um)});
  return with_name(
      "angle",
      host::with_id(
          "angle",
          host::table_section(
              "Search for the angle of the gear",
              {host::plain_column("search", "search"), host::column("range", "mm", 2, "range_mm"),
               host::column("distances", "", 0, "distances"), host::hidden_column("ends"),
               host::plain_column("ends"), host::hidden_column("rest_um"),
               host::plain_column("distance less radius, µm")},
              rows),
          fmt::format("From the angle 0 to 0.1 µm, steps of 1 deg at most, on the flank without "
                      "relief; {}.",
                      c.table_3 ? "the paper's ball of its worked example, radius 0.5 mm"
                                : "a ball of 0.5 mm in the centre of the grid, turned by 81.857 "
                                  "deg as that of the paper")));
}

json promise_table(const PatchComparison& c) {
  json rows = json::array();
  for (const PatchPromise& p : patch_promises(c))
    rows.push_back({p.key, p.what, p.unit, p.found, fmt::format("{:.4g}", p.found),
                    p.at_least ? ">=" : "<=", p.limit, fmt::format("{:g}", p.limit), p.holds(),
                    yes_or_no(p.holds())});
  return with_name(
      "promises",
      host::with_id(
          "promises",
          host::table_section("What the page promises",
                              {host::hidden_column("key"), host::plain_column("figure", "what"),
                               host::plain_column("unit", "unit"), host::hidden_column("found"),
                               host::plain_column("found"), host::plain_column("", "relation"),
                               host::hidden_column("limit"), host::plain_column("limit"),
                               host::hidden_column("holds"), host::plain_column("holds")},
                              rows)));
}

json all_tables(const PatchComparison& c) {
  json tables = json::array();
  if (!c.control.empty()) tables.push_back(control_table(c));
  for (json table :
       {distance_table(c), search_table(c), course_table(c), angle_table(c), promise_table(c)})
    tables.push_back(std::move(table));
  return tables;
}

// Every second place of the raster, by rows and columns of the grid of nodes.
json error_map(const PatchDistance& d, const TipRelief& relief) {
  constexpr std::size_t kEvery = 2;
  std::vector<double> columns;
  std::vector<double> rows;
  for (std::size_t j = 0; j < kRasterColumns; j += kEvery)
    columns.push_back(1.0 + static_cast<double>(j) / kStepsOfACell);
  json values = json::array();
  for (std::size_t i = 0; i < kRasterRows; i += kEvery) {
    rows.push_back(1.0 + static_cast<double>(i) / kStepsOfACell);
    json row = json::array();
    for (std::size_t j = 0; j < kRasterColumns; j += kEvery)
      row.push_back(d.raster_um.at(i * kRasterColumns + j));
    values.push_back(row);
  }
  const char* flank = d.relieved ? "relieved" : "generated";
  return host::with_id(
      fmt::format("patch-{}", flank),
      {{"type", "heatmap"},
       {"title", fmt::format("Patch from the {} flank", flank)},
       {"x", {{"label", "column, 1 = inside"}, {"digits", 1}, {"values", columns}}},
       {"y", {{"label", "row, 1 = tip"}, {"digits", 1}, {"values", rows}}},
       {"z",
        {{"label", "distance, + = outside"}, {"unit", "µm"}, {"digits", 3}, {"values", values}}}},
      d.relieved ? fmt::format("The relief begins at a depth of {:g} mm with a jump of the "
                               "curvature, which no patch follows.",
                               relief.begin)
                 : "");
}

// Decimal logarithms: errors run over ten decades. Nothing is drawn below 1e-16 mm.
json convergence_chart(const PatchComparison& c) {
  json series = json::array();
  for (const PatchSearch& s : c.search) {
    if (s.course.empty()) continue;
    std::vector<double> points;
    std::vector<double> logarithm;
    for (const SearchLevel& level : s.course) {
      points.push_back(level.points);
      logarithm.push_back(std::log10(std::max(level.largest_error_mm, 1e-16)));
    }
    series.push_back(host::series_of(s.name, points, logarithm));
  }
  return host::lines_chart("convergence-chart", "Convergence of the searches",
                           host::axis_label("points of the patch evaluated", ""),
                           host::axis_label("log10 of the largest error in mm", ""), series);
}

}  // namespace

nlohmann::json patch_document(const PatchComparison& comparison, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "Face gear: the patch of the paper against the closed flank";
  parts.subtitle = fmt::format("{} teeth, module {:g}, shaper of {} teeth", comparison.gear.teeth,
                               comparison.gear.module, comparison.gear.shaper_teeth);
  parts.verdict = patch_verdict(comparison);
  parts.plots = json::array();
  for (const PatchDistance& d : comparison.patch)
    parts.plots.push_back(error_map(d, comparison.gear.relief));
  parts.plots.push_back(convergence_chart(comparison));
  parts.details = all_tables(comparison);
  host::Origins origins;
  origins.data = "computed: no gear was measured";
  origins.settings = {{"gear", comparison.gear_name}};
  origins.inputs = comparison.inputs;
  origins.chosen = {"places between the nodes, offsets of the balls"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string patch_summary(const PatchComparison& comparison) {
  return host::terminal_text(patch_document(comparison, {}));
}

nlohmann::json patch_figures(const PatchComparison& comparison) {
  json figures = {{"version", host::kVersion},
                  {"gear", comparison.gear_name},
                  {"ok", patch_verdict(comparison).ok}};
  for (const json& table : all_tables(comparison))
    figures[table["name"].get<std::string>()] = host::figures_of_table(table);
  return figures;
}

}  // namespace volcomp::face_gear
