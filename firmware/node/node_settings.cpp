// Settings of the node: from objects to the compensator, the gates and the PDOs.

#include <algorithm>

#include "firmware/node/node.hpp"

namespace volcomp::node {

// Whose tables these are is asked where they are loaded: the number may change while the node
// rests.
Status Node::configure() {
  configure_gates();
  CompensatorSettings<kNodeAxes> s;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    // Less than a unit of the drive could never be corrected: a rate of 0 is refused.
    const bool too_slow = objects_.drive[a] != 0 && gate_[a].slew() < 1;
    const std::int32_t rate =
        too_slow ? 0 : OffsetGate::unhindered(objects_.slew[a], objects_.late_cycles);
    s.axis[a] = {objects_.limit[a], rate, std::min(rate, objects_.soft_rate[a]),
                 objects_.hysteresis[a], objects_.max_step[a]};
  }
  s.source = static_cast<PositionSource>(objects_.position_source);
  s.ramp_ticks = objects_.ramp_cycles;
  s.stale_drop_ticks = objects_.drop_cycles;
  return compensator_.configure(s);
}

void Node::configure_gates() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    scale_[a] = {objects_.scale_numerator[a], objects_.scale_denominator[a],
                 objects_.rotary[a] != 0};
    gate_[a].configure(step_to_wire(objects_.slew[a], scale_[a]), objects_.late_cycles,
                       objects_.drives_report != 0);
  }
}

// The predefined mappings are known to be good, so nothing can be refused here.
void Node::set_default_pdos() {
  for (std::size_t i = 0; i < kReceivePdos; ++i) {
    static_cast<void>(
        receive_[i].configure(default_receive_pdo(i, objects_.drive, objects_.controller),
                              canopen::PdoKind::receive, device_.objects()));
  }
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    static_cast<void>(
        transmit_[i].configure(default_transmit_pdo(i, objects_.drive, device_.node_id()),
                               canopen::PdoKind::transmit, device_.objects()));
  }
}

}  // namespace volcomp::node
