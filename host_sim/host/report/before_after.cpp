#include "host_sim/host/report/before_after.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/report/charts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

// Below this the change of a figure is not significant.
constexpr double kNothing = 1e-9;

json change(const BeforeAfter& line) {
  if (std::abs(line.before) < kNothing) return nullptr;
  return 100.0 * (line.after - line.before) / std::abs(line.before);
}

}  // namespace

json before_after_table(const std::vector<BeforeAfter>& lines, const std::string& note,
                        std::optional<std::size_t> highlight) {
  const bool truths = std::any_of(lines.begin(), lines.end(),
                                  [](const BeforeAfter& line) { return line.truth.has_value(); });
  const bool grades = std::any_of(lines.begin(), lines.end(), [](const BeforeAfter& line) {
    return !line.grade_before.empty() || !line.grade_after.empty();
  });
  json columns = json::array({{{"title", "figure"}},
                              column("before", "", 2),
                              column("after", "", 2),
                              {{"title", "unit"}},
                              column("change", "%", 1)});
  if (truths) columns.push_back(column("perfect machine", "", 2));
  if (grades) {
    columns.push_back({{"title", "grade before"}});
    columns.push_back({{"title", "grade after"}});
  }
  json rows = json::array();
  for (const BeforeAfter& line : lines) {
    json row = {line.figure, line.before, line.after, line.unit, change(line)};
    if (truths) row.push_back(line.truth ? json(*line.truth) : json(nullptr));
    if (grades) {
      row.push_back(line.grade_before);
      row.push_back(line.grade_after);
    }
    rows.push_back(row);
  }
  json table = with_id("before-after", table_section("Before and after", columns, rows), note);
  if (highlight) table["highlight_row"] = *highlight;
  return table;
}

}  // namespace volcomp::host
