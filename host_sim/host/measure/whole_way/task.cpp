#include "host_sim/host/measure/whole_way/task.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kAtTheEnd = 1e-6;  // mm or rad
constexpr double kRadPerDegree = kPi / 180.0;

double shown(const AxisFile& axis, double q) { return axis.rotary ? q / kRadPerDegree : q; }
const char* shown_unit(const AxisFile& axis) { return axis.rotary ? "deg" : "mm"; }

// The axis that a place leaves, in words; empty: none.
std::string outside(const Pose& place, const MachineFile& machine) {
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisFile& axis = machine.axes[a];
    if (place[a] >= axis.lo - kAtTheEnd && place[a] <= axis.hi + kAtTheEnd) continue;
    return fmt::format("{} {:g} {} is outside the travel {:g} … {:g} {}", axis.letter,
                       shown(axis, place[a]), shown_unit(axis), shown(axis, axis.lo),
                       shown(axis, axis.hi), shown_unit(axis));
  }
  return {};
}

std::string letters_of(const MachineFile& machine) {
  std::string letters;
  for (const AxisFile& axis : machine.axes)
    letters += fmt::format(" {}", axis.letter);
  return letters;
}

// A number as everywhere, finite.
std::optional<double> number_in(std::string_view cell) {
  std::istringstream none;
  try {
    const double value = CsvLines(none, {}).number(cell);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  } catch (const UserError&) {
    return std::nullopt;
  }
}

Pose place_from(const std::string& text, const std::string& option, const MachineFile& machine) {
  const std::vector<std::string_view> cells = cells_of(text);
  if (cells.size() != machine.axes.size())
    throw UserError(fmt::format("{} {}: {} positions, the machine has the axes{}", option, text,
                                cells.size(), letters_of(machine)));
  Pose place{};
  for (std::size_t a = 0; a < cells.size(); ++a) {
    const std::optional<double> value = number_in(cells[a]);
    if (!value)
      throw UserError(fmt::format("{} {}: {} is not a number", option, text, quoted(cells[a])));
    place[a] = machine.axes[a].rotary ? *value * kRadPerDegree : *value;
  }
  if (const std::string where = outside(place, machine); !where.empty())
    throw UserError(fmt::format("{} {}: {}", option, text, where));
  return place;
}

struct TaskColumn {
  std::size_t axis = 0;
  double factor = 1.0;
};

std::vector<TaskColumn> task_columns(const CsvLines& lines, std::string_view header,
                                     const MachineFile& machine) {
  std::vector<TaskColumn> columns;
  std::vector<bool> seen(machine.axes.size());
  for (const std::string_view cell : lines.header_cells(header)) {
    std::string_view label;
    const CsvUnit unit = unit_of(lines, cell, label);
    const auto axis = std::find_if(machine.axes.begin(), machine.axes.end(), [&](const auto& a) {
      return label.size() == 1 && label[0] == a.letter;
    });
    if (axis == machine.axes.end())
      lines.fail(fmt::format("unknown column {}, the machine has the axes{}", quoted(cell),
                             letters_of(machine)));
    if (unit.angle != axis->rotary)
      lines.fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
    const auto a = static_cast<std::size_t>(axis - machine.axes.begin());
    if (seen[a]) lines.fail(fmt::format("column {} occurs twice", quoted(cell)));
    seen[a] = true;
    columns.push_back({a, unit.factor});
  }
  for (std::size_t a = 0; a < seen.size(); ++a) {
    if (seen[a]) continue;
    lines.fail(fmt::format("the header lacks the column {} [{}] [{}]", machine.axes[a].letter,
                           shown_unit(machine.axes[a]), code(Reason::missing_field)));
  }
  return columns;
}

}  // namespace

Task point_task(const std::string& point, const MachineFile& machine) {
  return {"--point " + point, TaskKind::point, {place_from(point, "--point", machine)}};
}

Task line_task(const std::string& line, std::size_t places, const MachineFile& machine) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos || line.find(':', colon + 1) != std::string::npos)
    throw UserError(fmt::format("--line {}: two places with a colon between them", line));
  const Pose from = place_from(line.substr(0, colon), "--line", machine);
  const Pose to = place_from(line.substr(colon + 1), "--line", machine);
  if (from == to) throw UserError(fmt::format("--line {}: both ends are the same place", line));
  Task task{"--line " + line, TaskKind::line, {}};
  for (std::size_t i = 0; i < places; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(places - 1);
    Pose place{};
    for (std::size_t a = 0; a < machine.axes.size(); ++a)
      place[a] = from[a] + part * (to[a] - from[a]);
    task.places.push_back(place);
  }
  return task;
}

Task read_task(std::istream& stream, const std::string& name, const MachineFile& machine) {
  CsvLines lines(stream, name);
  std::string line;
  if (!lines.next(line)) throw UserError(name + ": the file is empty");
  const std::vector<TaskColumn> columns = task_columns(lines, line, machine);
  Task task{name, TaskKind::places, {}};
  while (lines.next(line)) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != columns.size())
      lines.fail(fmt::format("{} cells instead of {}", cells.size(), columns.size()));
    Pose place{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double value = lines.number(cells[i]);
      if (!std::isfinite(value))
        lines.fail(fmt::format("a position must be finite [{}]", code(Reason::not_finite)));
      place[columns[i].axis] = value * columns[i].factor;
    }
    if (const std::string where = outside(place, machine); !where.empty()) lines.fail(where);
    task.places.push_back(place);
    if (task.places.size() > kMostTaskPlaces)
      lines.fail(fmt::format("more than {} places", kMostTaskPlaces));
  }
  if (task.places.empty()) throw UserError(name + ": there is no place after the header");
  return task;
}

Task read_task_file(const std::filesystem::path& path, const MachineFile& machine) {
  InputFile file(path);
  return read_task(file.stream(), file.name(), machine);
}

std::string place_text(const Pose& place, const MachineFile& machine) {
  std::vector<std::string> parts;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisFile& axis = machine.axes[a];
    parts.push_back(
        fmt::format("{} {:.6g} {}", axis.letter, shown(axis, place[a]), shown_unit(axis)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace volcomp::host
