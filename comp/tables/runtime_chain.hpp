#pragma once
// The machine as the tick walks it: tool tip → base, then base → work tip, in float nm. Built from
// the same MachineDescription whether the machine is compiled in (constexpr, the walk unrolls) or
// loaded from an image.

#include <array>
#include <cstdint>

#include "comp/machine/body_paths.hpp"

namespace volcomp {

inline constexpr std::uint8_t kNotCorrecting = 0xFF;
inline constexpr std::uint8_t kNotCarried = 0xFF;
inline constexpr std::uint8_t kNotOrienting = 0xFF;

// What a joint does to a point: one jump of a loaded machine.
enum class Motion : std::uint8_t { along_x, along_y, along_z, about_x, about_y, about_z, none };

struct RuntimeStep {
  JointKind kind = JointKind::fixed;
  Axis axis = Axis::x;
  Motion motion = Motion::none;
  bool work = false;
  bool plain = false;  // no orientation, and no column to carry or to turn
  bool has_offset = false;
  bool has_orientation = false;
  bool has_error = false;  // fixed body with a constant error
  std::uint8_t body = 0;
  std::uint8_t nc_axis = 0;
  std::uint8_t correcting = kNotCorrecting;  // index among the correcting axes
  std::uint8_t orienting = kNotOrienting;    // of a rotary axis: index among the orienting axes
  std::uint8_t column = kNotCarried;         // where the walk carries its Jacobian column
  std::uint8_t columns_before = 0;           // carried ones of its branch nearer to the tip
  float sign = 1.0F;                         // of the NC coordinate
  float sense = 1.0F;  // of the motion as the walk meets it: −sign towards the work tip
  std::array<float, 3> offset_nm{};
  std::array<float, 9> orientation{};
  std::array<float, 6> error{};  // nm, rad

  [[nodiscard]] constexpr bool corrects() const { return correcting != kNotCorrecting; }
  [[nodiscard]] constexpr bool carried() const { return column != kNotCarried; }
};

inline constexpr float kTurnsPerRad = 683565275.6F;  // 2^32 / 2π, an output in a radian

// What is known beforehand of the Jacobian of the correcting axes, and saves the tick work.
enum class InverseForm : std::uint8_t {
  aligned,      // three linear axes that always lie along X, Y, Z: a signed selection
  constant,     // linear axes, none of them turned: J⁻¹ comes with the tables
  one_varying,  // two aligned axes and one whose column changes with the pose
  general,
};

struct InversePlan {
  InverseForm form = InverseForm::general;
  std::array<std::uint8_t, kMaxCorrecting> component{};  // of the aligned ones
  std::array<float, kMaxCorrecting> gain{};
  std::array<float, kMaxCorrecting> units{};          // output units per nm or rad of each
  std::array<std::uint8_t, kMaxCorrecting> column{};  // where the walk carries the others
  std::uint8_t varying = 0;                           // the one of one_varying
  std::uint8_t varying_component = 0;                 // what the aligned ones leave to it
};

enum class RuntimeModel : std::uint8_t {
  automatic,     // folded for linear axes only, recursion as soon as one is rotary (conventions,
                 // section 4)
  folded,        // first-order sum, levers folded into the tables
  second_order,  // deviation recursion
};

struct RuntimeChain {
  std::array<RuntimeStep, kMaxBodies> step{};
  std::uint8_t steps = 0;
  std::uint8_t tool_steps = 0;
  std::uint8_t axes = 0;
  std::uint8_t correcting_count = 0;
  std::uint8_t orienting_count = 0;
  std::array<std::uint8_t, kMaxOrienting> orienting{};    // NC axes
  std::array<std::uint8_t, kMaxCorrecting> correcting{};  // NC axes
  std::array<std::uint8_t, kMaxAxes> correcting_index{};  // by NC axis, or kNotCorrecting
  std::array<JointKind, kMaxAxes> kind{};                 // by NC axis
  std::array<char, kMaxAxes> letter{};
  std::uint8_t first_folded = 0;  // step of the first axis met from the work tip
  bool folded = true;
  bool has_orientation = false;
  bool has_constant_error = false;
  std::uint8_t tool_columns = 0;  // carried along the tool branch; those of the work branch follow
  InversePlan inverse{};

  [[nodiscard]] constexpr std::uint8_t orienting_index(std::size_t axis) const {
    for (std::uint8_t o = 0; o < orienting_count; ++o) {
      if (orienting[o] == axis) return o;
    }
    return kNotOrienting;
  }
};

// Whether the directions of the correcting axes are those of their positions with the offset: on
// machines of linear axes. What reversals do to an offset has a useful bound there, and a
// hysteresis above it keeps a direction from chasing itself. Elsewhere a direction is that of the
// position alone.
[[nodiscard]] constexpr bool directions_follow_offsets(const RuntimeChain& chain) {
  return chain.folded && chain.orienting_count == 0;
}

namespace detail {

constexpr Motion motion_of(const Joint& joint) {
  if (!joint.moves()) return Motion::none;
  const bool turns = joint.kind == JointKind::rotary;
  const Motion first = turns ? Motion::about_x : Motion::along_x;
  return static_cast<Motion>(static_cast<std::size_t>(first) + index(joint.axis));
}

constexpr RuntimeStep runtime_step(const Body& body, std::uint8_t index, bool work) {
  RuntimeStep step;
  step.kind = body.joint.kind;
  step.axis = body.joint.axis;
  step.motion = motion_of(body.joint);
  step.work = work;
  step.body = index;
  step.nc_axis = body.joint.moves() ? body.joint.nc_axis : std::uint8_t{0};  // fixed: unused
  step.sign = static_cast<float>(body.joint.sign);
  step.sense = work ? -step.sign : step.sign;
  for (std::size_t i = 0; i < 3; ++i) {
    step.offset_nm[i] = static_cast<float>(body.joint.offset[i] * 1e6);
    step.has_offset = step.has_offset || body.joint.offset[i] < 0.0 || body.joint.offset[i] > 0.0;
  }
  for (std::size_t i = 0; i < 9; ++i) {
    const double unit = i % 4 == 0 ? 1.0 : 0.0;
    const double entry = body.joint.orientation[i];
    step.orientation[i] = static_cast<float>(entry);
    step.has_orientation = step.has_orientation || entry < unit || entry > unit;
  }
  for (std::size_t i = 0; i < 6 && !body.joint.moves(); ++i) {
    step.error[i] = static_cast<float>(body.constant_error[i] * (i < 3 ? 1e6 : 1.0));
    step.has_error = step.has_error || body.constant_error[i] < 0.0 || body.constant_error[i] > 0.0;
  }
  return step;
}

// The column of the correcting axis at step `i` is a unit vector of base, whatever the pose: a
// linear axis, and between it and base nothing turns and nothing is rotated.
constexpr bool is_aligned(const RuntimeChain& chain, std::size_t i) {
  const bool work = chain.step[i].work;
  const std::size_t from = work ? chain.tool_steps : i;
  const std::size_t to = work ? i + 1U : chain.tool_steps;
  for (std::size_t k = from; k < to; ++k) {
    if (chain.step[k].kind == JointKind::rotary || chain.step[k].has_orientation) return false;
  }
  return true;
}

constexpr InversePlan plan_inverse(const RuntimeChain& chain) {
  InversePlan plan;
  for (std::size_t c = 0; c < chain.correcting_count; ++c)
    plan.units[c] = chain.kind[chain.correcting[c]] == JointKind::rotary ? kTurnsPerRad : 1.0F;
  if (chain.folded) plan.form = InverseForm::constant;
  if (chain.correcting_count != kMaxCorrecting || (chain.folded && chain.has_orientation))
    return plan;
  std::array<bool, 3> taken{};
  std::size_t aligned = 0;
  std::size_t varying = 0;
  for (std::size_t i = 0; i < chain.steps; ++i) {
    const RuntimeStep& step = chain.step[i];
    if (!step.corrects()) continue;
    if (!is_aligned(chain, i)) {
      plan.varying = step.correcting;
      ++varying;
      continue;
    }
    if (taken[index(step.axis)]) return plan;
    taken[index(step.axis)] = true;
    ++aligned;
    plan.component[step.correcting] = static_cast<std::uint8_t>(step.axis);
    plan.gain[step.correcting] = step.sense;
  }
  const bool all_met = aligned + varying == kMaxCorrecting;
  if (all_met && varying == 0) plan.form = InverseForm::aligned;
  if (all_met && varying == 1) plan.form = InverseForm::one_varying;
  plan.varying_component = static_cast<std::uint8_t>(!taken[0] ? 0 : !taken[1] ? 1 : 2);
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

}  // namespace detail

// Expects a description that MachineChain::build accepts. `folded` is ignored when an axis is
// rotary: the sum is defined for linear axes only.
constexpr RuntimeChain make_runtime_chain(const MachineDescription& machine,
                                          RuntimeModel model = RuntimeModel::automatic) {
  RuntimeChain chain;
  const BranchPaths paths = branch_paths(machine);
  for (std::size_t i = paths.tool.count; i > 0; --i) {
    const std::uint8_t body = paths.tool.body[i - 1];
    chain.step[chain.steps++] = detail::runtime_step(machine.body[body], body, false);
  }
  chain.tool_steps = chain.steps;
  for (std::size_t i = 0; i < paths.work.count; ++i) {
    const std::uint8_t body = paths.work.body[i];
    chain.step[chain.steps++] = detail::runtime_step(machine.body[body], body, true);
  }
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    chain.kind[joint.nc_axis] = joint.kind;
    chain.letter[joint.nc_axis] = joint.letter;
    ++chain.axes;
  }
  chain.correcting_count = machine.correcting_count;
  for (std::uint8_t& c : chain.correcting_index)
    c = kNotCorrecting;
  for (std::uint8_t c = 0; c < machine.correcting_count; ++c) {  // what lies behind means nothing
    chain.correcting[c] = machine.correcting[c];
    chain.correcting_index[machine.correcting[c]] = c;
  }
  chain.orienting_count = machine.orienting_count;
  chain.orienting = machine.orienting;
  bool any_rotary = false;
  for (std::size_t i = 0; i < chain.steps; ++i) {
    RuntimeStep& step = chain.step[i];
    if (step.kind != JointKind::fixed) {
      step.correcting = chain.correcting_index[step.nc_axis];
      if (step.kind == JointKind::rotary) step.orienting = chain.orienting_index(step.nc_axis);
      chain.first_folded = static_cast<std::uint8_t>(i);
    }
    any_rotary = any_rotary || step.kind == JointKind::rotary;
    chain.has_orientation = chain.has_orientation || step.has_orientation;
    chain.has_constant_error = chain.has_constant_error || step.has_error;
  }
  chain.folded = !any_rotary && model != RuntimeModel::second_order;
  chain.inverse = detail::plan_inverse(chain);
  detail::number_columns(chain);
  return chain;
}

// True when tables made for `b` may run on `a`: same walk, same geometry. Called when tables are
// taken over, not by the tick; a copy of it in every caller costs flash.
[[gnu::noinline]] constexpr bool same_chain(const RuntimeChain& a, const RuntimeChain& b) {
  const auto differ = [](float x, float y) { return x < y || x > y; };
  if (a.steps != b.steps || a.tool_steps != b.tool_steps || a.axes != b.axes ||
      a.correcting_count != b.correcting_count || a.orienting_count != b.orienting_count ||
      a.orienting[0] != b.orienting[0] || a.orienting[1] != b.orienting[1]) {
    return false;
  }
  for (std::size_t i = 0; i < a.steps; ++i) {
    const RuntimeStep& x = a.step[i];
    const RuntimeStep& y = b.step[i];
    if (x.kind != y.kind || x.axis != y.axis || x.work != y.work || x.nc_axis != y.nc_axis)
      return false;
    if (x.correcting != y.correcting || differ(x.sign, y.sign)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (differ(x.offset_nm[k], y.offset_nm[k])) return false;
    }
    for (std::size_t k = 0; k < 9; ++k) {
      if (differ(x.orientation[k], y.orientation[k])) return false;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      if (differ(x.error[k], y.error[k])) return false;
    }
  }
  return true;
}

// A machine known at compile time: every loop over the chain unrolls and every branch on it
// disappears.
template <const MachineDescription& Description, RuntimeModel Model = RuntimeModel::automatic>
struct CompiledMachine {
  static constexpr RuntimeChain chain = make_runtime_chain(Description, Model);
  static constexpr std::size_t kAxes = chain.axes;
  static constexpr std::size_t kOrienting = chain.orienting_count;
  static constexpr bool kCompiledIn = true;
};

// A machine read from a validated image; `Axes` bounds the memory. `Orienting`: how many axes may
// orient the tool, 0 or kMaxOrienting; 0 costs nothing.
template <std::size_t Axes, std::size_t Orienting = 0>
struct LoadedMachine {
  RuntimeChain chain{};
  static constexpr std::size_t kAxes = Axes;
  static constexpr std::size_t kOrienting = Orienting;
  static constexpr bool kCompiledIn = false;
};

}  // namespace volcomp
