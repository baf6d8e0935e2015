#include "host_sim/sim/controller/axis_group.hpp"

#include <utility>

namespace volcomp::sim {

void AxisGroup::watch(MachineWatch& watch, std::string letters, const host::AxisKinds& kinds) {
  letters_ = std::move(letters);
  kinds_ = kinds;
  snapshot_ = {};
  observer_ = watch.enter();
}

void AxisGroup::show() {
  if (!observer_) return;
  MachineSnapshot& s = snapshot_;
  ++s.cycle;
  s.period_s = period_s();
  s.axes = kinds_.count;
  const host::Targets targets = target();
  const host::Offsets offsets = offset();
  const Pose pose = position();
  const Latches latched = latches();
  for (std::size_t a = 0; a < s.axes; ++a)
    s.axis[a] = {letters_.at(a), kinds_.rotary[a], targets[a],   offsets[a],
                 pose[a],        latched[a].count, std::nullopt, std::nullopt};
  add_states(s);
  observer_->cycle(s);
}

}  // namespace volcomp::sim
