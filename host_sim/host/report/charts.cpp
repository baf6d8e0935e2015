#include "host_sim/host/report/charts.hpp"

#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace volcomp::host {

using nlohmann::json;

json with_id(const std::string& id, json section, const std::string& note) {
  section["id"] = id;
  if (!note.empty()) section["note"] = note;
  return section;
}

json lines_chart(const std::string& id, const std::string& title, json x, json y, json series,
                 const std::string& note) {
  return with_id(id,
                 {{"type", "lines"},
                  {"title", title},
                  {"x", std::move(x)},
                  {"y", std::move(y)},
                  {"series", std::move(series)}},
                 note);
}

json bar_chart(const std::string& id, const std::string& title,
               const std::vector<std::string>& categories, json y, json series,
               const std::string& note) {
  return with_id(id,
                 {{"type", "bars"},
                  {"title", title},
                  {"categories", categories},
                  {"y", std::move(y)},
                  {"series", std::move(series)}},
                 note);
}

json bar_chart(const std::string& id, const std::string& title,
               const std::vector<double>& categories, json y, json series,
               const std::string& note) {
  std::vector<std::string> names;
  names.reserve(categories.size());
  for (const double number : categories)
    names.push_back(fmt::format("{:g}", number));
  return bar_chart(id, title, names, std::move(y), std::move(series), note);
}

json chart_group(const std::string& id, const std::string& title, json charts,
                 const std::string& note, bool shared_y) {
  return with_id(
      id,
      {{"type", "group"}, {"title", title}, {"shared_y", shared_y}, {"charts", std::move(charts)}},
      note);
}

json points_of(const char* name, const std::vector<double>& x, const std::vector<double>& y) {
  json series = series_of(name, x, y);
  series["style"] = "points";
  return series;
}

json bars_of(const char* name, const std::vector<double>& values) {
  return {{"name", name}, {"values", values}};
}

std::vector<double> counted(std::size_t n) {
  std::vector<double> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 1.0);
  return numbers;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values)
    value *= factor;
  return values;
}

}  // namespace volcomp::host
