#include "host_sim/host/measure/ball_bar/ball_bar_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "comp/core/units.hpp"

namespace volcomp::host {
namespace {

constexpr double kRadPerDegree = kPi / 180.0;
constexpr double kMostRun = 1e6;

// How many values each has.
const std::map<std::string_view, std::size_t>& facts_of_test() {
  static const std::map<std::string_view, std::size_t> kFacts{
      {"plane", 1},      {"radius_mm", 1},     {"feed_mm_min", 1}, {"centre_mm", 3},
      {"calibrated", 1}, {"temperature_C", 1}, {"cyclic_mm", 2}};
  return kFacts;
}
bool is_of_circle(std::string_view key) {
  return key == "run" || key == "direction" || key == "start_deg" || key == "step_deg" ||
         key == "end_deg";
}

}  // namespace

std::size_t circle_direction(const CsvLines& lines, std::string_view word) {
  if (word != "ccw" && word != "cw")
    lines.fail(fmt::format("direction is {}, must be ccw or cw", quoted(word)));
  return word == "ccw" ? 0 : 1;
}

void BallBarFacts::read(std::string_view text, bool late) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.empty()) return;
  const auto fact = facts_of_test().find(words[0]);
  const bool of_circle = is_of_circle(words[0]);
  if (fact == facts_of_test().end() && !of_circle) return;
  const std::size_t values = of_circle ? 1 : fact->second;
  if (words.size() < values + 1)
    lines_.fail(
        fmt::format(R"("# {}" needs {} value{})", words[0], values, values == 1 ? "" : "s"));
  if (of_circle) return take_of_circle(words[0], words);
  if (late) lines_.fail(fmt::format(R"("# {}" must stand before the readings)", words[0]));
  take(words[0], words);
}

double BallBarFacts::number(std::string_view word, std::string_view key) const {
  const double value = lines_.number(word, fmt::format("{}: ", key));
  if (!std::isfinite(value))
    lines_.fail(
        fmt::format("{} is {}, must be finite [{}]", key, quoted(word), code(Reason::not_finite)));
  return value;
}

void BallBarFacts::take(std::string_view key, const std::vector<std::string_view>& words) {
  const auto value = [&](std::size_t i) { return number(words[i], key); };
  if (key == "plane") test_.plane = std::string(words[1]);
  if (key == "radius_mm") test_.radius = value(1);
  if (key == "feed_mm_min") test_.feed = value(1);
  if (key == "centre_mm") test_.centre = Vec3(value(1), value(2), value(3));
  if (key == "calibrated") test_.calibrated = yes_or_no(words[1]);
  if (key == "temperature_C") test_.temperature = value(1);
  if (key == "cyclic_mm") test_.cyclic = {value(1), value(2)};
}

void BallBarFacts::take_of_circle(std::string_view key,
                                  const std::vector<std::string_view>& words) {
  if (key == "direction") direction_ = circle_direction(lines_, words[1]);
  if (key == "direction") return;
  const double value = number(words[1], key);
  if (key == "run") run_ = run_number(value);
  if (key == "start_deg") numbering_ = {value * kRadPerDegree, {}, {}};
  if (key == "step_deg") numbering_.step = positive(value) * kRadPerDegree;
  if (key == "end_deg") numbering_.end = value * kRadPerDegree;
}

double BallBarFacts::positive(double step) const {
  if (!(step > 0.0)) lines_.fail(R"("# step_deg" is positive, whichever way the circle goes)");
  return step;
}

bool BallBarFacts::yes_or_no(std::string_view word) const {
  if (word != "yes" && word != "no") lines_.fail(R"("# calibrated" is yes or no)");
  return word == "yes";
}

long BallBarFacts::run_number(double value) const {
  if (!(value >= 1.0 && value <= kMostRun) || std::floor(value) < value)
    lines_.fail(R"("# run" must be a whole number from 1)");
  return std::lround(value);
}

}  // namespace volcomp::host
