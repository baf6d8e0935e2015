#include "host_sim/host/tables/lever_check.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kSameTarget_mm = 1e-3;

// Means over all runs, by position.
std::map<double, ErrorMotion> means(const RunsFile& runs) {
  std::map<double, ErrorMotion> mean;
  const auto n = static_cast<double>(runs.up.size() + runs.down.size());
  for (const auto* const list : {&runs.up, &runs.down}) {
    for (const RunValues& run : *list) {
      for (std::size_t t = 0; t < run.size(); ++t) {
        if (!run[t].allFinite())
          throw UserError(fmt::format("{}: a reading at target {} is not finite [{}]", runs.name,
                                      runs.positions[t], code(Reason::not_finite)));
        mean.try_emplace(runs.positions[t], ErrorMotion(ErrorMotion::Zero())).first->second +=
            run[t] / n;
      }
    }
  }
  return mean;
}

std::vector<ErrorMotion> values_of(const std::map<double, ErrorMotion>& means) {
  std::vector<ErrorMotion> values;
  values.reserve(means.size());
  for (const auto& [position, value] : means)
    values.push_back(value);
  return values;
}

void check_targets(const RunsFile& first, const RunsFile& second,
                   const std::map<double, ErrorMotion>& a, const std::map<double, ErrorMotion>& b) {
  bool same = a.size() == b.size();
  for (auto i = a.begin(), j = b.begin(); same && i != a.end(); ++i, ++j)
    same = std::abs(i->first - j->first) < kSameTarget_mm;
  if (!same)
    throw UserError(
        fmt::format("{} and {}: the targets are not the same", first.name, second.name));
}

bool near(double value, double wanted) { return std::abs(value - wanted) < 0.1 * wanted; }

// The classical mistakes by the ratio they leave.
std::string hint(double found, double expected, double other_expected) {
  constexpr double kUradPerArcsec = kPi / 648000.0 * 1e6;
  if (std::abs(expected) > 0.0) {
    const double ratio = found / expected;
    if (near(-ratio, 1.0)) return "as if a sign were the other way round";
    if (near(std::abs(ratio), kUradPerArcsec)) return "as if arc seconds were called urad";
    if (near(std::abs(ratio), 1.0 / kUradPerArcsec)) return "as if urad were called arc seconds";
    if (near(std::abs(ratio), 1e3)) return "as if mrad were called urad";
    if (near(std::abs(ratio), 1e-3)) return "as if urad were called mrad";
  }
  if (std::abs(other_expected) > 0.0 && near(std::abs(found / other_expected), 1.0))
    return "as if the two angles were exchanged";
  return "";
}

}  // namespace

LeverVerdict check_lever(const MachineFile& machine, const RunsFile& first, const RunsFile& second,
                         const Vec3& second_point) {
  if (first.letter != second.letter)
    throw UserError(fmt::format("{} is of axis {}, {} of axis {}", first.name, first.letter,
                                second.name, second.letter));
  const std::size_t axis = machine.axis_index(first.letter);
  const Joint& joint = machine.chain.axis(axis);
  if (joint.kind != JointKind::prismatic)
    throw UserError(fmt::format("{}: axis {} is not linear", first.name, first.letter));
  const auto a = means(first);
  const auto b = means(second);
  check_targets(first, second, a, b);

  LeverVerdict out;
  out.axis = first.letter;
  out.targets = a.size();
  out.first_point = machine.axes[axis].sensed.at_zero;
  out.second_point = second_point;
  const std::vector<ErrorMotion> at_first = values_of(a);
  const std::vector<ErrorMotion> at_second = values_of(b);
  LeverTest test;
  const Status status =
      lever_self_test(joint.axis, {at_first.data(), at_first.size()},
                      {at_second.data(), at_second.size()}, out.first_point, second_point, test);
  if (status.reason != Reason::lever_mismatch)
    require(status, fmt::format("{} and {}", first.name, second.name));
  for (std::size_t k = 0; k < out.angle.size(); ++k) {
    LeverAngle& angle = out.angle[k];
    angle.channel = fmt::format("E{}{}", "ABC"[(index(joint.axis) + 1 + k) % 3], first.letter);
    angle.expected_mm = test.expected[k];
    angle.found_mm = test.found[k];
    angle.allowed_mm = test.allowed[k];
    angle.good = std::abs(angle.found_mm - angle.expected_mm) <= angle.allowed_mm;
    if (!angle.good) angle.hint = hint(test.found[k], test.expected[k], test.expected[1 - k]);
  }
  return out;
}

}  // namespace volcomp::host
