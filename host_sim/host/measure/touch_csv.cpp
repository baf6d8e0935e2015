#include "host_sim/host/measure/touch_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kFarthestTouch_mm = 1e5;
constexpr double kLongestDirection = 1e6;
constexpr double kShortestDirection = 1e-6;

// Centre, normal, approach.
constexpr std::array<const char*, 9> kTouchColumns{"X",  "Y",  "Z",  "NX", "NY",
                                                   "NZ", "AX", "AY", "AZ"};
enum Group : std::size_t { kCentre = 0, kNormal = 1, kApproach = 2 };

struct TouchHeader {
  std::vector<std::size_t> column;  // of each cell
  std::array<double, 9> factor{};
  std::array<bool, 9> seen{};

  [[nodiscard]] bool any(Group group) const {
    return seen.at(3 * group) || seen.at(3 * group + 1) || seen.at(3 * group + 2);
  }
};

void require_all_of(const CsvLines& lines, const TouchHeader& h, Group group) {
  for (std::size_t i = 3 * group; i < 3 * (group + 1U); ++i) {
    if (!h.seen.at(i))
      lines.fail(fmt::format("the header lacks the column {}{} [{}]", kTouchColumns.at(i),
                             group == kCentre ? " [mm]" : "", code(Reason::missing_field)));
  }
}

std::size_t column_of(const CsvLines& lines, std::string_view label, std::string_view cell) {
  const auto* const found = std::find(kTouchColumns.begin(), kTouchColumns.end(), label);
  if (found == kTouchColumns.end())
    lines.fail(fmt::format("unknown column {} (known: X Y Z with their unit, NX NY NZ, AX AY AZ)",
                           quoted(cell)));
  return static_cast<std::size_t>(found - kTouchColumns.begin());
}

TouchHeader read_touch_header(const CsvLines& lines, std::string_view line) {
  TouchHeader h;
  for (const std::string_view cell : lines.header_cells(line)) {
    // Directions have no unit, places need theirs.
    const bool direction = cell.size() == 2 && (cell[0] == 'N' || cell[0] == 'A');
    std::string_view label = cell;
    const double factor = direction ? 1.0 : length_unit(lines, cell, label);
    const std::size_t column = column_of(lines, label, cell);
    if (!direction && column >= 3)
      lines.fail(fmt::format("column {} is a direction and has no unit", quoted(cell)));
    if (h.seen.at(column)) lines.fail(fmt::format("column {} occurs twice", quoted(cell)));
    h.seen.at(column) = true;
    h.factor.at(column) = factor;
    h.column.push_back(column);
  }
  require_all_of(lines, h, kCentre);
  if (h.any(kNormal) && h.any(kApproach))
    lines.fail("NX NY NZ and AX AY AZ say the same: only one of them can be there");
  if (h.any(kNormal)) require_all_of(lines, h, kNormal);
  if (h.any(kApproach)) require_all_of(lines, h, kApproach);
  return h;
}

double touch_value(const CsvLines& lines, std::string_view cell, std::size_t column,
                   double factor) {
  const double value = lines.number(cell, fmt::format("{}: ", kTouchColumns.at(column))) * factor;
  const double most = column < 3 ? kFarthestTouch_mm : kLongestDirection;
  if (!std::isfinite(value) || std::abs(value) > most)
    lines.fail(fmt::format("{}: {} must be finite and at most {:g}{} [{}]",
                           kTouchColumns.at(column), quoted(cell), most, column < 3 ? " mm" : "",
                           code(Reason::not_finite)));
  return value;
}

ProbeTouch read_touch(const CsvLines& lines, const TouchHeader& header, std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != header.column.size())
    lines.fail(fmt::format("{} cells instead of {}", cells.size(), header.column.size()));
  ProbeTouch touch;
  touch.line = lines.line();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t column = header.column[i];
    const double value = touch_value(lines, cells[i], column, header.factor.at(column));
    const auto k = static_cast<Eigen::Index>(column % 3);
    if (column < 3) touch.centre(k) = value;
    if (column >= 3) touch.normal(k) = column >= 6 ? -value : value;
  }
  const bool directed = header.any(kNormal) || header.any(kApproach);
  if (!directed) return touch;
  const double length = touch.normal.norm();
  if (!(length >= kShortestDirection))
    lines.fail(fmt::format("the direction has no length [{}]", code(Reason::zero_normal)));
  touch.normal /= length;
  return touch;
}

}  // namespace

TouchFile read_touches(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  std::string line;
  if (!lines.next(line)) throw UserError(name + ": the file is empty");
  const TouchHeader header = read_touch_header(lines, line);
  TouchFile file{name, {}, header.any(kNormal) || header.any(kApproach)};
  while (lines.next(line)) {
    if (file.touches.size() == kMostTouches)
      lines.fail(fmt::format("more than {} touches", kMostTouches));
    file.touches.push_back(read_touch(lines, header, line));
  }
  if (file.touches.empty()) throw UserError(name + ": there is no touch after the header");
  return file;
}

TouchFile read_touch_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_touches(file.stream(), file.name());
}

}  // namespace volcomp::host
