#include "firmware/node/forwarding.hpp"

#include <algorithm>

#include "firmware/node/cia402_words.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

namespace {

constexpr std::uint8_t kRestCycles = 100;  // of a standing axis, until its lag has gone

void count(std::uint32_t& counter) {
  if (counter < UINT32_MAX) ++counter;
}

}  // namespace

void Forwarding::restart(bool operational) {
  axes_ = 0;
  axis_ = {};
  waits_ = left_ = stepped_ = cut_ = late_ = 0;
  ended_ = starved_ = false;
  core_.emergency().clear(ErrorCode::forwarding_ended, 0);
  for (std::size_t a = 0; operational && a < kNodeAxes; ++a) {
    if (core_.objects.drive[a] != 0 && core_.way(a) == Way::forwarded_target) axes_ |= bit(a);
  }
  show_heartbeat();
}

bool Forwarding::drives_follow() const {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (follows(a)) return true;
  }
  return false;
}

bool Forwarding::takes_offset(std::size_t axis) const {
  return axis_[axis].phase == Phase::following && !axis_[axis].unmoved;
}

bool Forwarding::may_send(std::size_t axis) const {
  return !ended_ && axis_[axis].phase != Phase::unseen &&
         core_.objects.mapped_way[axis] == static_cast<std::uint8_t>(Way::forwarded_target);
}

bool Forwarding::silent(std::size_t axis) const {
  return has(axis) && (!may_send(axis) || axis_[axis].unmoved);
}

bool Forwarding::incomplete() const {
  bool some = false;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    some = some || (has(a) && (!may_send(a) || !core_.has(Arrival::kTarget, a)));
  return some;
}

// --- what a drive does

void Forwarding::see(std::size_t axis, bool follows) {
  Axis& x = axis_[axis];
  if (follows) {
    if (x.phase == Phase::ready) x.phase = Phase::beginning;
    return;
  }
  const std::uint64_t target_us = x.target_us;
  x = {};
  x.target_us = target_us;
  x.phase = Phase::ready;
  core_.gate[axis].start_at(0);
  core_.objects.offset[axis] = 0;
  core_.gate[axis].expect(0);
  if (core_.corrects(axis)) core_.compensator.begin_at_zero(axis);
  if ((waits_ & bit(axis)) != 0) add(axis);
}

// Homing in the drive reports "operation enabled", too, and takes no target: the mode counts.
void Forwarding::see_status(std::size_t axis) {
  axis_[axis].unclear = false;
  see(axis, operation_enabled(core_.objects.drive_status[axis]) &&
                core_.objects.drive_mode[axis] == kCyclicPosition);
}

// A status that is missing tells nothing, unless the controller has disabled the drive and enables
// it again meanwhile. To take the offset away as soon as it disables would be a step for a drive
// that lost that controlword.
void Forwarding::see_control(std::size_t axis) {
  const bool enables = enables_operation(core_.objects.control[axis]);
  if (enables && axis_[axis].unclear) see(axis, false);
  axis_[axis].unclear = !enables;
}

// The drive moves by the offset when the offset is in the target it takes: one that stands where
// the target of the controller is has another source of 607Ah. An internal limit (bit 11 of 6041h)
// keeps it off, too.
void Forwarding::listen(std::size_t axis) {
  Axis& x = axis_[axis];
  const NodeObjects& o = core_.objects;
  const std::int32_t offset = core_.gate[axis].last();
  const bool large = offset > core_.gate[axis].slew() || -offset > core_.gate[axis].slew();
  const bool still = core_.has(Arrival::kTarget, axis) && core_.has(Arrival::kActual, axis) &&
                     o.target[axis] == x.rest_target && large &&
                     !internally_limited(o.drive_status[axis]);
  x.rest_target = o.target[axis];
  if (!still) {
    x.rested = 0;
    return;
  }
  if (x.rested < kRestCycles) {
    ++x.rested;
    return;
  }
  // Wraps by design: the difference of two counters.
  const auto moved = static_cast<std::int32_t>(static_cast<std::uint32_t>(o.actual[axis]) -
                                               static_cast<std::uint32_t>(o.target[axis]));
  const std::int64_t twice = 2 * std::int64_t{moved};
  x.unmoved = x.unmoved || (offset > 0 ? twice < offset : twice > offset);
}

void Forwarding::arrived(std::uint32_t bits, bool at_once, std::uint64_t now_us) {
  const std::uint32_t reported = axes_of(bits, Arrival::kActual) & axes_;
  const std::uint32_t wanted = axes_of(bits, Arrival::kTarget) & axes_;
  for (std::size_t a = 0; (reported | wanted) != 0 && a < kNodeAxes; ++a) {
    if ((reported & bit(a)) != 0) see_status(a);
    if ((wanted & bit(a)) == 0) continue;
    see_control(a);
    axis_[a].target_us = now_us;
    if (at_once) send(a);
  }
}

bool Forwarding::known_stopped(std::size_t axis) const {
  const std::uint8_t drive = core_.objects.drive[axis];
  const canopen::HeartbeatConsumer& heartbeats = core_.device.heartbeats();
  return heartbeats.alive(drive) && heartbeats.state(drive) != canopen::NmtState::operational;
}

canopen::AbortCode Forwarding::check_mapping(std::size_t axis, std::uint8_t way) const {
  const bool doubtful = way != kNobody && has(axis) && known_stopped(axis);
  return doubtful ? canopen::AbortCode::device_state : canopen::AbortCode::none;
}

// 6064h was read at this SYNC, at which the drive took what had left before it.
void Forwarding::note_actual(std::size_t axis) {
  NodeObjects& o = core_.objects;
  o.actual_without_offset[axis] =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(o.actual[axis]) -
                                static_cast<std::uint32_t>(core_.gate[axis].last()));
}

void Forwarding::judge() {
  if (axes_ == 0) return;
  bool all_ready = true;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (!has(a)) continue;
    Axis& x = axis_[a];
    if (known_stopped(a)) forget_mapping(a);
    note_actual(a);
    if (core_.objects.mapped_way[a] != core_.objects.way[a]) lose(a);
    const unsigned window = 2U * core_.objects.late_cycles + 2U;
    if (x.phase == Phase::beginning && x.begun > window) x.phase = Phase::following;
    if (x.phase == Phase::following) listen(a);
    all_ready = all_ready && x.phase == Phase::ready;
  }
  if (!ended_ || !all_ready) return;
  ended_ = false;
  core_.emergency().clear(ErrorCode::forwarding_ended, 0);
  show_heartbeat();
}

// --- targets

void Forwarding::put_out(std::size_t axis, std::int32_t wanted) {
  stepped_ &= ~bit(axis);
  std::int32_t offset = 0;
  if (!core_.gate[axis].next(wanted, offset)) return;
  core_.objects.offset[axis] = offset;
  if (core_.has(Arrival::kTarget, axis)) send(axis);
}

// A rotary axis counts modulo 2^32, as 6064h does.
void Forwarding::add(std::size_t axis) {
  NodeObjects& o = core_.objects;
  const std::int64_t sum = std::int64_t{o.target[axis]} + o.offset[axis];
  const std::int64_t inside =
      std::max<std::int64_t>(INT32_MIN, std::min<std::int64_t>(INT32_MAX, sum));
  cut_ &= ~bit(axis);
  if (core_.gate[axis].scale().rotary) {
    o.forwarded_target[axis] = static_cast<std::int32_t>(static_cast<std::uint32_t>(sum));
  } else {
    o.forwarded_target[axis] = static_cast<std::int32_t>(inside);
    if (inside != sum) cut_ |= bit(axis);
  }
}

void Forwarding::send(std::size_t axis) {
  if (!may_send(axis)) return;
  add(axis);
  waits_ |= bit(axis);
  if ((unconfirmed_ & bit(axis)) == 0) core_.device.trigger(axis);
}

void Forwarding::unconfirmed(std::uint32_t axes) {
  const std::uint32_t released = waits_ & unconfirmed_ & ~axes;
  unconfirmed_ = axes;
  for (std::size_t a = 0; released != 0 && a < kNodeAxes; ++a) {
    if ((released & bit(a)) != 0) core_.device.trigger(a);
  }
}

void Forwarding::sent(std::size_t axis) {
  waits_ &= ~bit(axis);
  left_ |= bit(axis);
  if ((stepped_ & bit(axis)) != 0) return;
  stepped_ |= bit(axis);
  Axis& x = axis_[axis];
  if (x.phase == Phase::beginning) ++x.begun;
  core_.gate[axis].handed_over(core_.objects.offset[axis]);
}

void Forwarding::withdraw(std::size_t axis) {
  waits_ &= ~bit(axis);
  core_.device.withdraw(axis);
}

void Forwarding::miss(std::size_t axis) {
  count(core_.objects.not_forwarded);
  if ((waits_ & bit(axis)) == 0) return;  // none came: as without this node
  ++axis_[axis].missed;
}

// The drive has taken the one before it once more.
void Forwarding::be_late(std::size_t axis) {
  late_ |= bit(axis);
  count(core_.objects.forwarded_late);
  ++axis_[axis].missed;
}

void Forwarding::end_cycle() {
  bool stood_still = false;
  late_ = 0;
  for (std::size_t a = 0; axes_ != 0 && a < kNodeAxes; ++a) {
    if (!has(a)) continue;
    const bool left = (left_ & bit(a)) != 0 && (waits_ & bit(a)) == 0;
    const bool late = left && (unconfirmed_ & bit(a)) != 0;
    if (left && !late) axis_[a].missed = 0;
    if (late && follows(a)) be_late(a);
    if (!left && follows(a)) miss(a);
    stood_still = stood_still || axis_[a].missed > core_.objects.late_cycles;
    if ((waits_ & bit(a)) != 0) withdraw(a);
  }
  left_ = 0;
  if (stood_still) end();
}

// --- ends

void Forwarding::lose(std::size_t axis) {
  axis_[axis].phase = Phase::unseen;
  core_.gate[axis].forget();
  withdraw(axis);
}

void Forwarding::forget_mapping(std::size_t axis) {
  core_.objects.mapped_way[axis] = kNobody;
  if (has(axis)) lose(axis);
}

void Forwarding::end() {
  if (!drives_follow()) return;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (has(a)) lose(a);
  }
  ended_ = true;
  core_.emergency().raise(ErrorCode::forwarding_ended, 0);
  show_heartbeat();
}

void Forwarding::watch_clock(std::uint64_t now_us) {
  bool starved = false;
  const std::uint64_t patience_us =
      std::uint64_t{core_.objects.drop_cycles} * core_.objects.communication.cycle_period_us;
  for (std::size_t a = 0; axes_ != 0 && core_.objects.options != 0 && a < kNodeAxes; ++a)
    starved = starved || (follows(a) && now_us - axis_[a].target_us > patience_us);
  if (starved == starved_) return;
  starved_ = starved;
  show_heartbeat();
}

// Drives and controller that watch it act when it stops.
void Forwarding::show_heartbeat() { core_.device.hold_heartbeat(ended_ || starved_); }

}  // namespace volcomp::node
