#include "host_sim/host/report/text_of.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr const char* kDash = "-";
constexpr const char* kBetweenColumns = "  ";

// Of UTF-8, in code points: continuation bytes have no width.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) >> 6U) != 2U;
  }));
}

// Without digits as short as it can be, as the page shows it; never "-0.00".
std::string number_text(const json& number, const json& column) {
  if (!std::isfinite(number.get<double>())) return kDash;
  if (!column.contains("digits"))
    return number.is_number_float() ? fmt::format("{}", number.get<double>()) : number.dump();
  std::string text = fmt::format("{:.{}f}", number.get<double>(), column["digits"].get<int>());
  if (text.find_first_of("123456789") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return text;
}

std::string cell_text(const json& cell, const json& column) {
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return cell.get<bool>() ? "yes" : "no";
  if (!cell.is_number()) return column.value("missing", kDash);
  return column.value("prefix", "") + number_text(cell, column);
}

std::string head_text(const json& column) {
  const std::string unit = column.value("unit", "");
  return column.value("title", "") + (unit.empty() ? "" : ", " + unit);
}

bool is_shown(const json& table, std::size_t index) {
  const json& column = table["columns"][index];
  if (column.value("hidden", false)) return false;
  return column.contains("missing") || table["rows"].empty() ||
         std::any_of(table["rows"].begin(), table["rows"].end(),
                     [index](const json& row) { return !row[index].is_null(); });
}

// One column of a table as it is printed, the head first.
struct PrintedColumn {
  std::vector<std::string> cells;
  std::size_t width = 0;
  bool right = false;
};

PrintedColumn printed(const json& table, std::size_t index) {
  const json& column = table["columns"][index];
  PrintedColumn out;
  if (table.value("head", true)) out.cells.push_back(head_text(column));
  for (const json& row : table["rows"]) {
    out.cells.push_back(cell_text(row[index], column));
    out.right = out.right || row[index].is_number();
  }
  for (const std::string& cell : out.cells)
    out.width = std::max(out.width, width_of(cell));
  return out;
}

std::string table_text(const json& table) {
  std::vector<PrintedColumn> columns;
  for (std::size_t i = 0; i < table["columns"].size(); ++i) {
    if (is_shown(table, i)) columns.push_back(printed(table, i));
  }
  std::string text;
  for (std::size_t line = 0; !columns.empty() && line < columns.front().cells.size(); ++line) {
    std::string row = table.value("title", "").empty() ? "" : "  ";
    for (const PrintedColumn& column : columns) {
      const std::string& cell = column.cells[line];
      const std::string padding(column.width - width_of(cell), ' ');
      row += (column.right ? padding + cell : cell + padding) + kBetweenColumns;
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

json members_of(const json& row, const json& columns) {
  json object = json::object();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].contains("name"))
      object[json::json_pointer("/" + columns[i]["name"].get<std::string>())] = row[i];
  }
  return object;
}

}  // namespace

std::string text_of_section(const json& section) {
  std::string text;
  if (section["type"] == "table") {
    text = table_text(section);
  } else if (section["type"] == "text") {
    for (const json& paragraph : section["paragraphs"])
      text += paragraph.get<std::string>() + "\n";
  } else {
    return {};
  }
  const std::string note = section.value("note", "");
  if (!note.empty()) text += note + "\n";
  const std::string title = section.value("title", "");
  return title.empty() ? text : fmt::format("\n{}\n{}", title, text);
}

std::string text_of_sections(const json& sections) {
  std::string text;
  for (const json& section : sections)
    text += text_of_section(section);
  // Nothing stands before the first title.
  return text.substr(0, 1) == "\n" ? text.substr(1) : text;
}

std::string text_of(const json& document) {
  std::string text = text_of_sections(document["sections"]);
  if (!document.contains("verdict")) return text;
  const json& verdict = document["verdict"];
  return text + fmt::format("{} {}\n", verdict["ok"].get<bool>() ? "PASS" : "FAIL",
                            verdict["text"].get<std::string>());
}

json figures_of_table(const json& table) {
  const bool keyed = table.value("keyed", false);
  json figures = keyed ? json::object() : json::array();
  for (const json& row : table["rows"]) {
    json members = members_of(row, table["columns"]);
    if (keyed) {
      figures[row[0].get<std::string>()] = std::move(members);
    } else {
      figures.push_back(std::move(members));
    }
  }
  return figures;
}

json figures_of(const json& document) {
  json figures = json::object();
  for (const json& section : document["sections"]) {
    if (section["type"] == "table" && section.contains("name"))
      figures[section["name"].get<std::string>()] = figures_of_table(section);
  }
  return figures;
}

json fact_table(const std::string& title, const json& facts, json columns) {
  json rows = json::array();
  for (const json& fact : facts) {
    json row = json::array();
    for (const json& column : columns) {
      const json::json_pointer at("/" + column["name"].get<std::string>());
      row.push_back(fact.contains(at) ? fact.at(at) : json());
    }
    rows.push_back(std::move(row));
  }
  return table_section(title, std::move(columns), std::move(rows));
}

}  // namespace volcomp::host
