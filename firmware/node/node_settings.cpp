// Settings of the node: from objects to the compensator, the gates and the PDOs.

#include <algorithm>
#include <cstring>

#include "firmware/node/node_core.hpp"
#include "firmware/node/object_handles.hpp"

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
    confirming |= objects.confirms[a] != 0 && way(a) == Way::offset ? bit(a) : 0U;
  return confirming;
}

namespace {

// Those that take offsets of any kind, a bit each.
std::uint32_t correcting_axes(const RuntimeChain& chain) {
  std::uint32_t correcting = 0;
  for (std::size_t c = 0; c < chain.correcting_count; ++c)
    correcting |= bit(chain.correcting[c]);
  if constexpr (kOrientsTool) {
    for (std::size_t o = 0; o < chain.orienting_count; ++o)
      correcting |= bit(chain.orienting[o]);
  }
  return correcting;
}

WireScale scale_of(const NodeObjects& objects, std::size_t axis) {
  const bool rotary = objects.rotary[axis] != 0;
  return {objects.scale_numerator[axis], objects.scale_denominator[axis], rotary,
          rotary ? objects.units_per_turn[axis] : 0};
}

// What the compensator promises, in units of the drive. Rounding moves an offset by up to half a
// unit, so a step by up to one and its change by up to two. Looking ahead adds the smaller of the
// last two steps, which changes by up to the acceleration, and is clamped to the limit.
void check_motion(GateBounds& bounds, const OffsetBounds& promised, Way way) {
  std::int32_t rate = promised.rate;
  std::int32_t acceleration = promised.acceleration;
  if (way == Way::controller_adds) {
    rate += 2 * acceleration;
    acceleration *= 5;
  }
  bounds.rate = std::min(bound_to_wire(rate, bounds.scale), kMostHeld - 1) + 1;
  bounds.acceleration = std::min(bound_to_wire(acceleration, bounds.scale), kMostHeld - 2) + 2;
}

}  // namespace

void NodeCore::note_machine() { correcting = correcting_axes(compensator.machine().chain); }

// Less than a unit of the drive could never be corrected: a rate of 0 is refused.
OffsetLimits NodeCore::limits(std::size_t a) const {
  const bool too_slow =
      objects.drive[a] != 0 && step_to_wire(objects.slew[a], scale_of(objects, a)) < 1;
  const std::int32_t rate =
      too_slow ? 0 : OffsetGate::unhindered(objects.slew[a], objects.late_cycles);
  return {objects.limit[a], rate, std::min(rate, objects.soft_rate[a]), objects.acceleration[a]};
}

// The machine id is checked at load time, because it may be changed while stopped.
Status NodeCore::configure() {
  CompensatorSettings<kNodeAxes> s;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    AxisLimits& l = s.axis[a];
    static_cast<OffsetLimits&>(l) = limits(a);
    l.hysteresis = objects.hysteresis[a];
    l.max_step = objects.max_step[a];
  }
  s.source = static_cast<PositionSource>(objects.position_source);
  s.ramp_ticks = objects.ramp_cycles;
  s.stale_drop_ticks = objects.drop_cycles;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    configure_gate(a, s.axis[a]);
  return compensator.configure(s);
}

void NodeCore::configure_gate(std::size_t a, const OffsetLimits& limits) {
  GateBounds bounds;
  bounds.scale = scale_of(objects, a);
  bounds.limit = offset_to_wire(objects.limit[a], bounds.scale);
  bounds.slew = step_to_wire(objects.slew[a], bounds.scale);
  bounds.soft = std::max<std::int32_t>(1, step_to_wire(objects.soft_rate[a], bounds.scale));
  bounds.late = objects.late_cycles;
  bounds.reports = way(a) == Way::offset ? objects.confirms[a] : std::uint8_t{0};
  if (!limits.accelerates_freely()) check_motion(bounds, OffsetBounds(limits), way(a));
  gate[a].configure(bounds);
}

// The predefined mappings are known to be good, so nothing can be refused here.
void NodeCore::set_default_receive_pdos(std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    static_cast<void>(receive[i].configure(default_receive_pdo(i, objects),
                                           canopen::PdoKind::receive, device.objects()));
  }
}

void NodeCore::set_default_transmit_pdos(std::size_t end) {
  for (std::size_t i = 0; i < end; ++i) {
    static_cast<void>(transmit[i].configure(default_transmit_pdo(i, objects, device.node_id()),
                                            canopen::PdoKind::transmit, device.objects()));
  }
}

void NodeCore::set_default_pdos() {
  set_default_receive_pdos(0, kReceivePdos);
  set_default_transmit_pdos(kTransmitPdos);
}

void NodeCore::set_default_axis_pdos(std::size_t axis) {
  for (std::size_t i = axis; i < kProcessStatePdo; i += kNodeAxes)
    set_default_receive_pdos(i, i + 1);
  set_default_transmit_pdos(kNodeAxes);
}

// --- ways

// Whether a frame with this object is taken at once: a synchronous one waits for the next SYNC.
bool NodeCore::hears(canopen::ObjectId object) const {
  for (const canopen::Pdo& pdo : receive) {
    if (!pdo.valid() || pdo.synchronous()) continue;
    for (std::size_t i = 0; i < pdo.parameters().count; ++i) {
      if (canopen::object_of(pdo.parameters().mapping[i]) == object) return true;
    }
  }
  return false;
}

// A target must be heard and be sent in its cycle, and no other time may send an old one. The mode
// tells whether the drive follows targets at all. 1029h = 1: a heartbeat of the controller that is
// only late must not stop the axis.
bool NodeCore::can_forward(std::size_t axis) const {
  const bool hears_all = hears(object::target[axis].id()) && hears(object::control[axis].id()) &&
                         hears(object::drive_status[axis].id()) &&
                         hears(object::drive_mode[axis].id());
  const canopen::Pdo& out = transmit[axis];
  const canopen::PdoParameters& p = out.parameters();
  const bool in_time =
      out.valid() && !out.synchronous() && p.inhibit_100us == 0 && p.event_timer_ms == 0;
  const auto same = std::count(objects.drive.begin(), objects.drive.end(), objects.drive[axis]);
  return hears_all && in_time && same == 1 &&
         objects.communication.error_behaviour ==
             static_cast<std::uint8_t>(canopen::ErrorBehaviour::no_change);
}

namespace {

Status refuse_axis(Reason reason, std::size_t axis, const RuntimeChain& chain) {
  Where where;
  where.index = static_cast<int>(axis);
  where.axis = chain.letter[axis];
  return refuse(reason, where);
}

}  // namespace

Status NodeCore::check_way_of(const RuntimeChain& chain) const {
  const std::uint32_t corrected = correcting_axes(chain);
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool drive = objects.drive[a] != 0;
    if (drive && way(a) == Way::none && (corrected & bit(a)) != 0)
      return refuse_axis(Reason::no_way, a, chain);
  }
  return {};
}

Status NodeCore::check_ways() const {
  const RuntimeChain& chain = compensator.machine().chain;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool forwards = objects.drive[a] != 0 && way(a) == Way::forwarded_target;
    if (forwards && !can_forward(a)) return refuse_axis(Reason::bad_setting, a, chain);
  }
  return check_way_of(chain);
}

}  // namespace volcomp::node
