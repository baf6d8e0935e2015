// A comparison of flanks as a report: heat maps of both measurements, of their difference and of
// what a frame leaves of it.

#include <numeric>

#include <fmt/format.h>

#include "comp/metrology/faces/face_gear_grade.hpp"
#include "host_sim/host/measure/flank_comparison.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

json numbered(const std::string& label, std::size_t count) {
  std::vector<int> values(count);
  std::iota(values.begin(), values.end(), 1);
  return {{"label", label}, {"digits", 0}, {"values", values}};
}

json heat_map(const FlankComparison& c, const std::string& id, const std::string& title,
              const ErrorMap& map) {
  const CompareOptions& o = c.options;
  return {{"type", "heatmap"},
          {"id", id},
          {"title", title},
          {"x", numbered(fmt::format("column, 1 = {}", o.column_1_is_inner ? "inner" : "outer"),
                         kGridColumns)},
          {"y", numbered(fmt::format("row, 1 = {}", o.row_1_is_tip ? "tip" : "root"), kGridRows)},
          {"z",
           {{"label", "deviation, + = excess"},
            {"unit", "µm"},
            {"digits", 1},
            {"values", cells_json(map)}}}};
}

void add_maps(const FlankComparison& c, json& sections) {
  for (std::size_t f = 0; f < c.flanks.size(); ++f) {
    const FlankPair& pair = c.flanks[f];
    const auto add = [&](const std::string& what, const std::string& title, const ErrorMap& map) {
      sections.push_back(heat_map(c, fmt::format("{}-{}", pair.name, what),
                                  fmt::format("{} flank: {}", pair.name, title), map));
    };
    add("difference", fmt::format("{} − {}", c.options.names[0], c.options.names[1]),
        pair.difference.difference);
    if (!c.frame.empty())
      add("rest", fmt::format("the same without {}", c.frame.front().what),
          c.frame.front().share.rest.at(f));
    add("first", c.options.names[0], pair.measured[0].map);
    add("second", c.options.names[1], pair.measured[1].map);
  }
}

// Largest magnitudes by row or by column.
template <class Lines>
json line_bars(const FlankComparison& c, const char* what, std::size_t count, const Lines& lines) {
  std::vector<std::string> categories;
  for (std::size_t i = 0; i < count; ++i)
    categories.push_back(std::to_string(i + 1));
  json series = json::array();
  for (const FlankPair& pair : c.flanks) {
    json values = json::array();
    for (const CellStatistics& s : lines(pair.difference))
      values.push_back(s.count > 0 ? json(s.largest) : json(nullptr));
    series.push_back({{"name", pair.name + " flank"}, {"values", values}});
  }
  return {{"type", "bars"},
          {"id", fmt::format("by-{}", what)},
          {"title", fmt::format("Largest difference by {}", what)},
          {"categories", categories},
          {"y", {{"label", "largest difference"}, {"unit", "µm"}, {"digits", 1}}},
          {"series", series}};
}

json profile_table(const FlankComparison& c) {
  json rows = json::array();
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& p = c.profile.at(k);
    const std::string where =
        p ? fmt::format("{} flank, column {}", c.flanks.at(p->flank).name, p->column + 1) : "";
    rows.push_back(
        {c.options.names.at(k), p ? json(p->value_um) : json(nullptr), where, grade_text(p)});
  }
  const GridRange range = c.options.profile_rows;
  return {{"type", "table"},
          {"id", "profile"},
          {"title", fmt::format("Profile: largest range of a column over rows {} to {}",
                                range.first + 1, range.last + 1)},
          {"columns",
           {{{"title", "measurement"}},
            column("deviation", "µm", 1),
            {{"title", "where"}},
            {{"title", "grade"}}}},
          {"rows", rows},
          {"note", kFaceGearLimitsSource}};
}

json frame_table(const FlankComparison& c) {
  json rows = json::array();
  for (const FrameFinding& f : c.frame) {
    const FrameShare& s = f.share;
    rows.push_back({f.what, 100.0 * s.explained, s.rms_before, s.rms_after, s.shift.x(),
                    s.shift.y(), s.shift.z(), 1e3 * s.turn.x(), 1e3 * s.turn.y(),
                    1e3 * s.turn.z()});
  }
  return {{"type", "table"},
          {"id", "frame"},
          {"title", "How much of the difference a frame explains"},
          {"columns",
           {{{"title", "motions"}},
            column("explained", "%", 0),
            column("rms before", "µm", 2),
            column("after", "µm", 2),
            column("X", "µm", 1),
            column("Y", "µm", 1),
            column("Z", "µm", 1),
            column("about X", "µrad", 0),
            column("about Y", "µrad", 0),
            column("about Z", "µrad", 0)}},
          {"rows", rows},
          {"note",
           "Least squares over the normals of the nominal flanks; share of the sum of "
           "squares."}};
}

Origins origins_of(const FlankComparison& c) {
  Origins origins;
  origins.data = "measured: what the files hold";
  origins.settings.emplace_back("conventions", conventions_of(c.options));
  for (std::size_t f = 0; f < c.flanks.size(); ++f) {
    for (std::size_t k = 0; k < 2; ++k)
      add_origin(origins, fmt::format("{} flank, {}", c.flanks[f].name, c.options.names.at(k)),
                 c.options.files.at(2 * f + k));
  }
  if (!c.options.gear.empty()) add_origin(origins, "gear", c.options.gear);
  return origins;
}

}  // namespace

json comparison_document(const FlankComparison& c, const RunContext& run) {
  ReportParts parts;
  parts.title = fmt::format("Face gear: {} against {}", c.options.names[0], c.options.names[1]);
  parts.subtitle = conventions_of(c.options);
  if (c.options.limit_um)
    parts.verdict =
        Verdict{c.within_limit(), fmt::format("Largest difference {:.1f} µm; {:g} µm are allowed.",
                                              c.largest_um, *c.options.limit_um)};
  add_maps(c, parts.plots);
  parts.plots.push_back(
      line_bars(c, "row", kGridRows, [](const MapDifference& d) { return d.row; }));
  parts.plots.push_back(
      line_bars(c, "column", kGridColumns, [](const MapDifference& d) { return d.column; }));
  parts.details.push_back(profile_table(c));
  if (!c.frame.empty()) parts.details.push_back(frame_table(c));
  parts.provenance = provenance(run, origins_of(c));
  return report_document(std::move(parts));
}

}  // namespace volcomp::host
