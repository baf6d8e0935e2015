#include "host_sim/host/measure/gear_points_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kFarthestPoint_mm = 1e5;
constexpr int kMostTeeth = 1000;

enum GearColumn : std::size_t { kTrace, kFlank, kTooth, kX, kY, kZ, kAt, kDeviation, kColumns };
constexpr std::array<const char*, kColumns> kGearColumnNames{"trace", "flank", "tooth",    "X", "Y",
                                                             "Z",     "at",    "deviation"};
constexpr std::array<const char*, 3> kTraceNames{"profile", "lead", "pitch"};

struct GearHeader {
  std::vector<std::size_t> column;  // of each cell
  std::array<double, kColumns> factor{};
  std::array<bool, kColumns> seen{};

  [[nodiscard]] bool has_coordinates() const { return seen[kX] || seen[kY] || seen[kZ]; }
};

std::size_t gear_column(const CsvLines& lines, std::string_view label, std::string_view cell) {
  const auto* const found = std::find(kGearColumnNames.begin(), kGearColumnNames.end(), label);
  if (found == kGearColumnNames.end())
    lines.fail(fmt::format("unknown column {} (known: trace flank tooth, X Y Z or at deviation)",
                           quoted(cell)));
  return static_cast<std::size_t>(found - kGearColumnNames.begin());
}

void require_gear_columns(const CsvLines& lines, const GearHeader& h) {
  const bool places = h.has_coordinates();
  if (places && (h.seen[kAt] || h.seen[kDeviation]))
    lines.fail("X Y Z and at, deviation say the same: only one of them can be there");
  for (std::size_t i = 0; i < kColumns; ++i) {
    const bool needed = i <= kTooth || (places ? i <= kZ : i >= kAt);
    if (needed && !h.seen.at(i))
      lines.fail(fmt::format("the header lacks the column {}{} [{}]", kGearColumnNames.at(i),
                             i <= kTooth       ? ""
                             : i == kDeviation ? " [um]"
                                               : " [mm]",
                             code(Reason::missing_field)));
  }
}

GearHeader read_gear_header(const CsvLines& lines, std::string_view line) {
  GearHeader h;
  for (const std::string_view cell : lines.header_cells(line)) {
    const bool word = cell == "trace" || cell == "flank" || cell == "tooth";
    std::string_view label = cell;
    const double factor = word ? 1.0 : length_unit(lines, cell, label);
    const std::size_t column = gear_column(lines, label, cell);
    if (h.seen.at(column)) lines.fail(fmt::format("column {} occurs twice", quoted(cell)));
    h.seen.at(column) = true;
    h.factor.at(column) = factor;
    h.column.push_back(column);
  }
  require_gear_columns(lines, h);
  return h;
}

GearTraceKind trace_from(const CsvLines& lines, std::string_view cell) {
  const auto* const found = std::find(kTraceNames.begin(), kTraceNames.end(), cell);
  if (found == kTraceNames.end())
    lines.fail(fmt::format("trace is {}, must be profile, lead or pitch", quoted(cell)));
  return static_cast<GearTraceKind>(found - kTraceNames.begin());
}

FlankSide flank_from(const CsvLines& lines, std::string_view cell) {
  if (cell != "left" && cell != "right")
    lines.fail(fmt::format("flank is {}, must be left or right", quoted(cell)));
  return cell == "left" ? FlankSide::left : FlankSide::right;
}

int tooth_from(const CsvLines& lines, std::string_view cell) {
  const double tooth = lines.number(cell, "tooth: ");
  if (!(tooth >= 1.0 && tooth <= kMostTeeth) || std::floor(tooth) < tooth)
    lines.fail(
        fmt::format("tooth {} must be a whole number from 1 to {}", quoted(cell), kMostTeeth));
  return static_cast<int>(tooth) - 1;
}

double length_from(const CsvLines& lines, std::string_view cell, std::size_t column,
                   double factor) {
  const double mm = lines.number(cell, fmt::format("{}: ", kGearColumnNames.at(column))) * factor;
  if (!std::isfinite(mm) || std::abs(mm) > kFarthestPoint_mm)
    lines.fail(fmt::format("{}: {} must be finite and less than 100 m [{}]",
                           kGearColumnNames.at(column), quoted(cell), code(Reason::not_finite)));
  return mm;
}

GearPoint read_gear_point(const CsvLines& lines, const GearHeader& header, std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != header.column.size())
    lines.fail(fmt::format("{} cells instead of {}", cells.size(), header.column.size()));
  const auto cell_of = [&](std::size_t column) {
    const auto at = std::find(header.column.begin(), header.column.end(), column);
    return cells[static_cast<std::size_t>(at - header.column.begin())];
  };
  const auto length = [&](std::size_t column) {
    return length_from(lines, cell_of(column), column, header.factor.at(column));
  };
  GearPoint point;
  point.line = lines.line();
  point.trace = trace_from(lines, cell_of(kTrace));
  point.side = flank_from(lines, cell_of(kFlank));
  point.tooth = tooth_from(lines, cell_of(kTooth));
  if (header.has_coordinates()) {
    point.place = Vec3(length(kX), length(kY), length(kZ));
    return point;
  }
  if (point.trace != GearTraceKind::pitch || !cell_of(kAt).empty()) point.at = length(kAt);
  point.deviation_mm = length(kDeviation);
  return point;
}

}  // namespace

const char* name_of(GearTraceKind kind) { return kTraceNames.at(static_cast<std::size_t>(kind)); }

GearPointsFile read_gear_points(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  std::string line;
  if (!lines.next(line)) throw UserError(name + ": the file is empty");
  const GearHeader header = read_gear_header(lines, line);
  GearPointsFile file{name, header.has_coordinates(), {}};
  while (lines.next(line)) {
    if (file.points.size() == kMostGearPoints)
      lines.fail(fmt::format("more than {} points", kMostGearPoints));
    file.points.push_back(read_gear_point(lines, header, line));
  }
  if (file.points.empty()) throw UserError(name + ": there is no point after the header");
  return file;
}

GearPointsFile read_gear_points_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_gear_points(file.stream(), file.name());
}

}  // namespace volcomp::host
