// Strokes as a table: a line for every cycle.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/strokes/stroke_log.hpp"

namespace volcomp::host {
namespace {

enum Column : std::size_t {
  kTime,
  kXCommand,
  kXActual,
  kZCommand,
  kZActual,
  kCCommand,
  kCActual,
  kSlot,
  kStrokeColumns
};
constexpr std::array<const char*, kStrokeColumns> kColumnNames{
    "t", "X command", "X actual", "Z command", "Z actual", "C command", "C actual", "slot"};
constexpr double kFarthest_mm = 1e5;
constexpr double kFarthest_rad = 1e6;
constexpr double kLongest_s = 1e6;
constexpr double kMostSlots = 65535.0;

struct StrokeHeader {
  std::vector<std::size_t> column;  // of each cell
  std::array<double, kStrokeColumns> factor{};
  std::array<bool, kStrokeColumns> seen{};
};

bool is_angle(std::size_t column) { return column == kCCommand || column == kCActual; }

double time_unit(const CsvLines& lines, std::string_view cell, std::string_view name) {
  if (name == "s") return 1.0;
  if (name == "ms") return 1e-3;
  if (name == "us" || name == "\xC2\xB5s") return 1e-6;
  lines.fail(fmt::format("column {}: unknown unit of time (known: s ms us)", quoted(cell)));
}

std::string_view in_brackets(std::string_view cell) {
  const std::size_t open = cell.find('[');
  const std::size_t close = cell.find(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return {};
  return trimmed(cell.substr(open + 1, close - open - 1));
}

std::size_t column_of(const CsvLines& lines, std::string_view cell) {
  const std::string_view label = trimmed(cell.substr(0, cell.find('[')));
  const auto* const found = std::find(kColumnNames.begin(), kColumnNames.end(), label);
  if (found == kColumnNames.end()) {
    lines.fail(fmt::format(
        "unknown column {} (known: t, command and actual of X, Z and C, each with its unit; slot)",
        quoted(cell)));
  }
  return static_cast<std::size_t>(found - kColumnNames.begin());
}

double factor_of(const CsvLines& lines, std::string_view cell, std::size_t column) {
  if (column == kSlot) return 1.0;
  if (column == kTime) return time_unit(lines, cell, in_brackets(cell));
  std::string_view label;
  const CsvUnit unit = unit_of(lines, cell, label);
  if (unit.angle != is_angle(column))
    lines.fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
  return unit.factor;
}

void require_columns(const CsvLines& lines, const StrokeHeader& header) {
  for (const std::size_t needed : {kTime, kZCommand, kZActual, kCCommand, kCActual}) {
    if (!header.seen.at(needed))
      lines.fail(fmt::format("the header lacks the column \"{}\" [{}]", kColumnNames.at(needed),
                             code(Reason::missing_field)));
  }
  if (header.seen[kXCommand] != header.seen[kXActual])
    lines.fail("of X, command and actual are both there or neither is");
}

StrokeHeader read_header(const CsvLines& lines, std::string_view line) {
  StrokeHeader header;
  for (const std::string_view cell : lines.header_cells(line)) {
    const std::size_t column = column_of(lines, cell);
    if (header.seen.at(column)) lines.fail(fmt::format("column {} occurs twice", quoted(cell)));
    header.seen.at(column) = true;
    header.factor.at(column) = factor_of(lines, cell, column);
    header.column.push_back(column);
  }
  require_columns(lines, header);
  return header;
}

double most_of(std::size_t column) {
  if (column == kTime) return kLongest_s;
  if (column == kSlot) return kMostSlots;
  return is_angle(column) ? kFarthest_rad : kFarthest_mm;
}

StrokeSample read_sample(const CsvLines& lines, const StrokeHeader& header, std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != header.column.size())
    lines.fail(fmt::format("{} cells instead of {}", cells.size(), header.column.size()));
  std::array<double, kStrokeColumns> value{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t column = header.column[i];
    const std::string what = fmt::format("{}: ", kColumnNames.at(column));
    const double v = lines.number(cells[i], what) * header.factor.at(column);
    if (!std::isfinite(v) || std::abs(v) > most_of(column))
      lines.fail(fmt::format("{}{} is not finite or beyond any machine [{}]", what,
                             quoted(cells[i]), code(Reason::not_finite)));
    value.at(column) = v;
  }
  StrokeSample sample{value[kTime],
                      {value[kXCommand], value[kXActual]},
                      {value[kZCommand], value[kZActual]},
                      {value[kCCommand], value[kCActual]},
                      {},
                      lines.line()};
  if (!header.seen[kSlot]) return sample;
  if (value[kSlot] < 0.0 || std::floor(value[kSlot]) < value[kSlot])
    lines.fail("slot: must be a whole number from 0 on");
  sample.slot = static_cast<std::uint16_t>(value[kSlot]);
  return sample;
}

}  // namespace

StrokeLog read_stroke_table(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  std::string line;
  if (!lines.next(line)) throw UserError(name + ": the file is empty");
  const StrokeHeader header = read_header(lines, line);
  StrokeLog log{name, 0.0, header.seen[kXCommand], {}};
  while (lines.next(line)) {
    if (log.samples.size() == kMostStrokeSamples)
      lines.fail(fmt::format("more than {} lines", kMostStrokeSamples));
    const StrokeSample sample = read_sample(lines, header, line);
    if (!log.samples.empty() && sample.time_s <= log.samples.back().time_s)
      lines.fail("t: time does not go on from the line before");
    log.samples.push_back(sample);
  }
  if (log.samples.size() < 2) throw UserError(name + ": there are not two cycles after the header");
  set_period(log);
  return log;
}

}  // namespace volcomp::host
