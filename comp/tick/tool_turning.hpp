#pragma once
// The direction of the tool's axis: how far the errors of the tick turn it, and what the orienting
// axes can do about it. To first order, in float rad; the lever of a second order of 1e-8 rad is a
// nanometre at 100 mm. Frames are followed from base to the tips, so that a rotation is three
// columns to be turned.

#include "comp/machine/tilt.hpp"
#include "comp/tick/recursive_error.hpp"

namespace volcomp::kernel {

struct ToolTurning {
  Float3 error{};  // orientation of the tool against the work, rad, base
  Float3 axis{};   // of the tool, Z of its frame, base
  Float3 tip{};    // tool point of the ideal machine, nm, base
  // The orienting axes: direction in which each turns the tool against the work, and a point on it,
  // base.
  std::array<Float3, kMaxOrienting> turn{};
  std::array<Float3, kMaxOrienting> pivot{};

  std::array<bool, kMaxOrienting> under_work{};

  // Takes what a turn of an orienting axis does to the tool point out of an error of it, nm; to
  // second order (comp/metrology/tables/pose_offset.hpp).
  void turn_back(std::size_t o, float rad, Float3& error_nm) const {
    const Float3 s =
        cross(turn[o], {tip[0] - pivot[o][0], tip[1] - pivot[o][1], tip[2] - pivot[o][2]});
    const Float3 bent = cross(turn[o], s);
    for (std::size_t i = 0; i < 3; ++i)
      error_nm[i] -= rad * (s[i] + 0.5F * rad * bent[i]);
    if (under_work[o]) add_cross(error_nm, turn[o], Float3(error_nm), -rad);
  }
};

// A frame of the ideal machine seen from base. Its columns are filled as soon as it is turned;
// until then nothing is multiplied.
struct FloatFrame {  // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::array<Float3, 3> column;
  Float3 origin{};
  bool turned = false;

  // A vector given in this frame.
  [[nodiscard]] Float3 in_base(const Float3& v) const {
    if (!turned) return v;
    Float3 out;
    VOLCOMP_UNROLL
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = column[0][i] * v[0] + column[1][i] * v[1] + column[2][i] * v[2];
    return out;
  }
  void orient(const std::array<float, 9>& R) {
    column = {in_base({R[0], R[3], R[6]}), in_base({R[1], R[4], R[7]}),
              in_base({R[2], R[5], R[8]})};
    turned = true;
  }
  void travel(std::size_t axis, float x) {
    if (!turned) {
      origin[axis] += x;
      return;
    }
    const Float3& n = column[axis];
    add(origin, {n[0] * x, n[1] * x, n[2] * x});
  }
  void turn(std::size_t axis, float s, float c) {
    const std::size_t j = axis == 2 ? 0 : axis + 1;
    const std::size_t k = axis == 0 ? 2 : axis - 1;
    if (!turned) {
      column = {};
      column[axis][axis] = 1.0F;
      column[j][j] = column[k][k] = c;
      column[j][k] = s;
      column[k][j] = -s;
      turned = true;
      return;
    }
    VOLCOMP_UNROLL
    for (std::size_t r = 0; r < 3; ++r) {
      const float before = column[j][r];
      column[j][r] = c * before + s * column[k][r];
      column[k][r] = c * column[k][r] - s * before;
    }
  }
};

// Into the frame of a step, its motion included.
VOLCOMP_INLINE void step_out(const RuntimeStep& step, const Located& at, FloatFrame& f) {
  if (step.has_offset) add(f.origin, f.in_base(step.offset_nm));
  if (step.has_orientation) f.orient(step.orientation);
  if (step.kind == JointKind::prismatic) f.travel(index(step.axis), at.travel_nm * step.sign);
  if (step.kind == JointKind::rotary)
    f.turn(index(step.axis), at.turn.sine * step.sign, at.turn.cosine);
}

// What an axis that orients does.
inline void note_axis(const RuntimeStep& step, const FloatFrame& f, ToolTurning& t) {
  const Float3& n = f.column[index(step.axis)];
  t.turn[step.orienting] = {step.sense * n[0], step.sense * n[1], step.sense * n[2]};
  t.pivot[step.orienting] = f.origin;
  t.under_work[step.orienting] = step.work;
}

// From base to a tip; its frame.
template <class Machine, class Places>
FloatFrame walk_out(const Machine& machine, const Places& at, const StepAngles& angle, bool work,
                    ToolTurning& t) {
  const RuntimeChain& chain = machine.chain;
  const std::size_t steps = work ? chain.steps - chain.tool_steps : chain.tool_steps;
  FloatFrame f;
  for (std::size_t n = 0; n < steps; ++n) {
    const std::size_t i = work ? chain.tool_steps + n : steps - 1 - n;
    const RuntimeStep& step = chain.step[i];
    step_out(step, at[step.nc_axis], f);
    if (errs(step)) {
      const Float3 turn = f.in_base(angle[i]);
      work ? subtract(t.error, turn) : add(t.error, turn);
    }
    if (step.orienting != kNotOrienting) note_axis(step, f, t);
  }
  return f;
}

template <class Machine, class Set, class Places>
ToolTurning tool_turning(const Machine& machine, const Set& set, const Places& at,
                         const StepAngles& angle) {
  ToolTurning t;
  const FloatFrame tool = walk_out(machine, at, angle, false, t);
  const std::array<float, 9>& R = machine.chain.tool_orientation;
  t.axis = tool.in_base({R[2], R[5], R[8]});
  t.tip = tool.in_base(set.tool_nm);
  add(t.tip, tool.origin);
  walk_out(machine, at, angle, true, t);
  return t;
}

// How far the orienting axes have to turn back, rad; comp/machine/tilt.hpp.
inline std::array<float, kMaxOrienting> tilt_excess(const RuntimeChain& chain,
                                                    const ToolTurning& t) {
  const Float3 off = cross(t.error, t.axis);
  const Float3 first = cross(t.turn[0], t.axis);
  TiltEquations<float> e;
  e.t11 = dot(first, first);
  e.b1 = dot(first, off);
  if (chain.orienting_count == kMaxOrienting) {
    const Float3 second = cross(t.turn[1], t.axis);
    e.t12 = dot(first, second);
    e.t22 = dot(second, second);
    e.b2 = dot(second, off);
  }
  return solve_tilt(e);
}

}  // namespace volcomp::kernel
