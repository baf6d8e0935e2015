#pragma once
// What is known beforehand of the Jacobian of the correcting axes, and which of its columns the
// walk has to carry.

#include <array>
#include <cstdint>

#include "comp/tables/runtime_chain.hpp"

namespace volcomp::detail {

// What lies between the motion of step `i` and base.
struct WayToBase {
  bool turns = false;  // a rotary axis, the step's own included
  bool askew = false;  // a joint that is rotated
};

constexpr WayToBase way_to_base(const RuntimeChain& chain, std::size_t i) {
  const bool work = chain.step[i].work;
  const std::size_t from = work ? chain.tool_steps : i;
  const std::size_t to = work ? i + 1U : chain.tool_steps;
  WayToBase way;
  for (std::size_t k = from; k < to; ++k) {
    way.turns = way.turns || chain.step[k].kind == JointKind::rotary;
    way.askew = way.askew || chain.step[k].has_orientation;
  }
  return way;
}

constexpr InversePlan plan_inverse(const RuntimeChain& chain) {
  InversePlan plan;
  for (std::size_t c = 0; c < chain.correcting_count; ++c)
    plan.units[c] = chain.kind[chain.correcting[c]] == JointKind::rotary ? kTurnsPerRad : 1.0F;
  std::array<bool, 3> taken{};
  std::size_t met = 0;
  std::size_t varying = 0;
  bool turned = false;
  bool distinct = true;
  for (std::size_t i = 0; i < chain.steps; ++i) {
    const RuntimeStep& step = chain.step[i];
    if (!step.corrects()) continue;
    ++met;
    const WayToBase way = way_to_base(chain, i);
    turned = turned || way.turns;
    if (way.turns || way.askew) {
      plan.varying = step.correcting;
      ++varying;
      continue;
    }
    distinct = distinct && !taken[index(step.axis)];
    taken[index(step.axis)] = true;
    plan.component[step.correcting] = static_cast<std::uint8_t>(step.axis);
    plan.gain[step.correcting] = step.sense;
  }
  plan.varying_component = static_cast<std::uint8_t>(!taken[0] ? 0 : !taken[1] ? 1 : 2);
  const bool three = met == kMaxCorrecting && distinct;
  if (three && varying == 1) plan.form = InverseForm::one_varying;
  if (chain.folded || (met != 0 && met == chain.correcting_count && !turned))
    plan.form = InverseForm::constant;
  if (three && varying == 0) plan.form = InverseForm::aligned;
  return plan;
}

// Numbers the columns the walk has to carry, each branch from its tip towards base.
constexpr void number_columns(RuntimeChain& chain) {
  std::uint8_t next = 0;
  for (std::uint8_t& column : chain.inverse.column)
    column = kNotCarried;
  const auto visit = [&](RuntimeStep& step, std::uint8_t first) {
    step.columns_before = static_cast<std::uint8_t>(next - first);
    const bool turns_columns = step.kind == JointKind::rotary && step.columns_before != 0;
    step.plain = !step.has_orientation && !turns_columns;
    const bool carried = step.corrects() && (chain.inverse.form == InverseForm::general ||
                                             (chain.inverse.form == InverseForm::one_varying &&
                                              step.correcting == chain.inverse.varying));
    if (!carried) return;
    chain.inverse.column[step.correcting] = next;
    step.column = next++;
    step.plain = false;
  };
  for (std::size_t i = 0; i < chain.tool_steps; ++i)
    visit(chain.step[i], 0);
  chain.tool_columns = next;
  for (std::size_t i = chain.steps; i > chain.tool_steps; --i)
    visit(chain.step[i - 1U], chain.tool_columns);
  for (std::size_t c = 0; c < chain.correcting_count; ++c) {
    if (chain.inverse.column[c] == kNotCarried && chain.inverse.form == InverseForm::general)
      chain.inverse.column[c] = next++;  // an axis the walk does not meet: its column stays 0
  }
}

}  // namespace volcomp::detail
