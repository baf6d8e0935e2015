#pragma once
// The machine as the tick walks it: tool tip → base, then base → work tip, in float nm. Built from
// the same MachineDescription whether the machine is compiled in (constexpr, the walk unrolls) or
// loaded from an image.

#include <array>
#include <cstdint>

#include "comp/geometry/body_paths.hpp"

namespace volcomp {

inline constexpr std::uint8_t kNotCorrecting = 0xFF;

struct RuntimeStep {
  JointKind kind = JointKind::fixed;
  Axis axis = Axis::x;
  bool work = false;
  bool has_offset = false;
  bool has_orientation = false;
  bool has_error = false;  // fixed body with a constant error
  std::uint8_t body = 0;
  std::uint8_t nc_axis = 0;
  std::uint8_t correcting = kNotCorrecting;  // index among the correcting axes
  float sign = 1.0F;
  std::array<float, 3> offset_nm{};
  std::array<float, 9> orientation{};
  std::array<float, 6> error{};  // nm, rad

  [[nodiscard]] constexpr bool corrects() const { return correcting != kNotCorrecting; }
};

// When the Jacobian is a signed permutation (three linear correcting axes along X, Y, Z), the
// inverse costs nothing.
struct AlignedInverse {
  bool valid = false;
  std::array<std::uint8_t, kMaxCorrecting> component{};
  std::array<float, kMaxCorrecting> gain{};
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
  std::array<std::uint8_t, kMaxCorrecting> correcting{};  // NC axes
  std::array<JointKind, kMaxAxes> kind{};                 // by NC axis
  std::array<char, kMaxAxes> letter{};
  std::uint8_t first_folded = 0;  // step of the first axis met from the work tip
  bool folded = true;
  bool has_orientation = false;
  bool has_constant_error = false;
  AlignedInverse inverse{};
};

namespace detail {

constexpr RuntimeStep runtime_step(const Body& body, std::uint8_t index, bool work) {
  RuntimeStep step;
  step.kind = body.joint.kind;
  step.axis = body.joint.axis;
  step.work = work;
  step.body = index;
  step.nc_axis = body.joint.moves() ? body.joint.nc_axis : std::uint8_t{0};  // fixed: unused
  step.sign = static_cast<float>(body.joint.sign);
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

constexpr AlignedInverse aligned_inverse(const RuntimeChain& chain) {
  AlignedInverse inverse;
  std::array<bool, 3> taken{};
  if (chain.has_orientation || chain.correcting_count != 3) return inverse;
  for (std::size_t i = 0; i < chain.steps; ++i) {
    const RuntimeStep& step = chain.step[i];
    if (step.kind == JointKind::rotary) return inverse;
    if (!step.corrects()) continue;
    const std::size_t c = step.correcting;
    if (taken[index(step.axis)]) return inverse;
    taken[index(step.axis)] = true;
    inverse.component[c] = static_cast<std::uint8_t>(step.axis);
    inverse.gain[c] = (step.work ? -1.0F : 1.0F) * step.sign;
  }
  inverse.valid = taken[0] && taken[1] && taken[2];
  return inverse;
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
  chain.correcting = machine.correcting;
  bool any_rotary = false;
  for (std::size_t i = 0; i < chain.steps; ++i) {
    RuntimeStep& step = chain.step[i];
    for (std::size_t c = 0; c < machine.correcting_count; ++c) {
      if (step.kind != JointKind::fixed && step.nc_axis == machine.correcting[c]) {
        step.correcting = static_cast<std::uint8_t>(c);
      }
    }
    if (step.kind != JointKind::fixed) chain.first_folded = static_cast<std::uint8_t>(i);
    any_rotary = any_rotary || step.kind == JointKind::rotary;
    chain.has_orientation = chain.has_orientation || step.has_orientation;
    chain.has_constant_error = chain.has_constant_error || step.has_error;
  }
  chain.folded = !any_rotary && model != RuntimeModel::second_order;
  chain.inverse = detail::aligned_inverse(chain);
  return chain;
}

// True when tables made for `b` may run on `a`: same walk, same geometry.
constexpr bool same_chain(const RuntimeChain& a, const RuntimeChain& b) {
  const auto differ = [](float x, float y) { return x < y || x > y; };
  if (a.steps != b.steps || a.tool_steps != b.tool_steps || a.axes != b.axes ||
      a.correcting_count != b.correcting_count) {
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
  static constexpr bool kCompiledIn = true;
};

// A machine read from a validated image; `Axes` bounds the memory.
template <std::size_t Axes>
struct LoadedMachine {
  RuntimeChain chain{};
  static constexpr std::size_t kAxes = Axes;
  static constexpr bool kCompiledIn = false;
};

}  // namespace volcomp
