// Settings of the node: from objects to the compensator, the gates and the PDOs.

#include <algorithm>
#include <cstring>

#include "firmware/node/node_core.hpp"

namespace volcomp::node {

NodeCore::NodeCore(Node& node, std::uint8_t node_id, Preemption* allowed)
    : preemption(allowed),
      device({node_dictionary(),
              &objects.communication,
              {receive.data(), receive.size()},
              {transmit.data(), transmit.size()},
              {kCycleReceivePdos, kNodeAxes}},
             node) {
  device.set_node_id(node_id);
}

void report(const Status& status, NodeObjects& objects) {
  const Where& where = status.where;
  objects.reason = static_cast<std::uint8_t>(status.reason);
  objects.where_axis = static_cast<std::uint8_t>(where.axis);
  objects.where_index = static_cast<std::int16_t>(where.index);
  objects.where_channel = static_cast<std::int8_t>(where.channel);
  objects.reason_text = {};
  if constexpr (kWritesSentences) {
    if (const char* const text = loading_sentence(status.reason); text != nullptr)
      std::strncpy(objects.reason_text.data(), text, objects.reason_text.size() - 1);
  }
}

std::uint32_t NodeCore::used_axes() const {
  std::uint32_t used = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    used |= objects.drive[a] != 0 ? bit(a) : 0U;
  return used;
}

std::uint32_t NodeCore::confirming_axes() const {
  std::uint32_t confirming = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    confirming |= objects.confirms[a] != 0 ? bit(a) : 0U;
  return confirming;
}

void NodeCore::note_machine() {
  const RuntimeChain& chain = compensator.machine().chain;
  correcting = 0;
  for (std::size_t c = 0; c < chain.correcting_count; ++c)
    correcting |= bit(chain.correcting[c]);
  if constexpr (kOrientsTool) {
    for (std::size_t o = 0; o < chain.orienting_count; ++o)
      correcting |= bit(chain.orienting[o]);
  }
}

// The machine id is checked at load time, because it may be changed while stopped.
Status NodeCore::configure() {
  configure_gates();
  CompensatorSettings<kNodeAxes> s;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    // Less than a unit of the drive could never be corrected: a rate of 0 is refused.
    const bool too_slow = objects.drive[a] != 0 && gate[a].slew() < 1;
    const std::int32_t rate =
        too_slow ? 0 : OffsetGate::unhindered(objects.slew[a], objects.late_cycles);
    s.axis[a] = {objects.limit[a], rate, std::min(rate, objects.soft_rate[a]),
                 objects.hysteresis[a], objects.max_step[a]};
  }
  s.source = static_cast<PositionSource>(objects.position_source);
  s.ramp_ticks = objects.ramp_cycles;
  s.stale_drop_ticks = objects.drop_cycles;
  return compensator.configure(s);
}

void NodeCore::configure_gates() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    GateBounds bounds;
    bounds.scale = {objects.scale_numerator[a], objects.scale_denominator[a],
                    objects.rotary[a] != 0};
    bounds.limit = offset_to_wire(objects.limit[a], bounds.scale);
    bounds.slew = step_to_wire(objects.slew[a], bounds.scale);
    bounds.soft = std::max<std::int32_t>(1, step_to_wire(objects.soft_rate[a], bounds.scale));
    bounds.late = objects.late_cycles;
    bounds.reports = objects.confirms[a];
    gate[a].configure(bounds);
  }
}

// The predefined mappings are known to be good, so nothing can be refused here.
void NodeCore::set_default_receive_pdos(std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    static_cast<void>(receive[i].configure(default_receive_pdo(i, objects),
                                           canopen::PdoKind::receive, device.objects()));
  }
}

void NodeCore::set_default_pdos() {
  set_default_receive_pdos(0, kReceivePdos);
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    static_cast<void>(
        transmit[i].configure(default_transmit_pdo(i, objects.drive, device.node_id()),
                              canopen::PdoKind::transmit, device.objects()));
  }
}

}  // namespace volcomp::node
