#include "host_sim/host/tables/formats/foreign_errors.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/chain_string.hpp"

namespace volcomp::host {
namespace {

constexpr std::string_view kLetters = "XYZABC";

std::string channel_name(std::size_t channel, char axis) {
  return fmt::format("E{}{}", kLetters[channel], axis);
}

bool same_positions(const ForeignCurve& a, const ForeignCurve& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ForeignPoint& p, const ForeignPoint& q) {
                      return std::abs(p.at - q.at) < kNearestTargets;
                    });
}

// The first channel that is there; there is one.
std::size_t first_channel(const std::array<ForeignCurve, 6>& curves) {
  return static_cast<std::size_t>(
      std::find_if(curves.begin(), curves.end(), [](const auto& c) { return !c.empty(); }) -
      curves.begin());
}

void check_channels(char axis, const std::array<ForeignCurve, 6>& curves, const std::string& name,
                    const ImportRules& rules) {
  const std::size_t first = first_channel(curves);
  std::string absent;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].empty()) {
      absent += (absent.empty() ? "" : ", ") + channel_name(c, axis);
    } else if (!same_positions(curves[first], curves[c])) {
      throw UserError(fmt::format("{}: {} and {} are not at the same positions", name,
                                  channel_name(first, axis), channel_name(c, axis)));
    }
  }
  if (!absent.empty() && !rules.absent_zero)
    throw UserError(
        fmt::format("{}: axis {} lacks {}; --absent zero writes them as 0", name, axis, absent));
  if (curves[first].size() < 2)
    throw UserError(fmt::format("{}: axis {} has one position, a table needs two", name, axis));
}

}  // namespace

bool fits_run_file(double value) { return std::abs(value) <= kLargestInRuns; }

bool read_error_name(std::string_view text, ErrorName& out) {
  const bool short_location = text.size() == 3 && text[1] == '0';
  const bool long_location = text.size() == 4 && text[0] == 'E' && text[2] == '0';
  if (!short_location && (text.size() < 3 || text[0] != 'E')) return false;
  if (text.size() > 3 && !long_location) return false;
  const std::size_t channel = kLetters.find(short_location ? text[0] : text[1]);
  const char axis = text.back();
  if (channel == std::string_view::npos || kLetters.find(axis) == std::string_view::npos)
    return false;
  out = {channel, axis, short_location || long_location};
  return true;
}

void add_point(ForeignErrors& errors, const ErrorName& name, double at, double value,
               const CsvLines& lines) {
  if (!std::isfinite(at) || !std::isfinite(value)) lines.fail("a number must be finite");
  const double position = is_rotary_letter(name.axis) ? at * kPi / 180.0 : at;
  if (!fits_run_file(position)) lines.fail("the position is out of range");
  if (!fits_run_file(value)) lines.fail("the error is out of range");
  ForeignCurve& curve = errors.axis[name.axis][name.channel];
  const bool twice = std::any_of(curve.begin(), curve.end(), [&](const ForeignPoint& p) {
    return std::abs(p.at - position) < kNearestTargets;
  });
  if (twice)
    lines.fail(fmt::format("{} has position {} twice", channel_name(name.channel, name.axis), at));
  if (curve.size() == kTableKnots)
    lines.fail(
        fmt::format("more than {} positions [{}]", kTableKnots, code(Reason::too_many_knots)));
  curve.push_back({position, value});
}

void add_location(ForeignErrors& errors, std::string_view name, double value,
                  const CsvLines& lines) {
  if (!std::isfinite(value)) lines.fail("a number must be finite");
  for (const LocationError& other : errors.location) {
    if (other.name == name) lines.fail(fmt::format("{} is there twice", name));
  }
  ErrorName parts;
  const bool angle = read_error_name(name, parts) && parts.channel >= 3;
  errors.location.push_back({std::string(name), value, angle});
}

std::vector<RunsFile> to_runs(const ForeignErrors& errors, const std::string& name,
                              const ImportRules& rules) {
  std::vector<RunsFile> files;
  for (const auto& [axis, curves] : errors.axis) {
    check_channels(axis, curves, name, rules);
    RunsFile file;
    file.name = name;
    file.letter = axis;
    const ForeignCurve& first = curves[first_channel(curves)];
    RunValues run(first.size(), ErrorMotion(ErrorMotion::Zero()));
    for (std::size_t k = 0; k < first.size(); ++k) {
      file.positions.push_back(first[k].at);
      for (std::size_t c = 0; c < curves.size(); ++c) {
        if (!curves[c].empty())
          run[k](static_cast<Eigen::Index>(c)) = rules.sign * curves[c][k].value;
      }
    }
    file.up.push_back(run);
    files.push_back(file);
  }
  if (files.empty())
    throw UserError(fmt::format("{}: there is no error function of an axis in it", name));
  return files;
}

std::string locations_csv(const ForeignErrors& errors, const ImportRules& rules) {
  if (errors.location.empty()) return "";
  std::string text = "name,value,unit\n";
  for (const LocationError& l : errors.location)
    text += fmt::format("{},{},{}\n", l.name, rules.sign * l.value, l.angle ? "rad" : "mm");
  return text;
}

}  // namespace volcomp::host
