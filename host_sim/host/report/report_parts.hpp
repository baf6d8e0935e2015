#pragma once
// Pieces of report documents (host_sim/host/report/page/README.md) that scenarios share.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace volcomp::host {

[[nodiscard]] inline nlohmann::json axis_label(const char* label, const char* unit) {
  return {{"label", label}, {"unit", unit}};
}

[[nodiscard]] inline nlohmann::json series_of(const char* name, const std::vector<double>& x,
                                              const std::vector<double>& y) {
  return {{"name", name}, {"x", x}, {"y", y}};
}

// `name`: the key of its values in the figures (text_of.hpp), and the member they are made from in
// facts; "" for a column that is shown only.
[[nodiscard]] inline nlohmann::json column(const std::string& title, const char* unit, int digits,
                                           const char* name = "") {
  nlohmann::json made{{"title", title}, {"unit", unit}, {"digits", digits}};
  if (*name != '\0') made["name"] = name;
  return made;
}

// Of texts, and of numbers that are shown as they are.
[[nodiscard]] inline nlohmann::json plain_column(const std::string& title, const char* name = "") {
  nlohmann::json made{{"title", title}};
  if (*name != '\0') made["name"] = name;
  return made;
}

// In the figures only.
[[nodiscard]] inline nlohmann::json hidden_column(const char* name) {
  return {{"title", name}, {"name", name}, {"hidden", true}};
}

// `rows`: an array of arrays. Mind that nlohmann takes a list of lists of two, the first of each a
// text, for an object: json::array() says that it is none.
[[nodiscard]] inline nlohmann::json table_section(const std::string& title, nlohmann::json columns,
                                                  nlohmann::json rows) {
  return {{"type", "table"},
          {"title", title},
          {"columns", std::move(columns)},
          {"rows", std::move(rows)}};
}

// Names and values, one pair a line, without a head.
[[nodiscard]] inline nlohmann::json list_section(
    const std::string& title, const std::vector<std::pair<std::string, std::string>>& pairs) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& [what, value] : pairs)
    rows.push_back(nlohmann::json::array({what, value}));
  nlohmann::json list =
      table_section(title, {plain_column("what"), plain_column("value")}, std::move(rows));
  list["head"] = false;
  return list;
}

[[nodiscard]] inline nlohmann::json text_section(const std::string& title,
                                                 const std::vector<std::string>& paragraphs) {
  return {{"type", "text"}, {"title", title}, {"paragraphs", paragraphs}};
}

}  // namespace volcomp::host
