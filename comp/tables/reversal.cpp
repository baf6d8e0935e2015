#include "comp/tables/reversal.hpp"

#include <algorithm>

#include "comp/core/to_double.hpp"

namespace volcomp {
namespace {

constexpr float kLargest_nm = 4'194'303.0F;  // a hysteresis that configure() accepts
constexpr float kRounding_nm = 2.0F;         // of the offset in either direction

struct Range {
  float low = 0.0F;
  float high = 0.0F;

  void include(float value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Range& other, float factor) {
    const float a = factor * other.low;
    const float b = factor * other.high;
    low += std::min(a, b);
    high += std::max(a, b);
  }
};

// Along each axis of base, nm: on what an angle may act, which is the travel of all axes
// (kernel::folded_error), or of some of them.
using Levers = std::array<Range, 3>;

Levers levers_of(const TablesView& tables, const RuntimeChain& chain) {
  Levers levers{};
  for (std::size_t i = 0; i < chain.steps; ++i) {
    const RuntimeStep& step = chain.step[i];
    if (step.kind == JointKind::fixed) continue;
    const TableGrid& grid = tables.axis[step.nc_axis].grid();
    for (const std::int64_t end : {grid.q0, grid.last()}) {
      const float lever = static_cast<float>(to_double(end)) * step.sense;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool any = chain.has_orientation;  // joints are rotated against base
        if (any || k == index(step.axis)) levers[k].include(lever);
        if (any) levers[k].include(-lever);
      }
    }
  }
  return levers;
}

// What the tool point does in base when an axis turns from forward to backward at a knot.
void moved_by(const std::array<Knot, 2>& knot, const Levers& levers, std::array<Range, 3>& moved) {
  const auto turned = [&](std::size_t channel) { return knot[1].v[channel] - knot[0].v[channel]; };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    moved[k] = {turned(k), turned(k)};
    moved[k].add(levers[last], turned(3 + next));
    moved[k].add(levers[next], -turned(3 + last));
  }
}

// The way of the offset with this `row` of J⁻¹ when the axis of `rows` turns. Its own axis: only
// what is against the motion, which is backward.
float way(const std::array<Knot, 2>* rows, std::size_t knots, const Levers& levers,
          const Float3& row, bool own) {
  Range all;
  std::array<Range, 3> moved;
  for (std::size_t i = 0; i < knots; ++i) {
    Range offset;
    moved_by(rows[i], levers, moved);
    for (std::size_t k = 0; k < 3; ++k)
      offset.add(moved[k], -row[k]);
    all.include(offset.low);
    all.include(offset.high);
  }
  return own ? all.high : std::max(all.high, -all.low);
}

}  // namespace

void measure_reversals(const TablesView& tables, const RuntimeChain& chain, const TableSetView& set,
                       FoldReport& report) {
  report.reversal_nm = {};
  if (!directions_follow_offsets(chain)) return;
  const Levers levers = levers_of(tables, chain);
  for (std::size_t c = 0; c < chain.correcting_count; ++c) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < chain.correcting_count; ++k) {
      const std::size_t axis = chain.correcting[k];
      sum += way(set.rows[axis], tables.axis[axis].grid().knots, levers, set.inverse[c], k == c);
    }
    if (sum > 0.0F) sum += kRounding_nm;
    report.reversal_nm[chain.correcting[c]] = static_cast<std::int32_t>(std::min(sum, kLargest_nm));
  }
}

}  // namespace volcomp
