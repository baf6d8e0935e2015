#include "host_sim/host/measure/ball_bar/ball_bar_csv.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_facts.hpp"

namespace volcomp::host {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kTurn = 2.0 * kPi;
constexpr double kRounding = 1e-9;
constexpr std::size_t kMostCircles = 100;
constexpr std::size_t kMostReadings = 100'000;

enum Column : std::uint8_t { kAngle, kIndex, kRadial, kDirection, kColumns };
constexpr std::array<const char*, kColumns> kNames{"angle [deg]", "index", "radial [um]",
                                                   "direction"};

// Angles as they come: a wrap at a full turn is none.
double unwrapped(const BallBarCircle& circle, double theta) {
  if (circle.theta.empty()) return theta;
  return circle.theta.back() + std::remainder(theta - circle.theta.back(), kTurn);
}

bool goes_one_way(const std::vector<double>& theta) {
  const bool rises = theta.size() > 1 && theta[1] > theta[0];
  for (std::size_t i = 1; i < theta.size(); ++i)
    if ((theta[i] > theta[i - 1]) != rises) return false;
  return true;
}

// Keeps the first full turn; returns how many readings were beyond it, not counting the one that
// closes the circle. What goes to and fro is left as it is, to be refused.
std::size_t cut_overshoot(BallBarCircle& circle) {
  if (!goes_one_way(circle.theta)) return 0;
  const auto travelled = [&](double theta) { return std::abs(theta - circle.theta.front()); };
  const auto beyond = std::find_if(circle.theta.begin(), circle.theta.end(), [&](double theta) {
    return travelled(theta) >= kTurn - kRounding;
  });
  const auto kept = static_cast<std::size_t>(beyond - circle.theta.begin());
  std::size_t cut = circle.theta.size() - kept;
  if (cut > 0 && travelled(circle.theta[kept]) <= kTurn + kRounding) --cut;
  circle.theta.resize(kept);
  circle.radial.resize(kept);
  circle.line.resize(kept);
  return cut;
}

class BallBarReader {
 public:
  BallBarReader(std::istream& stream, const std::string& name) : lines_(stream, name) {
    test_.name = name;
  }

  BallBarTest read() {
    std::string line;
    while (lines_.any(line)) {
      const std::string_view content = trimmed(line);
      if (content.empty()) continue;
      if (content.front() == '#') {
        facts_.read(content.substr(1), readings_ > 0);
      } else if (is_header(content)) {
        read_header(content);
      } else if (column_.empty()) {
        lines_.fail(
            fmt::format("the first line that is no comment must name the columns: {}, {}, {}",
                        kNames[kAngle], kNames[kRadial], kNames[kDirection]));
      } else {
        read_reading(content);
      }
    }
    finish();
    return std::move(test_);
  }

 private:
  // A file of readings by number has a header for each direction.
  static bool is_header(std::string_view content) {
    return content.find("radial") != std::string_view::npos;
  }

  Column column_of(std::string_view cell) {
    if (cell == "direction") return kDirection;
    if (cell == "index") return kIndex;
    std::string_view label;
    const CsvUnit unit = unit_of(lines_, cell, label);
    if (label != "angle" && label != "radial")
      lines_.fail(
          fmt::format("unknown column {} (known: {})", quoted(cell), fmt::join(kNames, ", ")));
    const Column column = label == "angle" ? kAngle : kRadial;
    if (unit.angle != (column == kAngle))
      lines_.fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
    factor_.at(column) = unit.factor;
    return column;
  }

  void read_header(std::string_view line) {
    column_.clear();
    std::array<bool, kColumns> seen{};
    for (const std::string_view cell : lines_.header_cells(line)) {
      const Column column = column_of(cell);
      if (seen.at(column)) lines_.fail(fmt::format("column {} occurs twice", quoted(cell)));
      seen.at(column) = true;
      column_.push_back(column);
    }
    const auto need = [&](Column column) {
      if (!seen.at(column))
        lines_.fail(fmt::format("the header lacks the column {} [{}]", kNames.at(column),
                                code(Reason::missing_field)));
    };
    need(kRadial);
    if (!seen[kIndex]) need(kAngle);
    if (seen[kIndex] && seen[kAngle]) lines_.fail("angle and index say the same: one of them");
    if (seen[kIndex] &&
        !(facts_.numbering().start && (facts_.numbering().step || facts_.numbering().end)))
      lines_.fail(
          R"(readings by index need "# start_deg" and then "# step_deg" or "# end_deg" before them)");
    if (!seen[kDirection] && !facts_.direction())
      lines_.fail(fmt::format(R"(there is no column "direction" and no "# direction" [{}])",
                              code(Reason::missing_field)));
  }

  void read_reading(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != column_.size())
      lines_.fail(fmt::format("{} cells instead of {}", cells.size(), column_.size()));
    if (++readings_ > kMostReadings)
      lines_.fail(fmt::format("more than {} readings", kMostReadings));
    std::size_t direction = facts_.direction().value_or(0);
    std::array<double, kColumns> value{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (column_[i] == kDirection) {
        direction = circle_direction(lines_, cells[i]);
      } else {
        value.at(column_[i]) = reading(cells[i], column_[i]);
      }
    }
    BallBarCircle& circle = circle_of(direction);
    const bool by_index = std::find(column_.begin(), column_.end(), kIndex) != column_.end();
    if (by_index) {
      require_next(circle, value[kIndex]);
      numberings_.try_emplace(&circle, facts_.numbering());
    }
    // Those by number become angles when the last number is known.
    circle.theta.push_back(by_index ? value[kIndex] : unwrapped(circle, value[kAngle]));
    circle.radial.push_back(value[kRadial]);
    circle.line.push_back(lines_.line());
  }

  void require_next(const BallBarCircle& circle, double index) const {
    const auto next = static_cast<double>(circle.theta.size());
    if (index < next || index > next)
      lines_.fail(fmt::format("index is {:g}, the next one of this circle is {:g}", index, next));
  }

  double reading(std::string_view cell, Column column) const {
    const double value = lines_.number(cell, fmt::format("{}: ", kNames.at(column)));
    if (!std::isfinite(value))
      lines_.fail(fmt::format("{} is {}, must be finite [{}]", kNames.at(column), quoted(cell),
                              code(Reason::not_finite)));
    return value * factor_.at(column);
  }

  BallBarCircle& circle_of(std::size_t direction) {
    const auto [it, fresh] = circles_.try_emplace({direction, facts_.run()});
    it->second.run = facts_.run();
    if (circles_.size() > kMostCircles)
      lines_.fail(fmt::format("more than {} circles", kMostCircles));
    return it->second;
  }

  void number_to_angle(BallBarCircle& circle, std::size_t direction, const Numbering& n) const {
    const double sense = direction == 0 ? 1.0 : -1.0;
    const double travelled = n.end ? sense * (*n.end - *n.start) : 0.0;
    if (!n.step && !(travelled > 0.0))
      throw UserError(fmt::format("{}:{}: a circle {} from {:g} to {:g} deg goes the other way",
                                  lines_.name(), circle.line.front(),
                                  kCircleDirections.at(direction), *n.start / kDegree,
                                  *n.end / kDegree));
    const double step = n.step.value_or(travelled / std::max(1.0, circle.theta.back()));
    for (double& theta : circle.theta)
      theta = *n.start + sense * step * theta;
  }

  void finish() {
    if (column_.empty()) throw UserError(lines_.name() + ": the file is empty");
    if (readings_ == 0) throw UserError(lines_.name() + ": there is no reading after the header");
    for (auto& [key, circle] : circles_) {
      const auto numbered = numberings_.find(&circle);
      if (numbered != numberings_.end()) number_to_angle(circle, key.first, numbered->second);
      test_.overshoot += cut_overshoot(circle);
      test_.circle.at(key.first).push_back(circle);
    }
    require_checked();
  }

  // Refusals with the line of the reading they are about.
  void require_checked() const {
    const Status status = check(test_);
    if (status.ok()) return;
    const std::string_view direction = status.where.direction ? status.where.direction : "";
    std::size_t line = 0;
    for (std::size_t d = 0; d < kCircleDirections.size(); ++d) {
      for (const BallBarCircle& c : test_.circle.at(d)) {
        const bool here = direction == kCircleDirections.at(d) && status.where.run + 1 == c.run &&
                          !c.line.empty();
        if (here) line = c.line.at(static_cast<std::size_t>(std::max(0, status.where.index)));
      }
    }
    const std::string place = line > 0 ? fmt::format("{}:{}", lines_.name(), line) : lines_.name();
    require(status, place);
  }

  CsvLines lines_;
  BallBarTest test_;
  BallBarFacts facts_{lines_, test_};
  std::vector<Column> column_;
  std::array<double, kColumns> factor_{1.0, 1.0, 1.0, 1.0};
  std::map<std::pair<std::size_t, long>, BallBarCircle> circles_;  // by direction and run
  std::map<const BallBarCircle*, Numbering> numberings_;
  std::size_t readings_ = 0;
};

}  // namespace

BallBarTest read_ball_bar(std::istream& stream, const std::string& name) {
  return BallBarReader(stream, name).read();
}

BallBarTest read_ball_bar_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_ball_bar(file.stream(), file.name());
}

std::string ball_bar_csv(const BallBarTest& test) {
  std::string text = fmt::format("# plane {}\n# radius_mm {:g}\n", *test.plane, *test.radius);
  if (test.feed) text += fmt::format("# feed_mm_min {:g}\n", *test.feed);
  if (test.centre)
    text += fmt::format("# centre_mm {:g} {:g} {:g}\n", (*test.centre)(0), (*test.centre)(1),
                        (*test.centre)(2));
  text += fmt::format("# calibrated {}\n", test.calibrated ? "yes" : "no");
  if (test.temperature) text += fmt::format("# temperature_C {:g}\n", *test.temperature);
  if (test.cyclic[0] > 0.0 || test.cyclic[1] > 0.0)
    text += fmt::format("# cyclic_mm {:g} {:g}\n", test.cyclic[0], test.cyclic[1]);
  text += "angle [deg],radial [um],direction\n";
  for (std::size_t d = 0; d < test.circle.size(); ++d) {
    for (const BallBarCircle& c : test.circle[d]) {
      text += fmt::format("# run {}\n", c.run);
      for (std::size_t i = 0; i < c.theta.size(); ++i)
        text += fmt::format("{:.6f},{:.4f},{}\n", c.theta[i] / kDegree, 1e3 * c.radial[i],
                            kCircleDirections[d]);
    }
  }
  return text;
}

}  // namespace volcomp::host
