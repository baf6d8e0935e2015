#pragma once
// The machine that a compensator is made for: its walk, built from the description, whether that is
// compiled in or comes with an image.

#include <array>
#include <cstdint>

#include "comp/machine/body_paths.hpp"
#include "comp/tables/fixed_bodies.hpp"
#include "comp/tables/inverse_plan.hpp"

namespace volcomp {
namespace detail {

constexpr Motion motion_of(const Joint& joint) {
  if (!joint.moves()) return Motion::none;
  const bool turns = joint.kind == JointKind::rotary;
  const Motion first = turns ? Motion::about_x : Motion::along_x;
  return static_cast<Motion>(static_cast<std::size_t>(first) + index(joint.axis));
}

constexpr bool differs(float x, float y) { return x < y || x > y; }

template <std::size_t N>
constexpr bool differ(const std::array<float, N>& a, const std::array<float, N>& b) {
  for (std::size_t i = 0; i < N; ++i) {
    if (differs(a[i], b[i])) return true;
  }
  return false;
}

constexpr void set_joint(RuntimeStep& step, const Joint& joint, const FixedFrame& at) {
  step.kind = joint.kind;
  step.axis = joint.axis;
  step.motion = motion_of(joint);
  step.nc_axis = joint.moves() ? joint.nc_axis : std::uint8_t{0};  // fixed: unused
  step.sign = static_cast<float>(joint.sign);
  step.sense = step.work ? -step.sign : step.sign;
  step.orientation = at.R;
  step.offset_nm = at.t_nm;
  step.has_orientation = differ(at.R, kAtCarrier.R);
  step.has_offset = differ(at.t_nm, kAtCarrier.t_nm);
}

// nm and rad; 0 of a body that moves.
constexpr SmallMotion constant_error(const Body& body) {
  SmallMotion e{};
  for (std::size_t i = 0; i < 6 && !body.joint.moves(); ++i)
    e[i] = static_cast<float>(body.constant_error[i] * (i < 3 ? 1e6 : 1.0));
  return e;
}

// Adds the steps of a branch from base to its tip; returns the frame of the tip in the one of the
// last step. `whole`: every body is one. Else fixed bodies are part of the step they hang on; one
// with an error that hangs on base is a step.
constexpr FixedFrame add_branch(RuntimeChain& chain, const MachineDescription& machine,
                                const BodyPath& path, bool work, bool whole) {
  FixedFrame at;
  RuntimeStep* last = nullptr;
  for (const std::uint8_t index : path) {
    const Body& body = machine.body[index];
    const SmallMotion error = constant_error(body);
    const bool errs = differ(error, SmallMotion{});
    at.extend_by(body.joint);
    if (body.joint.moves() || whole || (errs && last == nullptr)) {
      last = &chain.step[chain.steps++];
      last->body = index;
      last->work = work;
      last->error = error;
      last->has_error = errs;
      set_joint(*last, body.joint, at);
      at = kAtCarrier;
    } else if (errs) {
      act_after(last->error, at.error_of_carrier(error), true);
      last->has_error = true;
    }
  }
  return at;
}

constexpr void reverse_steps(RuntimeChain& chain) {
  for (std::size_t i = 0, k = chain.steps; i + 1 < k; ++i) {
    const RuntimeStep step = chain.step[i];
    chain.step[i] = chain.step[--k];
    chain.step[k] = step;
  }
}

// std::any_of is for the run time alone before C++20.
constexpr bool any_turns(const MachineDescription& machine, const BodyPath& path) {
  for (const std::uint8_t body : path) {  // NOLINT(readability-use-anyofallof)
    if (machine.body[body].joint.kind == JointKind::rotary) return true;
  }
  return false;
}

}  // namespace detail

// Expects a description that MachineChain::build accepts. `folded` is ignored when an axis is
// rotary: the sum is defined for linear axes only.
constexpr RuntimeChain make_runtime_chain(const MachineDescription& machine,
                                          RuntimeModel model = RuntimeModel::automatic) {
  RuntimeChain chain;
  const BranchPaths paths = branch_paths(machine);
  const bool turns =
      detail::any_turns(machine, paths.tool) || detail::any_turns(machine, paths.work);
  chain.folded = !turns && model != RuntimeModel::second_order;
  const FixedFrame tool = detail::add_branch(chain, machine, paths.tool, false, chain.folded);
  chain.tool_offset_nm = tool.t_nm;
  chain.tool_orientation = tool.R;
  detail::reverse_steps(chain);
  chain.tool_steps = chain.steps;
  detail::add_branch(chain, machine, paths.work, true, chain.folded);
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
  for (std::size_t i = 0; i < chain.steps; ++i) {
    RuntimeStep& step = chain.step[i];
    if (step.kind != JointKind::fixed) {
      step.correcting = chain.correcting_index[step.nc_axis];
      if (step.kind == JointKind::rotary) step.orienting = chain.orienting_index(step.nc_axis);
      chain.first_folded = static_cast<std::uint8_t>(i);
    }
    chain.has_orientation = chain.has_orientation || step.has_orientation;
    chain.has_constant_error = chain.has_constant_error || step.has_error;
  }
  chain.inverse = detail::plan_inverse(chain);
  detail::number_columns(chain);
  return chain;
}

// True when tables made for `b` may run on `a`: same walk, same geometry. Called when tables are
// taken over, not by the tick; a copy of it in every caller costs flash.
[[gnu::noinline]] constexpr bool same_chain(const RuntimeChain& a, const RuntimeChain& b) {
  using detail::differ;
  if (a.steps != b.steps || a.tool_steps != b.tool_steps || a.axes != b.axes ||
      a.correcting_count != b.correcting_count || a.orienting_count != b.orienting_count ||
      a.orienting[0] != b.orienting[0] || a.orienting[1] != b.orienting[1]) {
    return false;
  }
  if (differ(a.tool_offset_nm, b.tool_offset_nm) ||
      differ(a.tool_orientation, b.tool_orientation)) {
    return false;
  }
  for (std::size_t i = 0; i < a.steps; ++i) {
    const RuntimeStep& x = a.step[i];
    const RuntimeStep& y = b.step[i];
    if (x.kind != y.kind || x.axis != y.axis || x.work != y.work || x.nc_axis != y.nc_axis)
      return false;
    if (x.correcting != y.correcting || detail::differs(x.sign, y.sign)) return false;
    if (differ(x.offset_nm, y.offset_nm) || differ(x.orientation, y.orientation) ||
        differ(x.error, y.error)) {
      return false;
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
