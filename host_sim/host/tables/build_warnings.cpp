#include "host_sim/host/tables/build_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// Least removed slope that is reported: less is the flatness of the reference.
constexpr double kSlopeToSay_mm = 1e-3;

// "EXX": the motion (X to C) and the axis that moves, as in the header of the file.
std::string channel_name(int channel, char axis) {
  return fmt::format("E{}{}", "XYZABC"[channel], axis);
}

std::size_t target_at(const RunsFile& runs, double position) {
  const auto at = std::min_element(
      runs.positions.begin(), runs.positions.end(),
      [&](double a, double b) { return std::abs(a - position) < std::abs(b - position); });
  return static_cast<std::size_t>(at - runs.positions.begin());
}

// "-3.210 um" or "12.0 urad".
std::string shown_value(double value, int channel) {
  return channel < 3 ? fmt::format("{:.3f} um", 1e3 * value)
                     : fmt::format("{:.3f} urad", 1e6 * value);
}

std::string shown_position(double q, const AxisFile& axis) {
  return fmt::format("{:g} {}", q, axis.rotary ? "rad" : "mm");
}

std::string outlier_words(const RunsFile& runs, const AxisFile& axis, const BuiltTable& built) {
  const Outlier& o = built.outlier[0];
  const double q = built.positions.at(static_cast<std::size_t>(o.target));
  return fmt::format(
      "{}: {} at {}, run {} {}, is {} instead of {}: far from the median of its target, and kept "
      "in the mean{}",
      runs.place_of(o.direction == std::string_view("up"), static_cast<std::size_t>(o.run),
                    target_at(runs, q)),
      channel_name(o.channel, axis.letter), shown_position(q, axis), o.run + 1, o.direction,
      shown_value(o.value, o.channel), shown_value(o.median, o.channel),
      built.outlier_count == 1
          ? ""
          : fmt::format("; so are {} more readings of {}", built.outlier_count - 1, axis.letter));
}

std::string slope_words(const AxisFile& axis, const BuiltTable& built) {
  const auto* const steepest =
      std::max_element(built.removed_slope.begin(), built.removed_slope.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); });
  return fmt::format(
      "{} has a slope of {:.0f} urad, steep for a straightness",
      channel_name(static_cast<int>(steepest - built.removed_slope.begin()), axis.letter),
      1e6 * *steepest);
}

// Between two neighbouring knots, in limits of a jump.
struct Jump {
  std::size_t knot = 0;
  int channel = 0;
  double change = 0.0;
  double limits = 0.0;
};

Jump largest_jump(const ErrorTable& table) {
  Jump largest;
  for (std::size_t t = 1; t < table.knots; ++t) {
    const ErrorMotion change =
        table.at_knot(t, Travel::unknown) - table.at_knot(t - 1, Travel::unknown);
    for (int c = 0; c < 6; ++c) {
      const double limits = std::abs(change(c)) / (c < 3 ? kJump_mm : kJump_rad);
      if (limits > largest.limits) largest = {t, c, change(c), limits};
    }
  }
  return largest;
}

std::string jump_words(const AxisFile& axis, const BuiltTable& built) {
  const Jump jump = largest_jump(built.table);
  return fmt::format("{} jumps by {} between {} and {}", channel_name(jump.channel, axis.letter),
                     shown_value(jump.change, jump.channel),
                     shown_position(built.table.knot(jump.knot - 1), axis),
                     shown_position(built.table.knot(jump.knot), axis));
}

// With the place it concerns: a line of the file, or all of it.
std::string warning_words(Warning warning, const RunsFile& runs, const AxisFile& axis,
                          const BuiltTable& built) {
  switch (warning) {
    case Warning::positions_reversed:
      return fmt::format("{}: the targets of {} are in descending order", runs.name, axis.letter);
    case Warning::one_direction:
      return fmt::format("{}: {} was measured in one direction only, its reversal is unknown",
                         runs.name, axis.letter);
    case Warning::run_count_differs:
      return fmt::format("{}: {} has {} runs up but {} down", runs.name, axis.letter,
                         runs.up.size(), runs.down.size());
    case Warning::outlier:
      return outlier_words(runs, axis, built);
    case Warning::steep_slope:
      return fmt::format("{}: {}", runs.name, slope_words(axis, built));
    case Warning::knot_jump:
      return fmt::format("{}: {}", runs.name, jump_words(axis, built));
  }
  return runs.name;
}

// Place of what was refused: the line of its reading, or of the first one of the target or run.
std::string place_of(const Where& where, const RunsFile& runs) {
  const bool up =
      where.direction == nullptr ? !runs.up.empty() : where.direction == std::string_view("up");
  if (where.run < 0 && where.target < 0) return runs.name;
  return runs.place_of(up, static_cast<std::size_t>(std::max(where.run, 0)),
                       static_cast<std::size_t>(std::max(where.target, 0)));
}

}  // namespace

// Beyond the targets the value of the end is used. Nearly all of the travel beyond them means a
// wrong unit.
void check_targets(const RunsFile& runs, const AxisFile& axis, std::vector<std::string>& warnings) {
  constexpr double kBeyond = 0.01;
  constexpr double kAll = 0.95;
  constexpr double kUnitSuspected = 0.05;
  const auto [low, high] = std::minmax_element(runs.positions.begin(), runs.positions.end());
  const double travel = axis.hi - axis.lo;
  const double covered = (*high - *low) / travel;
  const std::string found = fmt::format(
      "{}: targets of {} from {:g} to {:g}, but it travels from {:g} to {:g} {}", runs.name,
      axis.letter, *low, *high, axis.lo, axis.hi, axis.rotary ? "rad" : "mm");
  const bool outside = *low < axis.lo - kBeyond * travel || *high > axis.hi + kBeyond * travel;
  if (outside || covered < kUnitSuspected)
    throw UserError(fmt::format("{} [{}]", found, code(Reason::unit_suspected)));
  if (covered < kAll) warnings.push_back(found + ": beyond them the value of the end is used");
}

void note_warnings(const RunsFile& runs, const AxisFile& axis, const BuiltTable& built,
                   std::vector<std::string>& out) {
  for (std::size_t i = 0; i < built.warning_count; ++i) {
    const Warning warning = built.warning[i];
    out.push_back(fmt::format("{} [{}]", warning_words(warning, runs, axis, built), code(warning)));
  }
}

// The place of the travel farthest from the reference, and what the line is worth there.
void note_slopes(const RunsFile& runs, const AxisFile& axis, const BuiltTable& built,
                 std::vector<std::string>& out) {
  const double end = axis.reference - axis.lo > axis.hi - axis.reference ? axis.lo : axis.hi;
  for (std::size_t c = 0; c < built.removed_slope.size(); ++c) {
    const double slope = built.removed_slope[c];
    const double there_mm = slope * (end - axis.reference);
    if (std::abs(there_mm) < kSlopeToSay_mm) continue;
    out.push_back(fmt::format(
        "{}: a slope of {:.1f} urad was removed from {}, which is {:.1f} um at {:g} mm: it is "
        "corrected only as far as squareness stands in the machine file",
        runs.name, 1e6 * slope, channel_name(static_cast<int>(c), axis.letter), 1e3 * there_mm,
        end));
  }
}

void require_runs(const Status& status, const RunsFile& runs) {
  if (!status.ok()) require(status, place_of(status.where, runs));
}

}  // namespace volcomp::host
