#pragma once
// The volumetric error of one tick, in float nm and rad: the folded first-order sum for linear
// machines, the second-order deviation recursion as soon as an axis turns. No libm, no allocation,
// no division but in the inverse.

#include <cstddef>
#include <utility>

#include "comp/realtime/fixed_trig.hpp"
#include "comp/realtime/table_set.hpp"

namespace volcomp::kernel {

template <class Visit, std::size_t... I>
VOLCOMP_INLINE void visit_each(std::size_t from, std::size_t to, const Visit& visit,
                               std::index_sequence<I...>) {
  (static_cast<void>(I >= from && I < to ? visit(I) : void()), ...);
}

// Calls visit(i) for the steps from…to−1 of the walk, upwards or downwards. For a compiled-in
// machine every call is inlined with a constant i, so that all branches on the step disappear.
template <class Machine, class Visit>
VOLCOMP_INLINE void walk_up(std::size_t from, std::size_t to, const Visit& visit) {
  if constexpr (Machine::kCompiledIn) {
    visit_each(from, to, visit, std::make_index_sequence<Machine::chain.steps>{});
  } else {
    for (std::size_t i = from; i < to; ++i)
      visit(i);
  }
}

template <class Machine, class Visit>
VOLCOMP_INLINE void walk_down(std::size_t from, std::size_t to, const Visit& visit) {
  if constexpr (Machine::kCompiledIn) {
    constexpr std::size_t n = Machine::chain.steps;
    const auto mirrored = [&](std::size_t k) VOLCOMP_INLINE_LAMBDA { visit(n - 1 - k); };
    visit_each(n - to, n - from, mirrored, std::make_index_sequence<n>{});
  } else {
    for (std::size_t i = to; i > from; --i)
      visit(i - 1);
  }
}

// Calls visit(axis) for the linear axes.
template <class Machine, class Visit>
VOLCOMP_INLINE void for_each_linear(const Machine& machine, const Visit& visit) {
  const auto linear = [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    if (machine.chain.kind[a] == JointKind::prismatic) visit(a);
  };
  visit_each(0, machine.chain.axes, linear, std::make_index_sequence<Machine::kAxes>{});
}

VOLCOMP_INLINE void add(Float3& a, const Float3& b) {
  a[0] += b[0];
  a[1] += b[1];
  a[2] += b[2];
}

// e += x · (w × unit vector of `axis`)
VOLCOMP_INLINE void add_cross_axis(Float3& e, const Float3& w, Axis axis, float x) {
  switch (axis) {
    case Axis::x:
      e[1] += w[2] * x;
      e[2] -= w[1] * x;
      break;
    case Axis::y:
      e[0] -= w[2] * x;
      e[2] += w[0] * x;
      break;
    case Axis::z:
      e[0] += w[1] * x;
      e[1] -= w[0] * x;
      break;
  }
}

// e += x · (w × n)
VOLCOMP_INLINE void add_cross(Float3& e, const Float3& w, const Float3& n, float x) {
  e[0] += (w[1] * n[2] - w[2] * n[1]) * x;
  e[1] += (w[2] * n[0] - w[0] * n[2]) * x;
  e[2] += (w[0] * n[1] - w[1] * n[0]) * x;
}

// p += x · unit vector of `axis`
VOLCOMP_INLINE void add_along(Float3& p, Axis axis, float x) {
  switch (axis) {
    case Axis::x:
      p[0] += x;
      break;
    case Axis::y:
      p[1] += x;
      break;
    case Axis::z:
      p[2] += x;
      break;
  }
}

// E = Σ a + Σ Ω × (travel of each axis), one pass around the loop work tip → base → tool tip. Ω
// collects the angles whose lever contains the travel: a work axis counts its own, a tool axis only
// those before it (seed 001 section 2.1, "Generic count").
template <class Machine, class Set, class Places>
VOLCOMP_INLINE Float3 folded_error(const Machine& machine, const Set& set, const Places& at) {
  Float3 e{};
  Float3 omega{};
  walk_down<Machine>(0, machine.chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    const RuntimeStep& step = machine.chain.step[i];
    if (step.kind == JointKind::fixed) return;
    const std::size_t a = step.nc_axis;
    ChannelValues v;
    interpolate(at[a], v);
    const float x = at[a].travel_nm * step.sign;
    const Float3 w{v[3], v[4], v[5]};
    const bool first = i == machine.chain.first_folded && !machine.chain.has_constant_error;
    if (machine.chain.has_constant_error) add(omega, set.turn_before[a]);
    if (step.work) first ? void(omega = w) : add(omega, w);
    first ? void(e = {v[0], v[1], v[2]}) : add(e, {v[0], v[1], v[2]});
    const float lever = step.work ? -x : x;
    if (machine.chain.has_orientation) {
      add_cross(e, omega, set.travel_axis[a], lever);
    } else {
      add_cross_axis(e, omega, step.axis, lever);
    }
    if (!step.work) first ? void(omega = w) : add(omega, w);
  });
  return e;
}

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

template <std::size_t J, std::size_t K>
VOLCOMP_INLINE void rotate_plane(Float3& p, float s, float c) {
  const float j = p[J];
  const float k = p[K];
  p[J] = c * j - s * k;
  p[K] = s * j + c * k;
}

VOLCOMP_INLINE void rotate(Float3& p, Axis axis, float s, float c) {
  switch (axis) {
    case Axis::x:
      rotate_plane<1, 2>(p, s, c);
      break;
    case Axis::y:
      rotate_plane<2, 0>(p, s, c);
      break;
    case Axis::z:
      rotate_plane<0, 1>(p, s, c);
      break;
  }
}

VOLCOMP_INLINE void orient(Float3& p, const std::array<float, 9>& R) {
  p = {R[0] * p[0] + R[1] * p[1] + R[2] * p[2], R[3] * p[0] + R[4] * p[1] + R[5] * p[2],
       R[6] * p[0] + R[7] * p[1] + R[8] * p[2]};
}

VOLCOMP_INLINE void orient_inverse(Float3& p, const std::array<float, 9>& R) {
  p = {R[0] * p[0] + R[3] * p[1] + R[6] * p[2], R[1] * p[0] + R[4] * p[1] + R[7] * p[2],
       R[2] * p[0] + R[5] * p[1] + R[8] * p[2]};
}

// Jacobian columns that change with the pose, base frame, nm per nm or nm per rad.
using Columns = std::array<Float3, kMaxCorrecting>;

// What the recursion keeps besides the point and its deviation; at its end the columns are where
// InversePlan says.
template <std::size_t Axes>
struct Carried {
  Columns column;
  std::array<SineCosine, Axes> turn;  // of the rotary work axes
};

// State of the recursion.
template <class Carried>
struct Recursion {
  Float3 p;  // ideal point
  Float3 e;  // deviation
  Carried& carried;
};

VOLCOMP_INLINE Float3 unit(Axis axis, float length) {
  Float3 v{};
  add_along(v, axis, length);
  return v;
}

// s â × p for a rotary axis, s â for a linear one.
VOLCOMP_INLINE Float3 motion_column(const RuntimeStep& step, const Float3& p) {
  const float s = step.work ? -step.sign : step.sign;
  if (step.kind == JointKind::prismatic) return unit(step.axis, s);
  Float3 column{};
  add_cross_axis(column, p, step.axis, -s);
  return column;
}

// Calls visit(column) for `count` carried columns from `first` on.
template <class Visit>
VOLCOMP_INLINE void for_columns(Columns& column, std::size_t first, std::size_t count,
                                const Visit& visit) {
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
    if (c >= first && c < first + count) visit(column[c]);
  }
}

// Tool branch, one step towards base: e ← R_H R_J (e + δ + (R_E − I)(p + e)), p ← H J p. `fresh`: e
// is still 0.
template <class Carried, class Places>
VOLCOMP_INLINE void step_to_base(const RuntimeStep& step, const Places& at, bool fresh,
                                 Recursion<Carried>& r) {
  const std::size_t a = step.nc_axis;
  if (step.kind != JointKind::fixed || step.has_error) {
    ChannelValues v = step.error;
    if (step.kind != JointKind::fixed) interpolate(at[a], v);
    Float3 w{r.p[0], r.p[1], r.p[2]};
    if (!fresh) add(w, r.e);
    const Float3 d = rotate_minus_identity(&v[3], w);
    const Float3 grown{v[0] + d[0], v[1] + d[1], v[2] + d[2]};
    if (fresh) r.e = grown;
    if (!fresh) add(r.e, grown);
  }
  if (step.kind == JointKind::rotary) {
    const SineCosine t = sine_cosine(at[a].angle);
    const float s = t.sine * step.sign;
    rotate(r.p, step.axis, s, t.cosine);
    rotate(r.e, step.axis, s, t.cosine);
    for_columns(r.carried.column, 0, step.columns_before,
                [&](Float3& column)
                    VOLCOMP_INLINE_LAMBDA { rotate(column, step.axis, s, t.cosine); });
  } else if (step.kind == JointKind::prismatic) {
    add_along(r.p, step.axis, at[a].travel_nm * step.sign);
  }
  if (step.carried()) r.carried.column[step.column] = motion_column(step, r.p);
  if (step.has_orientation) {
    orient(r.p, step.orientation);
    orient(r.e, step.orientation);
    const std::size_t columns = step.columns_before + (step.carried() ? 1U : 0U);
    for_columns(r.carried.column, 0, columns,
                [&](Float3& column) VOLCOMP_INLINE_LAMBDA { orient(column, step.orientation); });
  }
  if (step.has_offset) add(r.p, step.offset_nm);
}

// Work branch, one step towards its tip: v = R_Jᵀ R_Hᵀ e − δ, e ← v + (R_Eᵀ − I)(p + v).
template <class Carried, class Places>
VOLCOMP_INLINE void step_to_work(const RuntimeStep& step, const Places& at, Recursion<Carried>& r) {
  if (step.has_offset) add(r.p, {-step.offset_nm[0], -step.offset_nm[1], -step.offset_nm[2]});
  if (step.has_orientation) {
    orient_inverse(r.p, step.orientation);
    orient_inverse(r.e, step.orientation);
  }
  if (step.carried()) r.carried.column[step.column] = motion_column(step, r.p);
  const std::size_t a = step.nc_axis;
  if (step.kind == JointKind::rotary) {
    SineCosine t = sine_cosine(at[a].angle);
    t.sine *= step.sign;
    r.carried.turn[a] = t;
    rotate(r.p, step.axis, -t.sine, t.cosine);
    rotate(r.e, step.axis, -t.sine, t.cosine);
  } else if (step.kind == JointKind::prismatic) {
    add_along(r.p, step.axis, -(at[a].travel_nm * step.sign));
  }
  if (step.kind == JointKind::fixed && !step.has_error) return;
  ChannelValues v = step.error;
  if (step.kind != JointKind::fixed) interpolate(at[a], v);
  const Float3 w{r.e[0] - v[0], r.e[1] - v[1], r.e[2] - v[2]};
  const Float3 d = unrotate_minus_identity(&v[3], {r.p[0] + w[0], r.p[1] + w[1], r.p[2] + w[2]});
  r.e = {w[0] + d[0], w[1] + d[1], w[2] + d[2]};
}

// Turns the error in the work frame back into base orientation, together with the columns of the
// work axes between this step and the tip.
template <class Machine, class Carried>
VOLCOMP_INLINE void step_back_to_base(const Machine& machine, const RuntimeStep& step,
                                      Recursion<Carried>& r) {
  const std::size_t first = machine.chain.tool_columns;
  if (step.kind == JointKind::rotary) {
    const SineCosine& t = r.carried.turn[step.nc_axis];
    rotate(r.e, step.axis, t.sine, t.cosine);
    for_columns(r.carried.column, first, step.columns_before,
                [&](Float3& column)
                    VOLCOMP_INLINE_LAMBDA { rotate(column, step.axis, t.sine, t.cosine); });
  }
  if (!step.has_orientation) return;
  orient(r.e, step.orientation);
  const std::size_t columns = step.columns_before + (step.carried() ? 1U : 0U);
  for_columns(r.carried.column, first, columns,
              [&](Float3& column) VOLCOMP_INLINE_LAMBDA { orient(column, step.orientation); });
}

// Second-order recursion (seed 000 section 1): the error in base orientation.
template <class Machine, class Set, class Places, class Carried>
VOLCOMP_INLINE Float3 recursive_error(const Machine& machine, const Set& set, const Places& at,
                                      Carried& carried) {
  const RuntimeChain& chain = machine.chain;
  Recursion<Carried> r{{set.tool_nm[0], set.tool_nm[1], set.tool_nm[2]}, {}, carried};
  if (chain.inverse.form == InverseForm::general) carried.column = {};
  walk_up<Machine>(0, chain.tool_steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    step_to_base(chain.step[i], at, Machine::kCompiledIn && i == 0, r);
  });
  for_each_linear<Machine>(machine, [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    const float x = at[a].travel_nm;
    add(r.e, {set.direction[a][0] * x, set.direction[a][1] * x, set.direction[a][2] * x});
  });
  walk_up<Machine>(chain.tool_steps, chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    step_to_work(chain.step[i], at, r);
  });
  walk_down<Machine>(chain.tool_steps, chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    step_back_to_base(machine, chain.step[i], r);
  });
  return r.e;
}

}  // namespace volcomp::kernel
