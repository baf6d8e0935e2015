#include "host_sim/data/map_csv.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "host_sim/data/csv_cells.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr const char* kMapHeader = "row,c1,...,c15";

std::vector<std::string> map_columns() {
  std::vector<std::string> names{"row"};
  for (std::size_t column = 1; column <= kGridColumns; ++column)
    names.push_back(fmt::format("c{}", column));
  return names;
}

void check_header(CsvLines& lines, const std::vector<std::string>& wanted, const char* as_text) {
  std::string line;
  if (!lines.next(line)) throw UserError(lines.name() + ": the file is empty");
  const std::vector<std::string_view> cells = cells_of(line);
  if (!std::equal(cells.begin(), cells.end(), wanted.begin(), wanted.end()))
    lines.fail(fmt::format("the first line must be {}", as_text));
}

// A number of a row or column, from 1; its index.
std::size_t index_of(const CsvLines& lines, std::string_view cell, const char* what,
                     std::size_t most) {
  const double value = lines.number(cell, fmt::format("{} ", what));
  if (!(value >= 1.0 && value <= static_cast<double>(most)) || std::floor(value) < value)
    lines.fail(fmt::format("{} {} must be a whole number from 1 to {}", what, quoted(cell), most));
  return static_cast<std::size_t>(value) - 1;
}

double finite(const CsvLines& lines, std::string_view cell, const std::string& where) {
  const double value = lines.number(cell, where + ": ");
  if (!std::isfinite(value))
    lines.fail(
        fmt::format("{}: {} is no measured value; a cell that was not measured is left empty "
                    "[not_finite]",
                    where, quoted(cell)));
  return value;
}

// A line with as many cells as the header.
std::vector<std::string_view> whole_line(const CsvLines& lines, const std::string& line,
                                         std::size_t count) {
  std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != count) lines.fail(fmt::format("{} cells instead of {}", cells.size(), count));
  return cells;
}

}  // namespace

ErrorMap read_map(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  check_header(lines, map_columns(), kMapHeader);
  ErrorMap map;
  std::array<bool, kGridRows> seen{};
  std::string line;
  while (lines.next(line)) {
    const auto cells = whole_line(lines, line, kGridColumns + 1);
    const std::size_t row = index_of(lines, cells[0], "row", kGridRows);
    if (seen.at(row)) lines.fail(fmt::format("row {} is there twice", row + 1));
    seen.at(row) = true;
    for (std::size_t column = 0; column < kGridColumns; ++column) {
      if (cells[column + 1].empty()) continue;
      map.set(
          row, column,
          finite(lines, cells[column + 1], fmt::format("row {}, column {}", row + 1, column + 1)));
    }
  }
  for (std::size_t row = 0; row < kGridRows; ++row) {
    if (!seen.at(row))
      throw UserError(fmt::format("{}: row {} of {} is missing", name, row + 1, kGridRows));
  }
  return map;
}

ErrorMap read_map_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(path.string() + ": cannot be opened");
  return read_map(stream, path.string());
}

std::string map_csv(const ErrorMap& map) {
  std::string text = fmt::format("{}\n", fmt::join(map_columns(), ","));
  for (std::size_t row = 0; row < kGridRows; ++row) {
    text += std::to_string(row + 1);
    for (std::size_t column = 0; column < kGridColumns; ++column)
      text += map.has(row, column) ? fmt::format(",{:.4f}", map.at(row, column)) : ",";
    text += "\n";
  }
  return text;
}

}  // namespace volcomp::sim
