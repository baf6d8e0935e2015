#include "host_sim/host/measure/identify/observation_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host::identify {
namespace {

std::vector<std::string> reading_names(ObservationKind kind) {
  switch (kind) {
    case ObservationKind::tracer:
      return {"length"};
    case ObservationKind::bar:
      return {"radial"};
    case ObservationKind::diagonal:
    case ObservationKind::step:
      return {"displacement"};
    case ObservationKind::rtest:
      return {"DX", "DY", "DZ"};
    default:
      return {};
  }
}

bool is_touched(ObservationKind kind) {
  return kind == ObservationKind::centre || kind == ObservationKind::touch;
}

class TableReader {
 public:
  TableReader(std::istream& stream, const std::string& name, const MachineFile& machine,
              ObservationKind kind)
      : lines_(stream, name), machine_(machine), kind_(kind), readings_(reading_names(kind)) {
    table_.name = name;
  }

  ObservationTable read() {
    std::string line;
    if (!lines_.next(line)) throw UserError(table_.name + ": the file is empty");
    read_header(line);
    while (lines_.next(line))
      read_row(line);
    if (table_.rows.empty()) throw UserError(table_.name + ": there is no observation");
    return std::move(table_);
  }

 private:
  // What a cell of a column goes into.
  using Taker = std::function<void(std::string_view cell, TableRow& row)>;

  [[nodiscard]] std::size_t axis_named(std::string_view name) const {
    for (std::size_t a = 0; a < machine_.axes.size(); ++a)
      if (name.size() == 1 && name[0] == machine_.axes[a].letter) return a;
    return machine_.axes.size();
  }

  double number(std::string_view cell, const std::string& what) const {
    const double value = lines_.number(cell, what);
    if (!std::isfinite(value))
      lines_.fail(fmt::format("{}: {} must be finite", what, quoted(cell)));
    return value;
  }

  Taker word_taker(const std::string& name) {
    if (name == "tip") return [](std::string_view cell, TableRow& row) { row.tip = cell; };
    if (name == "setup") return [](std::string_view cell, TableRow& row) { row.setup = cell; };
    return [this](std::string_view cell, TableRow& row) {
      const double value = number(cell, "sphere");
      if (!(value >= 0.0) || value > 1e6 || std::abs(value - std::floor(value)) > 0.0)
        lines_.fail(fmt::format("sphere {} must be a number from 0", quoted(cell)));
      row.sphere = static_cast<std::size_t>(value);
    };
  }

  Taker direction_taker(std::size_t axis) {
    return [this, axis](std::string_view cell, TableRow& row) {
      if (cell != "+" && cell != "-" && cell != "0")
        lines_.fail(fmt::format("direction {} is {}, not +, - or 0", machine_.axes[axis].letter,
                                quoted(cell)));
      row.d.at(axis) = cell == "+" ? 1.0 : cell == "-" ? -1.0 : 0.0;
    };
  }

  Taker axis_taker(std::size_t axis, const CsvUnit& unit) {
    const std::string name(1, machine_.axes[axis].letter);
    return [this, axis, name, factor = unit.factor](std::string_view cell, TableRow& row) {
      row.q.at(axis) = factor * number(cell, name);
    };
  }

  Taker reading_taker(std::size_t k, const CsvUnit& unit) {
    table_.has_readings = true;
    return [this, k, factor = unit.factor](std::string_view cell, TableRow& row) {
      row.value.resize(readings_.size());
      row.value[k] = factor * number(cell, readings_[k]);
    };
  }

  // Name of a column without its unit, and what takes its cells.
  std::pair<std::string, Taker> column(std::string_view cell) {
    constexpr std::string_view kDirection = "direction ";
    const std::string whole(cell);
    const bool touched = is_touched(kind_);
    if (whole == "tip" || (touched && (whole == "setup" || whole == "sphere")))
      return {whole, word_taker(whole)};
    if (cell.substr(0, kDirection.size()) == kDirection) {
      const std::size_t axis = axis_named(cell.substr(kDirection.size()));
      if (axis < machine_.axes.size()) return {whole, direction_taker(axis)};
      lines_.fail(fmt::format("column {}: the machine has no such axis", quoted(cell)));
    }
    std::string_view label;
    const CsvUnit unit = unit_of(lines_, cell, label);
    const auto reading = std::find(readings_.begin(), readings_.end(), label);
    const std::size_t axis = axis_named(label);
    if (axis == machine_.axes.size() && reading == readings_.end())
      lines_.fail(fmt::format("unknown column {} (known: {})", quoted(cell), known()));
    const bool angle = axis < machine_.axes.size() && machine_.axes[axis].rotary;
    if (unit.angle != angle)
      lines_.fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
    if (axis < machine_.axes.size()) return {std::string(label), axis_taker(axis, unit)};
    return {std::string(label),
            reading_taker(static_cast<std::size_t>(reading - readings_.begin()), unit)};
  }

  [[nodiscard]] std::string known() const {
    std::vector<std::string> names;
    for (const AxisFile& axis : machine_.axes)
      names.push_back(fmt::format("{} [{}]", axis.letter, axis.rotary ? "deg" : "mm"));
    for (const AxisFile& axis : machine_.axes)
      names.push_back(fmt::format("direction {}", axis.letter));
    names.emplace_back("tip");
    if (is_touched(kind_)) names.insert(names.end(), {"setup", "sphere"});
    for (const std::string& reading : readings_)
      names.push_back(reading + " [um]");
    return fmt::format("{}", fmt::join(names, ", "));
  }

  void read_header(const std::string& line) {
    std::vector<std::string> names;
    for (const std::string_view cell : lines_.header_cells(line)) {
      auto [name, take] = column(cell);
      if (std::find(names.begin(), names.end(), name) != names.end())
        lines_.fail(fmt::format("column {} occurs twice", quoted(cell)));
      names.push_back(name);
      take_.push_back(std::move(take));
    }
    const auto need = [&](const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end())
        lines_.fail(
            fmt::format("the header lacks the column {} [{}]", name, code(Reason::missing_field)));
    };
    for (const AxisFile& axis : machine_.axes)
      need(std::string(1, axis.letter));
    if (is_touched(kind_)) {
      need("setup");
      need("sphere");
      table_.has_readings = true;
    }
    if (table_.has_readings)
      for (const std::string& reading : readings_)
        need(reading);
  }

  void read_row(const std::string& line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != take_.size())
      lines_.fail(fmt::format("{} cells instead of {}", cells.size(), take_.size()));
    if (table_.rows.size() == kMostObservations)
      lines_.fail(fmt::format("more than {} observations", kMostObservations));
    TableRow row;
    row.line = lines_.line();
    for (std::size_t i = 0; i < cells.size(); ++i)
      take_[i](cells[i], row);
    table_.rows.push_back(std::move(row));
  }

  CsvLines lines_;
  const MachineFile& machine_;
  ObservationKind kind_;
  std::vector<std::string> readings_;
  std::vector<Taker> take_;
  ObservationTable table_;
};

}  // namespace

ObservationTable read_observation_table(std::istream& stream, const std::string& name,
                                        const MachineFile& machine, ObservationKind kind) {
  return TableReader(stream, name, machine, kind).read();
}

ObservationTable read_observation_table(const std::filesystem::path& path,
                                        const MachineFile& machine, ObservationKind kind) {
  InputFile file(path);
  return read_observation_table(file.stream(), file.name(), machine, kind);
}

}  // namespace volcomp::host::identify
