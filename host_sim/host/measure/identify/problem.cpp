#include "host_sim/host/measure/identify/problem.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::host::identify {

std::size_t SetUp::components() const {
  switch (kind) {
    case ObservationKind::centre:
    case ObservationKind::rtest:
      return 3;
    case ObservationKind::runs:
      return channels.size();
    default:
      return 1;
  }
}

bool Problem::same_turn(const Pose& a, const Pose& b) const {
  constexpr double kSame_rad = 1e-7;
  for (std::size_t axis = 0; axis < machine.chain.axis_count(); ++axis)
    if (!is_slide(axis) && std::abs(a.at(axis) - b.at(axis)) > kSame_rad) return false;
  return true;
}

std::optional<std::size_t> Problem::reference() const {
  for (std::size_t s = 0; s < styli.size(); ++s)
    if (!styli[s].place) return s;
  return std::nullopt;
}

std::optional<std::size_t> Problem::stylus_of(const SetUp& s, std::size_t i) const {
  return s.stylus.empty() ? reference() : s.stylus[i];
}

Vec3 Problem::tip_of(const SetUp& s, std::size_t i) const {
  const auto stylus = stylus_of(s, i);
  return stylus ? styli[*stylus].offset : machine.chain.tool_point();
}

std::optional<Range> Problem::range_of(std::size_t axis) const {
  std::optional<Range> range;
  for (const SetUp& s : setups) {
    if (s.kind == ObservationKind::runs && s.axis != axis) continue;
    for (const Pose& q : s.q) {
      if (!range) range = Range{q.at(axis), q.at(axis)};
      range->lo = std::min(range->lo, q.at(axis));
      range->hi = std::max(range->hi, q.at(axis));
    }
  }
  return range;
}

void ask_for_locations(Problem& problem) {
  const MachineChain& chain = problem.machine.chain;
  bool work_turns = false;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    work_turns = work_turns || (!problem.is_slide(a) && chain.axis(a).branch == Branch::work);
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    if (problem.is_slide(a)) continue;
    const Joint& joint = chain.axis(a);
    Channels places;
    Channels tilts;
    for (std::size_t c = 0; c < 3; ++c) {
      if (c == index(joint.axis)) continue;
      places.push_back(c);
      tilts.push_back(c + 3);
    }
    const bool with_tool_alone = joint.branch == Branch::tool && !work_turns;
    Channels& location = problem.model.location.at(a);
    location = with_tool_alone ? Channels{} : places;
    location.insert(location.end(), tilts.begin(), tilts.end());
    if (with_tool_alone) problem.model.constant.at(a) = places;
  }
}

std::array<Vec3, 2> across(const Vec3& n) {
  Eigen::Index least = 0;
  for (Eigen::Index k = 1; k < 3; ++k)
    if (std::abs(n(k)) < std::abs(n(least))) least = k;
  const Vec3 first = Vec3::Unit(least).cross(n).normalized();
  return {first, n.cross(first)};
}

std::vector<std::size_t> sloped_channels(const Problem& problem, const SetUp& s) {
  std::vector<std::size_t> sloped;
  if (!s.slopes || !problem.is_slide(s.axis)) return sloped;
  const std::size_t own = index(problem.machine.chain.axis(s.axis).axis);
  for (std::size_t k = 0; k < s.channels.size(); ++k)
    if (s.channels[k] < 3 && s.channels[k] != own) sloped.push_back(k);
  return sloped;
}

std::size_t local_count(const Problem& problem, const SetUp& s) {
  switch (s.kind) {
    case ObservationKind::tracer:
      return 4;
    case ObservationKind::bar:
    case ObservationKind::step:
    case ObservationKind::rtest:
      return 3;
    case ObservationKind::diagonal:
      return 1;
    case ObservationKind::centre:
    case ObservationKind::touch:
      return 6;
    case ObservationKind::runs:
      break;
  }
  return s.channels.size() + sloped_channels(problem, s).size();
}

}  // namespace volcomp::host::identify
