// The probe of the node: latches of the drives in, touches to the background, points out.

#include <utility>

#include "firmware/canopen/bytes.hpp"
#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;

namespace {

constexpr std::uint32_t bit(std::size_t axis) { return 1U << axis; }

std::int64_t position_from_wire(std::int32_t wire, const WireScale& scale) {
  WirePosition position;
  return position.update(wire, scale);
}

}  // namespace

// --- tick

// Everything of the cycle has arrived when the next SYNC comes.
void Node::end_probe_cycle(std::uint8_t next_counter) {
  const std::uint8_t overflow = objects_.communication.sync_counter_overflow;
  const bool wraps = next_counter == 1 && open_counter_ == overflow;
  const bool consecutive = overflow < 2 || wraps || next_counter == open_counter_ + 1;
  if (probes()) {
    for (std::size_t a = 0; a < kNodeAxes; ++a) {
      if (uses(a)) probe_.report(a, latch_report(a, consecutive));
    }
    probe_.end_cycle();
  }
  previous_actual_ = objects_.actual;
  had_actual_ = arrived_.actual;
}

// Speed: what the axis has travelled between the SYNC before the edge and the one after it.
LatchReport Node::latch_report(std::size_t axis, bool consecutive) const {
  LatchReport r;
  r.latched = (arrived_.latched & bit(axis)) != 0;
  r.counted = (arrived_.counted & bit(axis)) != 0;
  r.edge_count = objects_.edge_count[axis];
  const std::uint16_t mask = objects_.homed_mask[axis];
  r.homed = (objects_.drive_status[axis] & mask) == mask;
  r.moving = consecutive && (arrived_.actual & had_actual_ & bit(axis)) != 0;
  if (!r.latched) return r;
  r.time_ns = objects_.latch_time[axis];
  r.axis.position = position_from_wire(objects_.latched[axis], scale_[axis]);
  // Wraps by design: the difference of two unsigned counters.
  const auto moved = static_cast<std::int32_t>(static_cast<std::uint32_t>(objects_.actual[axis]) -
                                               static_cast<std::uint32_t>(previous_actual_[axis]));
  const double units = static_cast<double>(scale_[axis].numerator) / scale_[axis].denominator;
  const double period_s = objects_.communication.cycle_period_us * 1e-6;
  r.axis.velocity = moved * units / period_s;
  r.axis.direction = compensator_.direction(axis);
  if (moved != 0) r.axis.direction = moved > 0 ? Direction::forward : Direction::backward;
  return r;
}

// --- background

void Node::poll_probe() {
  if (device_.state() == canopen::NmtState::boot_up) return;
  if (probe_.work()) point_made();
}

// Whatever became of it: the process data say so, and an emergency when it was rejected.
void Node::point_made() {
  const ProbePoint& point = probe_.last();
  canopen::Emergency& emergency = device_.emergency();
  for (std::size_t part = 0; part < kPointPdos; ++part)
    device_.trigger(kFirstPointPdo + part);
  if (probe_.losing()) emergency.raise(ErrorCode::point_lost, 0);
  const bool rejected_before = std::exchange(touch_rejected_, !accepted(point.verdict));
  if (touch_rejected_) {
    std::array<std::uint8_t, 4> number{};
    canopen::store_le(number.data(), number.size(), point.sequence);
    emergency.raise(ErrorCode::touch_rejected, static_cast<std::uint8_t>(point.verdict), number);
  } else if (rejected_before) {
    for (std::uint8_t verdict = 0; verdict < kTouchVerdicts; ++verdict)
      emergency.clear(ErrorCode::touch_rejected, verdict);
  }
}

AbortCode Node::switch_probe(ProbeCommand command) {
  if (command == ProbeCommand::off) {
    probe_.switch_off();
    return AbortCode::none;
  }
  std::uint32_t axes = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    axes |= uses(a) ? bit(a) : 0U;
  const Status status = probe_.apply(axes, objects_.communication.cycle_period_us);
  return status.ok() ? AbortCode::none : AbortCode::invalid_value;
}

// The cycle period may have been taken away since it was switched on.
bool Node::probes() const { return probe_.on() && objects_.communication.cycle_period_us != 0; }

AbortCode Node::release_point(std::uint32_t sequence) {
  if (!probe_.points().release(sequence)) return AbortCode::invalid_value;
  probe_.released();
  device_.emergency().clear(ErrorCode::point_lost, 0);
  return AbortCode::none;
}

}  // namespace volcomp::node
