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

// A frame of the ideal machine seen from base.
struct FloatFrame {
  std::array<Float3, 3> column{{{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}}};
  Float3 origin{};

  // A vector given in this frame.
  [[nodiscard]] Float3 turned(const float* v) const {
    Float3 out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = column[0][i] * v[0] + column[1][i] * v[1] + column[2][i] * v[2];
    return out;
  }
};

// Into the frame of a step, its motion included.
inline void step_out(const RuntimeStep& step, const Located& at, FloatFrame& f) {
  const std::size_t i = index(step.axis);
  add(f.origin, f.turned(step.offset_nm.data()));
  if (step.has_orientation) {
    const std::array<float, 9>& R = step.orientation;
    f.column = {f.turned(Float3{R[0], R[3], R[6]}.data()),
                f.turned(Float3{R[1], R[4], R[7]}.data()),
                f.turned(Float3{R[2], R[5], R[8]}.data())};
  }
  if (step.kind == JointKind::prismatic) {
    const float x = at.travel_nm * step.sign;
    add(f.origin, {f.column[i][0] * x, f.column[i][1] * x, f.column[i][2] * x});
  }
  if (step.kind != JointKind::rotary) return;
  const float s = at.turn.sine * step.sign;
  const float c = at.turn.cosine;
  Float3& j = f.column[(i + 1) % 3];
  Float3& k = f.column[(i + 2) % 3];
  for (std::size_t r = 0; r < 3; ++r) {
    const float before = j[r];
    j[r] = c * before + s * k[r];
    k[r] = c * k[r] - s * before;
  }
}

// What a step in its frame adds: its error, and its axis if that orients.
inline void note(const RuntimeStep& step, std::uint8_t orienting, const Located& at,
                 const FloatFrame& f, ToolTurning& t) {
  with_error(step, at, [&](const ChannelValues& v) {
    const Float3 turn = f.turned(&v[3]);
    step.work ? subtract(t.error, turn) : add(t.error, turn);
  });
  if (orienting == kNotOrienting || step.kind != JointKind::rotary) return;
  const Float3& n = f.column[index(step.axis)];
  t.turn[orienting] = {step.sense * n[0], step.sense * n[1], step.sense * n[2]};
  t.pivot[orienting] = f.origin;
  t.under_work[orienting] = step.work;
}

template <class Machine, class Set, class Places>
ToolTurning tool_turning(const Machine& machine, const Set& set, const Places& at) {
  const RuntimeChain& chain = machine.chain;
  ToolTurning t;
  FloatFrame tool;
  for (std::size_t i = chain.tool_steps; i > 0; --i) {
    const RuntimeStep& step = chain.step[i - 1];
    step_out(step, at[step.nc_axis], tool);
    note(step, chain.orienting_index(step.nc_axis), at[step.nc_axis], tool, t);
  }
  t.axis = tool.column[2];
  t.tip = tool.turned(set.tool_nm.data());
  add(t.tip, tool.origin);
  FloatFrame work;
  for (std::size_t i = chain.tool_steps; i < chain.steps; ++i) {
    const RuntimeStep& step = chain.step[i];
    step_out(step, at[step.nc_axis], work);
    note(step, chain.orienting_index(step.nc_axis), at[step.nc_axis], work, t);
  }
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
