#include "host_sim/host/measure/map_csv.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

std::vector<std::string> column_names() {
  std::vector<std::string> names{"row"};
  for (std::size_t column = 1; column <= kGridColumns; ++column)
    names.push_back(fmt::format("c{}", column));
  return names;
}

void check_header(CsvLines& lines) {
  std::string line;
  if (!lines.next(line)) throw UserError(lines.name() + ": the file is empty");
  const std::vector<std::string_view> cells = lines.header_cells(line);
  const std::vector<std::string> wanted = column_names();
  if (!std::equal(cells.begin(), cells.end(), wanted.begin(), wanted.end()))
    lines.fail("the first line must be row,c1,...,c15");
}

// From 0; in the file from 1.
std::size_t row_of(const CsvLines& lines, std::string_view cell) {
  const double value = lines.number(cell, "row ");
  if (!(value >= 1.0 && value <= static_cast<double>(kGridRows)) || std::floor(value) < value)
    lines.fail(fmt::format("row {} must be a whole number from 1 to {}", quoted(cell), kGridRows));
  return static_cast<std::size_t>(value) - 1;
}

double finite(const CsvLines& lines, std::string_view cell, const std::string& where) {
  const double value = lines.number(cell, where + ": ");
  if (!std::isfinite(value))
    lines.fail(
        fmt::format("{}: {} is no measured value; a cell that was not measured is left empty "
                    "[{}]",
                    where, quoted(cell), code(Reason::not_finite)));
  return value;
}

// A row number, and a cell for each column.
std::vector<std::string_view> whole_line(const CsvLines& lines, const std::string& line) {
  std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != kGridColumns + 1)
    lines.fail(fmt::format("{} cells instead of {}", cells.size(), kGridColumns + 1));
  return cells;
}

}  // namespace

ErrorMap read_map(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  check_header(lines);
  ErrorMap map;
  std::array<bool, kGridRows> seen{};
  std::string line;
  while (lines.next(line)) {
    const auto cells = whole_line(lines, line);
    const std::size_t row = row_of(lines, cells[0]);
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
  InputFile file(path);
  return read_map(file.stream(), file.name());
}

std::string map_csv(const ErrorMap& map) {
  std::string text = fmt::format("{}\n", fmt::join(column_names(), ","));
  for (std::size_t row = 0; row < kGridRows; ++row) {
    text += std::to_string(row + 1);
    for (std::size_t column = 0; column < kGridColumns; ++column)
      text += map.has(row, column) ? fmt::format(",{:.4f}", map.at(row, column)) : ",";
    text += "\n";
  }
  return text;
}

}  // namespace volcomp::host
