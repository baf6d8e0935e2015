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
constexpr const char* kGridHeader = "row,column,X,Y,Z";

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

double finite(const CsvLines& lines, std::string_view cell, const std::string& where,
              const char* hint) {
  const double value = lines.number(cell, where + ": ");
  if (!std::isfinite(value))
    lines.fail(
        fmt::format("{}: {} is no measured value{} [not_finite]", where, quoted(cell), hint));
  return value;
}

// A line with as many cells as the header.
std::vector<std::string_view> whole_line(const CsvLines& lines, const std::string& line,
                                         std::size_t count) {
  std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != count) lines.fail(fmt::format("{} cells instead of {}", cells.size(), count));
  return cells;
}

template <class Read>
auto from_file(const std::filesystem::path& path, const Read& read) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(path.string() + ": cannot be opened");
  return read(stream, path.string());
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
          finite(lines, cells[column + 1], fmt::format("row {}, column {}", row + 1, column + 1),
                 "; a cell that was not measured is left empty"));
    }
  }
  const auto absent = std::find(seen.begin(), seen.end(), false);
  if (absent != seen.end())
    throw UserError(
        fmt::format("{}: row {} of {} is missing", name, absent - seen.begin() + 1, kGridRows));
  return map;
}

GridPoints read_grid(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  check_header(lines, {"row", "column", "X", "Y", "Z"}, kGridHeader);
  GridPoints points;
  std::array<bool, kGridCells> seen{};
  std::string line;
  while (lines.next(line)) {
    const auto cells = whole_line(lines, line, 5);
    const std::size_t row = index_of(lines, cells[0], "row", kGridRows);
    const std::size_t column = index_of(lines, cells[1], "column", kGridColumns);
    const std::string where = fmt::format("row {}, column {}", row + 1, column + 1);
    const std::size_t index = grid_index(row, column);
    if (seen.at(index)) lines.fail(where + " is there twice");
    seen.at(index) = true;
    for (std::size_t k = 0; k < 3; ++k)
      points.at(index)(static_cast<Eigen::Index>(k)) = finite(lines, cells[k + 2], where, "");
  }
  const auto absent = std::find(seen.begin(), seen.end(), false);
  if (absent != seen.end()) {
    const auto index = static_cast<std::size_t>(absent - seen.begin());
    throw UserError(fmt::format("{}: the point of row {}, column {} is missing", name,
                                index / kGridColumns + 1, index % kGridColumns + 1));
  }
  return points;
}

ErrorMap read_map_file(const std::filesystem::path& path) { return from_file(path, read_map); }

GridPoints read_grid_file(const std::filesystem::path& path) { return from_file(path, read_grid); }

}  // namespace volcomp::sim
