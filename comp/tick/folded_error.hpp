#pragma once
// The volumetric error of a machine of linear axes, in float nm and rad: the first-order sum whose
// levers are folded into the tables. No libm, no allocation, no division.

#include "comp/tables/table_set.hpp"
#include "comp/tables/walk.hpp"

namespace volcomp::kernel {

// E = Σ a + Σ Ω × (travel of each axis), one pass around the loop work tip → base → tool tip. Ω
// collects the angles whose lever contains the travel: a work axis counts its own, a tool axis only
// those before it.
template <class Machine, class Set, class Places>
VOLCOMP_INLINE Float3 folded_error(const Machine& machine, const Set& set, const Places& at) {
  Float3 e{};
  Float3 omega{};
  walk_down<Machine>(0, machine.chain.steps, [&](std::size_t i) VOLCOMP_INLINE_LAMBDA {
    const RuntimeStep& step = machine.chain.step[i];
    if (step.kind == JointKind::fixed) return;
    const std::size_t a = step.nc_axis;
    ChannelValues v;
    interpolate(*at[a].knot, at[a].t, v);
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

}  // namespace volcomp::kernel
