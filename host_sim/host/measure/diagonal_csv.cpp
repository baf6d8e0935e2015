#include "host_sim/host/measure/diagonal_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMostDiagonals = 16;
constexpr std::size_t kMostTargets = 512;
constexpr std::size_t kMostRuns = 1000;  // of a diagonal, both directions together
constexpr double kLongest_mm = 1e6;

enum Column : std::uint8_t { kDiagonal, kTarget, kRun, kDirection, kDeviation, kColumns };
constexpr std::array<const char*, kColumns> kNames{"diagonal", "target [mm]", "run", "direction",
                                                   "deviation [um]"};

bool is_face_diagonal(const std::string& name) {
  static constexpr std::array<const char*, 6> kFaces{"XY+", "XY-", "XZ+", "XZ-", "YZ+", "YZ-"};
  return std::find(kFaces.begin(), kFaces.end(), name) != kFaces.end();
}

// Targets and runs of one diagonal as they come.
struct Collected {
  std::string name;
  std::map<long, DiagonalTarget> targets;  // by micrometres
  std::map<std::pair<bool, long>, std::map<long, double>> readings;
  std::map<std::pair<bool, long>, std::size_t> begin;  // line
};

class DiagonalsReader {
 public:
  DiagonalsReader(std::istream& stream, const std::string& name) : lines_(stream, name) {}

  DiagonalsFile read() {
    std::string line;
    while (lines_.next(line)) {
      if (column_.empty()) {
        read_header(line);
      } else {
        read_reading(line);
      }
    }
    if (column_.empty()) throw UserError(lines_.name() + ": the file is empty");
    if (diagonals_.empty())
      throw UserError(lines_.name() + ": there is no reading after the header");
    DiagonalsFile file{lines_.name(), {}};
    for (const Collected& c : diagonals_)
      file.diagonals.push_back(finish(c));
    return file;
  }

 private:
  Column column_of(std::string_view cell) {
    if (cell == "diagonal") return kDiagonal;
    if (cell == "run") return kRun;
    if (cell == "direction") return kDirection;
    std::string_view label;
    const double factor = length_unit(lines_, cell, label);
    if (label != "target" && label != "deviation")
      lines_.fail(
          fmt::format("unknown column {} (known: {})", quoted(cell), fmt::join(kNames, ", ")));
    const Column column = label == "target" ? kTarget : kDeviation;
    factor_.at(column) = factor;
    return column;
  }

  void read_header(std::string_view line) {
    std::array<bool, kColumns> seen{};
    for (const std::string_view cell : lines_.header_cells(line)) {
      const Column column = column_of(cell);
      if (seen.at(column)) lines_.fail(fmt::format("column {} occurs twice", quoted(cell)));
      seen.at(column) = true;
      column_.push_back(column);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen.at(i))
        lines_.fail(fmt::format("the header lacks the column {} [{}]", kNames.at(i),
                                code(Reason::missing_field)));
    }
  }

  double length(std::string_view cell, Column column) const {
    const double value = lines_.number(cell, fmt::format("{}: ", kNames.at(column)));
    if (!std::isfinite(value))
      lines_.fail(fmt::format("{} is {}, must be finite [{}]", kNames.at(column), quoted(cell),
                              code(Reason::not_finite)));
    const double mm = value * factor_.at(column);
    if (std::abs(mm) > kLongest_mm)
      lines_.fail(
          fmt::format("{} is {}, which is more than a kilometre", kNames.at(column), quoted(cell)));
    return mm;
  }

  Collected& diagonal_of(std::string_view cell) {
    const std::string name(cell);
    if (!is_body_diagonal(name) && !is_face_diagonal(name))
      lines_.fail(fmt::format(
          "diagonal {} is none of PPP, NPP, PNP, PPN (or their opposites), XY+, XY-, XZ+, XZ-, "
          "YZ+, YZ-",
          quoted(cell)));
    const auto found = std::find_if(diagonals_.begin(), diagonals_.end(),
                                    [&](const Collected& c) { return c.name == name; });
    if (found != diagonals_.end()) return *found;
    if (diagonals_.size() == kMostDiagonals)
      lines_.fail(fmt::format("more than {} diagonals", kMostDiagonals));
    return diagonals_.emplace_back(Collected{name, {}, {}, {}});
  }

  void read_reading(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != column_.size())
      lines_.fail(fmt::format("{} cells instead of {}", cells.size(), column_.size()));
    std::array<std::string_view, kColumns> cell;
    for (std::size_t i = 0; i < cells.size(); ++i)
      cell.at(column_[i]) = cells[i];
    const double run = lines_.number(cell[kRun], "run ");
    if (!(run >= 1.0 && run <= 1e6) || std::floor(run) < run)
      lines_.fail("'run' must be a whole number from 1");
    if (cell[kDirection] != "up" && cell[kDirection] != "down")
      lines_.fail(fmt::format("direction is {}, must be up or down", quoted(cell[kDirection])));
    const double target_mm = length(cell[kTarget], kTarget);
    const double deviation_mm = length(cell[kDeviation], kDeviation);
    place(diagonal_of(cell[kDiagonal]), target_mm, {cell[kDirection] == "up", std::lround(run)},
          deviation_mm);
  }

  void place(Collected& c, double target_mm, std::pair<bool, long> run, double deviation_mm) {
    const long key = std::lround(target_mm / kSameTarget_mm);
    c.targets.try_emplace(key, DiagonalTarget{target_mm, lines_.line()});
    if (c.targets.size() > kMostTargets)
      lines_.fail(fmt::format("diagonal {} has more than {} targets", c.name, kMostTargets));
    c.begin.try_emplace(run, lines_.line());
    if (c.begin.size() > kMostRuns)
      lines_.fail(fmt::format("diagonal {} has more than {} runs", c.name, kMostRuns));
    if (!c.readings[run].try_emplace(key, deviation_mm).second)
      lines_.fail(fmt::format("diagonal {}: run {} {} has target {:g} mm twice", c.name, run.second,
                              run.first ? "up" : "down", target_mm));
  }

  DiagonalRuns finish(const Collected& c) const {
    DiagonalRuns d{c.name, {}, {}};
    for (const auto& [key, target] : c.targets)
      d.targets.push_back(target);
    if (d.targets.size() < 2)
      throw UserError(fmt::format("{}:{}: diagonal {} has one target only [{}]", lines_.name(),
                                  d.targets[0].line, c.name, code(Reason::too_few_points)));
    for (const auto& [run, readings] : c.readings) {
      const std::size_t line = c.begin.at(run);
      if (readings.size() != d.targets.size())
        throw UserError(
            fmt::format("{}:{}: diagonal {}: run {} {} has {} of {} targets "
                        "[{}]",
                        lines_.name(), line, c.name, run.second, run.first ? "up" : "down",
                        readings.size(), d.targets.size(), code(Reason::run_length)));
      DiagonalRun r{run.second, run.first, line, {}};
      for (const auto& [key, value] : readings)
        r.deviation_mm.push_back(value);
      d.runs.push_back(std::move(r));
    }
    return d;
  }

  CsvLines lines_;
  std::vector<Column> column_;
  std::array<double, kColumns> factor_{};
  std::vector<Collected> diagonals_;
};

// What `a` has and `b` lacks.
void require_points_of(const DiagonalsFile& a, const DiagonalsFile& b) {
  for (const DiagonalRuns& d : a.diagonals) {
    const auto refuse = [&](std::size_t line, const std::string& what) {
      throw UserError(
          fmt::format("{}: lacks {} of {}:{}; before and after must hold the same points", b.name,
                      what, a.name, line));
    };
    const auto other = std::find_if(b.diagonals.begin(), b.diagonals.end(),
                                    [&](const DiagonalRuns& o) { return o.name == d.name; });
    if (other == b.diagonals.end()) refuse(d.targets[0].line, "diagonal " + d.name);
    for (const DiagonalTarget& t : d.targets) {
      const bool there =
          std::any_of(other->targets.begin(), other->targets.end(), [&](const DiagonalTarget& o) {
            return std::abs(o.distance_mm - t.distance_mm) <= kSameTarget_mm;
          });
      if (!there) refuse(t.line, fmt::format("diagonal {} target {:g} mm", d.name, t.distance_mm));
    }
    for (const DiagonalRun& r : d.runs) {
      const bool there =
          std::any_of(other->runs.begin(), other->runs.end(),
                      [&](const DiagonalRun& o) { return o.up == r.up && o.number == r.number; });
      if (!there)
        refuse(r.line,
               fmt::format("diagonal {} run {} {}", d.name, r.number, r.up ? "up" : "down"));
    }
  }
}

}  // namespace

bool is_body_diagonal(const std::string& name) {
  return name.size() == 3 && name.find_first_not_of("PN") == std::string::npos;
}

DiagonalsFile read_diagonals(std::istream& stream, const std::string& name) {
  return DiagonalsReader(stream, name).read();
}

DiagonalsFile read_diagonals_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_diagonals(file.stream(), file.name());
}

std::string diagonals_csv(const DiagonalsFile& file) {
  std::string text = fmt::format("{}\n", fmt::join(kNames, ","));
  for (const DiagonalRuns& d : file.diagonals) {
    for (const DiagonalRun& r : d.runs) {
      for (std::size_t t = 0; t < d.targets.size(); ++t)
        text += fmt::format("{},{:.4f},{},{},{:.4f}\n", d.name, d.targets[t].distance_mm, r.number,
                            r.up ? "up" : "down", 1e3 * r.deviation_mm[t]);
    }
  }
  return text;
}

void require_same_points(const DiagonalsFile& before, const DiagonalsFile& after) {
  require_points_of(before, after);
  require_points_of(after, before);
}

}  // namespace volcomp::host
