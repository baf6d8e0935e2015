// A comparison of flanks as text and as JSON.

#include <cmath>

#include <fmt/format.h>

#include "comp/metrology/faces/face_gear_grade.hpp"
#include "host_sim/host/measure/flank_comparison.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

// A value that is printed with one decimal: no "-0.0".
double tenths(double value) { return std::abs(value) < 0.05 ? 0.0 : value; }

json largest_or_null(const CellStatistics& s) { return s.count == 0 ? json() : json(s.largest); }

// The differences with the largest of each row and column in the margins.
json map_table(const MapDifference& d) {
  json columns = json::array({plain_column("")});
  json margin = json::array({"largest"});
  for (std::size_t column_at = 0; column_at < kGridColumns; ++column_at) {
    columns.push_back(column(std::to_string(column_at + 1), "", 1));
    margin.push_back(largest_or_null(d.column.at(column_at)));
  }
  columns.push_back(column("largest", "", 1));
  margin.push_back("");
  json rows = cells_json(d.difference);
  for (std::size_t row = 0; row < kGridRows; ++row) {
    rows[row].insert(rows[row].begin(), row + 1);
    rows[row].push_back(largest_or_null(d.row.at(row)));
  }
  rows.push_back(margin);
  return table_section("", columns, rows);
}

void add_flank(const FlankComparison& c, const FlankPair& pair, json& sections) {
  std::vector<std::string> files;
  for (std::size_t k = 0; k < 2; ++k) {
    const MeasuredFlank& m = pair.measured.at(k);
    const std::string missing =
        m.map.missing() > 0 ? fmt::format(", {} cells not measured", m.map.missing()) : "";
    files.push_back(fmt::format("  {}: {}, from {:.1f} to {:.1f}{}", c.options.names.at(k), m.file,
                                m.statistics.low, m.statistics.high, missing));
  }
  sections.push_back(text_section(fmt::format("{} flank (side {:+d}): {} - {}", pair.name,
                                              pair.side, c.options.names[0], c.options.names[1]),
                                  files));
  sections.push_back(map_table(pair.difference));
  const CellStatistics& s = pair.difference.overall;
  sections.back()["note"] = fmt::format("  largest {:.1f} µm at row {}, column {}; rms {:.2f} µm",
                                        s.largest, s.row + 1, s.column + 1, s.rms);
}

std::string profile_text(const FlankComparison& c) {
  const GridRange rows = c.options.profile_rows;
  std::string text = fmt::format("profile: largest range of a column over rows {} to {}\n",
                                 rows.first + 1, rows.last + 1);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& p = c.profile.at(k);
    text += fmt::format("  {}: ", c.options.names.at(k));
    if (p)
      text += fmt::format("{:.1f} µm, {} flank, column {}: ", p->value_um,
                          c.flanks.at(p->flank).name, p->column + 1);
    text += grade_text(p) + "\n";
  }
  return text + fmt::format("  {}\n", kFaceGearLimitsSource);
}

std::string frame_text(const FlankComparison& c) {
  if (c.frame.empty()) return "frame: not looked for; it needs the gear (--gear)\n";
  std::string text = "frame: how much of the difference a small motion of it explains\n";
  for (const FrameFinding& f : c.frame) {
    const FrameShare& s = f.share;
    text += fmt::format(
        "  {:<44} {:3.0f} %, rms {:.2f} -> {:.2f} µm; X {:.1f} Y {:.1f} Z {:.1f} µm, about X "
        "{:.0f} "
        "Y {:.0f} Z {:.0f} µrad\n",
        f.what, 100.0 * s.explained, s.rms_before, s.rms_after, tenths(s.shift.x()),
        tenths(s.shift.y()), tenths(s.shift.z()), 1e3 * s.turn.x(), 1e3 * s.turn.y(),
        1e3 * s.turn.z());
  }
  return text;
}

// --- JSON

json statistics_json(const CellStatistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count},
          {"largest_um", s.largest},
          {"rms_um", s.rms},
          {"mean_um", s.mean},
          {"low_um", s.low},
          {"high_um", s.high},
          {"at", {s.row + 1, s.column + 1}}};
}

template <class List>
json list_json(const List& list) {
  json out = json::array();
  for (const CellStatistics& s : list)
    out.push_back(statistics_json(s));
  return out;
}

json flank_json(const FlankPair& pair) {
  json out{{"name", pair.name}, {"side", pair.side}};
  for (const MeasuredFlank& m : pair.measured)
    out["measured"].push_back({{"file", m.file},
                               {"missing", m.map.missing()},
                               {"all", statistics_json(m.statistics)},
                               {"profile_um", m.profile ? json(m.profile->value) : json(nullptr)}});
  out["difference_um"] = cells_json(pair.difference.difference);
  out["overall"] = statistics_json(pair.difference.overall);
  out["rows"] = list_json(pair.difference.row);
  out["columns"] = list_json(pair.difference.column);
  return out;
}

json vector_json(const Vec3& v, double scale = 1.0) {
  return {scale * v.x(), scale * v.y(), scale * v.z()};
}

json frame_json(const FrameFinding& f) {
  return {{"motions", f.what},
          {"explained", f.share.explained},
          {"rms_before_um", f.share.rms_before},
          {"rms_after_um", f.share.rms_after},
          {"shift_um", vector_json(f.share.shift)},
          {"turn_urad", vector_json(f.share.turn, 1e3)},
          {"constants_um", f.share.constant},
          {"rank", f.share.rank}};
}

json profile_json(const FlankComparison& c, std::size_t k) {
  const auto& p = c.profile.at(k);
  json out{{"measurement", c.options.names.at(k)},
           {"rows", {c.options.profile_rows.first + 1, c.options.profile_rows.last + 1}},
           {"grade", nullptr},
           {"verdict", grade_text(p)},
           {"limits", kFaceGearLimitsSource}};
  if (!p) return out;
  out["value_um"] = p->value_um;
  out["flank"] = c.flanks.at(p->flank).name;
  out["column"] = p->column + 1;
  if (p->grade) out["grade"] = *p->grade;
  return out;
}

}  // namespace

json cells_json(const ErrorMap& map) {
  json rows = json::array();
  for (std::size_t row = 0; row < kGridRows; ++row) {
    json list = json::array();
    for (std::size_t column = 0; column < kGridColumns; ++column)
      list.push_back(map.has(row, column) ? json(map.at(row, column)) : json(nullptr));
    rows.push_back(list);
  }
  return rows;
}

std::string comparison_text(const FlankComparison& c) {
  json sections = json::array({text_section("", {conventions_of(c.options)})});
  for (const FlankPair& pair : c.flanks)
    add_flank(c, pair, sections);
  std::string text =
      text_of_sections(sections) +
      fmt::format("\nall: largest difference {:.1f} µm, rms {:.2f} µm\n", c.largest_um, c.rms_um);
  if (c.options.limit_um)
    text += fmt::format("{} the limit of {:g} um: {}\n", c.within_limit() ? "within" : "beyond",
                        *c.options.limit_um, c.within_limit() ? "PASS" : "FAIL");
  return text + profile_text(c) + frame_text(c);
}

json comparison_json(const FlankComparison& c) {
  json out{{"conventions", conventions_of(c.options)},
           {"names", c.options.names},
           {"largest_um", c.largest_um},
           {"rms_um", c.rms_um},
           {"ok", c.within_limit()},
           {"flanks", json::array()},
           {"profile", {profile_json(c, 0), profile_json(c, 1)}},
           {"frame", json::array()}};
  for (const FlankPair& pair : c.flanks)
    out["flanks"].push_back(flank_json(pair));
  for (const FrameFinding& f : c.frame)
    out["frame"].push_back(frame_json(f));
  return out;
}

}  // namespace volcomp::host
