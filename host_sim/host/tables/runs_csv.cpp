#include "host_sim/host/tables/runs_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMaxRuns = 1000;  // both directions together

// What a column holds. Channels 0…5 = EX…EC.
struct Column {
  enum class Kind { target, run, direction, channel } kind = Kind::run;
  std::size_t channel = 0;
  double factor = 1.0;
};

// With its line in the file, which every reading has, so 0 is none.
struct Placed {
  ErrorMotion value = ErrorMotion::Zero();
  std::size_t line = 0;
};

struct Reading {
  double target = 0.0;
  long run = 0;
  bool up = true;
  ErrorMotion value = ErrorMotion::Zero();
};

class RunsReader {
 public:
  RunsReader(std::istream& stream, const std::string& name) : lines_(stream, name) {}

  RunsFile read() {
    std::string line;
    while (lines_.next(line)) {
      if (columns_.empty()) {
        read_header(line);
      } else {
        place(read_reading(line));
      }
    }
    if (columns_.empty()) throw UserError(lines_.name() + ": the file is empty");
    if (positions_.empty())
      throw UserError(lines_.name() + ": there is no reading after the header");
    return finish();
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { lines_.fail(text); }

  Column channel_column(std::string_view cell) {
    std::string_view label;
    const CsvUnit unit = unit_of(lines_, cell, label);
    if (label == "target") {
      target_is_angle_ = unit.angle;
      return {Column::Kind::target, 0, unit.factor};
    }
    static constexpr std::string_view kKinds = "XYZABC";
    const bool shaped = label.size() == 3 && label[0] == 'E';
    const std::size_t channel = shaped ? kKinds.find(label[1]) : std::string_view::npos;
    if (channel == std::string_view::npos) fail(fmt::format("unknown column {}", quoted(cell)));
    if (letter_ != '\0' && letter_ != label[2]) fail("the channels belong to different axes");
    letter_ = label[2];
    if (unit.angle != (channel >= 3))
      fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
    return {Column::Kind::channel, channel, unit.factor};
  }

  // Column names of the slots of read_header; "EY?" where no channel has named the axis.
  [[nodiscard]] std::string column_name(std::size_t slot) const {
    static constexpr std::array<const char*, 3> kOthers{"target", "run", "direction"};
    if (slot < kOthers.size()) return kOthers.at(slot);
    return fmt::format("E{}{}", "XYZABC"[slot - kOthers.size()], letter_ == '\0' ? '?' : letter_);
  }

  void read_header(std::string_view line) {
    std::array<int, 9> seen{};  // target, run, direction, six channels
    for (const std::string_view cell : lines_.header_cells(line)) {
      Column column;
      if (cell == "run") {
        column.kind = Column::Kind::run;
      } else if (cell == "direction") {
        column.kind = Column::Kind::direction;
      } else {
        column = channel_column(cell);
      }
      const std::size_t slot = column.kind == Column::Kind::target      ? 0
                               : column.kind == Column::Kind::run       ? 1
                               : column.kind == Column::Kind::direction ? 2
                                                                        : 3 + column.channel;
      if (++seen.at(slot) > 1) fail(fmt::format("column {} occurs twice", quoted(cell)));
      columns_.push_back(column);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] == 0)
        fail(fmt::format("the header lacks the column {} [{}]", column_name(i),
                         code(Reason::missing_field)));
    }
    // ISO 841: X, Y, Z are linear, A, B, C turn; another letter may be either.
    const bool turns = std::string_view("ABC").find(letter_) != std::string_view::npos;
    const bool linear = std::string_view("XYZ").find(letter_) != std::string_view::npos;
    if (target_is_angle_ ? linear : turns)
      fail(fmt::format("the unit of the targets is of the wrong kind for axis {}", letter_));
  }

  Reading read_reading(std::string_view line) const {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != columns_.size()) {
      fail(fmt::format("{} cells instead of {}", cells.size(), columns_.size()));
    }
    Reading r;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Column& c = columns_[i];
      switch (c.kind) {
        case Column::Kind::target:
          r.target = lines_.number(cells[i]) * c.factor;
          if (!std::isfinite(r.target))
            fail(fmt::format("a target position must be finite [{}]", code(Reason::not_finite)));
          break;
        case Column::Kind::run: {
          const double run = lines_.number(cells[i]);
          if (!(run >= 1.0 && run <= 1e6) || std::floor(run) < run)
            fail("'run' must be a whole number from 1");
          r.run = static_cast<long>(run);
          break;
        }
        case Column::Kind::direction:
          if (cells[i] != "up" && cells[i] != "down")
            fail(fmt::format("direction is {}, must be up or down", quoted(cells[i])));
          r.up = cells[i] == "up";
          break;
        case Column::Kind::channel:
          r.value(static_cast<Eigen::Index>(c.channel)) = lines_.number(cells[i]) * c.factor;
          break;
      }
    }
    return r;
  }

  // Targets are identified by value: the first run that shows one gives its place.
  void place(const Reading& r) {
    const long key = std::lround(std::clamp(r.target, -1e12, 1e12) * 1e5);
    const auto [it, fresh] = target_index_.try_emplace(key, positions_.size());
    if (fresh) {
      if (positions_.size() == kTableKnots)
        fail(fmt::format("more than {} targets [{}]", kTableKnots, code(Reason::too_many_knots)));
      positions_.push_back(r.target);
    }
    auto& run = runs_[{r.up, r.run}];
    if (runs_.size() > kMaxRuns) fail(fmt::format("more than {} runs", kMaxRuns));
    if (run.size() <= it->second) run.resize(it->second + 1);
    if (run[it->second].line != 0)
      fail(fmt::format("run {} {} has target {} twice", r.run, r.up ? "up" : "down", r.target));
    run[it->second] = {r.value, lines_.line()};
  }

  RunsFile finish() const {
    RunsFile file;
    file.name = lines_.name();
    file.letter = letter_;
    file.positions = positions_;
    for (const auto& [key, values] : runs_) {
      RunValues run;
      RunLines at;
      for (const Placed& placed : values) {
        if (placed.line == 0) continue;
        run.push_back(placed.value);
        at.push_back(placed.line);
      }
      if (run.size() != positions_.size()) {
        throw UserError(fmt::format("{}: run {} {} has {} of {} targets [{}]", lines_.name(),
                                    key.second, key.first ? "up" : "down", run.size(),
                                    positions_.size(), code(Reason::run_length)));
      }
      (key.first ? file.up : file.down).push_back(run);
      (key.first ? file.up_lines : file.down_lines).push_back(at);
    }
    return file;
  }

  CsvLines lines_;
  char letter_ = '\0';
  bool target_is_angle_ = false;
  std::vector<Column> columns_;
  std::vector<double> positions_;
  std::map<long, std::size_t> target_index_;
  std::map<std::pair<bool, long>, std::vector<Placed>> runs_;
};

}  // namespace

RunViews::RunViews(const RunsFile& file) {
  for (const RunValues& run : file.up)
    up.emplace_back(run.data(), run.size());
  for (const RunValues& run : file.down)
    down.emplace_back(run.data(), run.size());
}

std::string RunsFile::place_of(bool upwards, std::size_t run, std::size_t target) const {
  const std::vector<RunLines>& lines = upwards ? up_lines : down_lines;
  if (run >= lines.size() || target >= lines[run].size()) return name;
  return fmt::format("{}:{}", name, lines[run][target]);
}

RunsFile read_runs(std::istream& stream, const std::string& name) {
  return RunsReader(stream, name).read();
}

RunsFile read_runs_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_runs(file.stream(), file.name());
}

void write_runs(std::ostream& stream, const RunsFile& runs) {
  const bool rotary = runs.letter >= 'A' && runs.letter <= 'C';
  fmt::print(stream, "target [{}],run,direction", rotary ? "rad" : "mm");
  for (const char c : {'X', 'Y', 'Z'})
    fmt::print(stream, ",E{}{} [mm]", c, runs.letter);
  for (const char c : {'A', 'B', 'C'})
    fmt::print(stream, ",E{}{} [rad]", c, runs.letter);
  fmt::print(stream, "\n");
  const auto write = [&](const std::vector<RunValues>& list, const char* direction) {
    for (std::size_t r = 0; r < list.size(); ++r) {
      for (std::size_t t = 0; t < list[r].size(); ++t) {
        fmt::print(stream, "{},{},{}", runs.positions[t], r + 1, direction);
        for (Eigen::Index c = 0; c < 6; ++c)
          fmt::print(stream, ",{}", list[r][t](c));
        fmt::print(stream, "\n");
      }
    }
  };
  write(runs.up, "up");
  write(runs.down, "down");
}

std::string runs_csv(const RunsFile& runs) {
  std::ostringstream text;
  write_runs(text, runs);
  return text.str();
}

void write_runs_file(const std::filesystem::path& path, const RunsFile& runs) {
  write_whole_file(path, runs_csv(runs));
}

}  // namespace volcomp::host
