#pragma once
// The volumetric error of a machine of linear and rotary axes, in float nm and rad: a second-order
// recursion of deviations. No libm, no allocation, no division.
//
// A loaded machine goes round a loop of steps. What every step needs is straight code; its motion
// selects one jump; what few machines have is behind one test (RuntimeStep::plain).

#include "comp/tables/table_set.hpp"
#include "comp/tables/walk.hpp"

namespace volcomp::kernel {

// (Rx(a) Ry(b) Rz(c) − I) w, factor by factor, each to second order: third order < 1e-3 nm at 1e-4
// rad and 1 m.
VOLCOMP_INLINE Float3 rotate_minus_identity(const float* angle, const Float3& w) {
  const float a = angle[0];
  const float b = angle[1];
  const float c = angle[2];
  const float dx1 = -c * (w[1] + 0.5F * c * w[0]);
  const float dy1 = c * (w[0] - 0.5F * c * w[1]);
  const float x = w[0] + dx1;
  const float y = w[1] + dy1;
  const float dx2 = b * (w[2] - 0.5F * b * x);
  const float dz2 = -b * (x + 0.5F * b * w[2]);
  const float z = w[2] + dz2;
  return {dx1 + dx2, dy1 - a * (z + 0.5F * a * y), dz2 + a * (y - 0.5F * a * z)};
}

// ((Rx Ry Rz)ᵀ − I) w
VOLCOMP_INLINE Float3 unrotate_minus_identity(const float* angle, const Float3& w) {
  const float a = angle[0];
  const float b = angle[1];
  const float c = angle[2];
  const float dy1 = a * (w[2] - 0.5F * a * w[1]);
  const float dz1 = -a * (w[1] + 0.5F * a * w[2]);
  const float y = w[1] + dy1;
  const float z = w[2] + dz1;
  const float dx2 = -b * (z + 0.5F * b * w[0]);
  const float dz2 = b * (w[0] - 0.5F * b * z);
  const float x = w[0] + dx2;
  return {dx2 + c * (y - 0.5F * c * x), dy1 - c * (x + 0.5F * c * y), dz1 + dz2};
}

// Jacobian columns that change with the pose, base frame, nm per nm or nm per rad; at the end of
// the recursion they are where InversePlan places them.
using Columns = std::array<Float3, kMaxCorrecting>;

// State of the recursion.
struct Recursion {
  Float3 p;  // ideal point
  Float3 e;  // deviation
  Columns& column;
};

// The ideal motion of a step, on p and e.
VOLCOMP_INLINE void move(const RuntimeStep& step, const Located& at, Recursion& r) {
  const auto turn = [&](Axis axis) VOLCOMP_INLINE_LAMBDA {
    const float s = at.turn.sine * step.sense;
    const float c = at.turn.cosine;
    rotate(r.p, axis, s, c);
    rotate(r.e, axis, s, c);
  };
  switch (step.motion) {
    case Motion::none:
      return;
    case Motion::along_x:
      r.p[0] += at.travel_nm * step.sense;
      return;
    case Motion::along_y:
      r.p[1] += at.travel_nm * step.sense;
      return;
    case Motion::along_z:
      r.p[2] += at.travel_nm * step.sense;
      return;
    case Motion::about_x:
      return turn(Axis::x);
    case Motion::about_y:
      return turn(Axis::y);
    case Motion::about_z:
      return turn(Axis::z);
  }
}

// s â × p for a rotary axis, s â for a linear one.
VOLCOMP_INLINE void set_motion_column(const RuntimeStep& step, const Float3& p, Float3& column) {
  const float s = step.sense;
  switch (step.motion) {
    case Motion::along_x:
      column = {s, 0.0F, 0.0F};
      return;
    case Motion::along_y:
      column = {0.0F, s, 0.0F};
      return;
    case Motion::along_z:
      column = {0.0F, 0.0F, s};
      return;
    case Motion::about_x:
      column = {0.0F, -s * p[2], s * p[1]};
      return;
    case Motion::about_y:
      column = {s * p[2], 0.0F, -s * p[0]};
      return;
    case Motion::about_z:
      column = {-s * p[1], s * p[0], 0.0F};
      return;
    case Motion::none:
      return;
  }
}

// Calls visit(column) for `count` carried columns from `first` on. On a loaded machine, which does
// not know them before, the columns share one piece of code.
template <class Visit>
VOLCOMP_INLINE void for_columns(Columns& column, std::size_t first, std::size_t count,
                                const Visit& visit) {
  if (__builtin_constant_p(first) && __builtin_constant_p(count)) {
    VOLCOMP_UNROLL
    for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
      if (c >= first && c < first + count) visit(column[c]);
    }
  } else {
    VOLCOMP_LOOP
    for (std::size_t c = first; c < first + count; ++c)
      visit(column[c]);
  }
}

// The columns of a branch nearer to its tip turn with a step towards base.
VOLCOMP_INLINE void turn_columns(const RuntimeStep& step, const SineCosine& t, std::size_t first,
                                 Columns& column) {
  if (step.kind != JointKind::rotary) return;
  const float s = t.sine * step.sign;
  for_columns(column, first, step.columns_before,
              [&](Float3& c) VOLCOMP_INLINE_LAMBDA { rotate(c, step.axis, s, t.cosine); });
}

// And are oriented like the deviation, the step's own included.
VOLCOMP_INLINE void orient_columns(const RuntimeStep& step, std::size_t first, Columns& column) {
  const std::size_t count = step.columns_before + (step.carried() ? 1U : 0U);
  for_columns(column, first, count,
              [&](Float3& c) VOLCOMP_INLINE_LAMBDA { orient(c, step.orientation); });
}

// Tool branch: e ← e + δ + (R_E − I)(p + e). `fresh`: e is still 0.
VOLCOMP_INLINE void err_to_base(const ChannelValues& v, bool fresh, Recursion& r) {
  Float3 w = r.p;
  if (!fresh) add(w, r.e);
  const Float3 d = rotate_minus_identity(&v[3], w);
  const Float3 grown{v[0] + d[0], v[1] + d[1], v[2] + d[2]};
  if (fresh) r.e = grown;
  if (!fresh) add(r.e, grown);
}

// Work branch: v = e − δ, e ← v + (R_Eᵀ − I)(p + v).
VOLCOMP_INLINE void err_to_work(const ChannelValues& v, Recursion& r) {
  const Float3 w{r.e[0] - v[0], r.e[1] - v[1], r.e[2] - v[2]};
  const Float3 d = unrotate_minus_identity(&v[3], {r.p[0] + w[0], r.p[1] + w[1], r.p[2] + w[2]});
  r.e = {w[0] + d[0], w[1] + d[1], w[2] + d[2]};
}

[[nodiscard]] VOLCOMP_INLINE bool errs(const RuntimeStep& step) {
  return step.kind != JointKind::fixed || step.has_error;
}

// Angles of the error of every step that errs, rad, in its frame.
using StepAngles = std::array<Float3, kMaxBodies>;

// What a machine whose tool nobody turns makes of the angles of an error.
struct KeepsNoAngles {
  VOLCOMP_INLINE void operator()(std::size_t /*step*/, const ChannelValues& /*v*/) const {}
};

struct KeepsAngles {
  StepAngles& angle;
  VOLCOMP_INLINE void operator()(std::size_t step, const ChannelValues& v) const {
    angle[step] = {v[3], v[4], v[5]};
  }
};

// Calls visit(channels) if the step errs: an axis by its tables, a fixed body constantly.
template <class Visit>
VOLCOMP_INLINE void with_error(const RuntimeStep& step, const Located& at, const Visit& visit) {
  ChannelValues v;
  if (VOLCOMP_UNLIKELY(step.kind == JointKind::fixed)) {
    if (!step.has_error) return;
    v = step.error;
  } else {
    interpolate(*at.knot, at.t, v);
  }
  visit(v);
}

// On a loaded machine adding 0 is cheaper than branching.
template <class Machine>
VOLCOMP_INLINE bool has_offset(const RuntimeStep& step) {
  return !Machine::kCompiledIn || step.has_offset;
}

// Tool branch, one step towards base: the error of the step, e ← R_H R_J e, p ← H J p.
template <class Machine, class Keep>
VOLCOMP_INLINE void step_to_base(const RuntimeStep& step, const Located& at, bool fresh,
                                 Recursion& r, const Keep& keep) {
  with_error(step, at, [&](const ChannelValues& v) VOLCOMP_INLINE_LAMBDA {
    keep(v);
    err_to_base(v, fresh, r);
  });
  move(step, at, r);
  if (!step.plain) {
    turn_columns(step, at.turn, 0, r.column);
    if (step.carried()) set_motion_column(step, r.p, r.column[step.column]);
    if (step.has_orientation) {
      orient(r.p, step.orientation);
      orient(r.e, step.orientation);
      orient_columns(step, 0, r.column);
    }
  }
  if (has_offset<Machine>(step)) add(r.p, step.offset_nm);
}

// Work branch, one step towards its tip: e ← R_Jᵀ R_Hᵀ e, p ← (H J)⁻¹ p, the error of the step.
template <class Machine, class Keep>
VOLCOMP_INLINE void step_to_work(const RuntimeStep& step, const Located& at, Recursion& r,
                                 const Keep& keep) {
  if (has_offset<Machine>(step)) subtract(r.p, step.offset_nm);
  if (!step.plain) {
    if (step.has_orientation) {
      orient_inverse(r.p, step.orientation);
      orient_inverse(r.e, step.orientation);
    }
    if (step.carried()) set_motion_column(step, r.p, r.column[step.column]);
  }
  move(step, at, r);
  with_error(step, at, [&](const ChannelValues& v) VOLCOMP_INLINE_LAMBDA {
    keep(v);
    err_to_work(v, r);
  });
}

// Turns the error in the work frame back into base orientation, together with the columns of the
// work axes between this step and the tip.
VOLCOMP_INLINE void step_back_to_base(const RuntimeStep& step, const Located& at,
                                      std::size_t first_column, Recursion& r) {
  if (step.kind == JointKind::rotary)
    rotate(r.e, step.axis, at.turn.sine * step.sign, at.turn.cosine);
  if (step.plain) return;
  turn_columns(step, at.turn, first_column, r.column);
  if (!step.has_orientation) return;
  orient(r.e, step.orientation);
  orient_columns(step, first_column, r.column);
}

// The error in base orientation; keep(step, channels) for every step that errs.
template <class Machine, class Set, class Places, class Keep>
VOLCOMP_INLINE Float3 recursive_error(const Machine& machine, const Set& set, const Places& at,
                                      Columns& column, const Keep& keep) {
  const RuntimeChain& chain = machine.chain;
  Recursion r{set.tool_nm, {}, column};
  if (chain.inverse.form == InverseForm::general) column = {};
  walk_up<Machine>(0, chain.tool_steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    const RuntimeStep& step = chain.step[i];
    const auto keep_this = [&](const ChannelValues& v) VOLCOMP_INLINE_LAMBDA { keep(i, v); };
    step_to_base<Machine>(step, at[step.nc_axis], Machine::kCompiledIn && i == 0, r, keep_this);
  });
  for_each_linear<Machine>(machine, [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    const float x = at[a].travel_nm;
    add(r.e, {set.direction[a][0] * x, set.direction[a][1] * x, set.direction[a][2] * x});
  });
  walk_up<Machine>(chain.tool_steps, chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    const RuntimeStep& step = chain.step[i];
    const auto keep_this = [&](const ChannelValues& v) VOLCOMP_INLINE_LAMBDA { keep(i, v); };
    step_to_work<Machine>(step, at[step.nc_axis], r, keep_this);
  });
  walk_down<Machine>(chain.tool_steps, chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    const RuntimeStep& step = chain.step[i];
    step_back_to_base(step, at[step.nc_axis], chain.tool_columns, r);
  });
  return r.e;
}

}  // namespace volcomp::kernel
