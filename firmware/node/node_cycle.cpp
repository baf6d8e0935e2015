#include "firmware/node/node_cycle.hpp"

#include "firmware/node/cia402_words.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;

namespace {

constexpr std::uint16_t kAxisTrouble = kNotHomed | kStale | kDropped | kImplausible |
                                       kFarOutOfRange | kClamped | kNoAuthority | kTableDamaged;
// An axis far beyond its table or at its limit is an alarm, but it is corrected as far as that
// goes: a controller that stopped for it could never drive it back.
constexpr auto kDegrading =
    static_cast<std::uint16_t>(kAxisTrouble & ~unsigned{kFarOutOfRange | kClamped});
constexpr std::uint16_t kCleanCycles = 100;  // before an error counts as gone

constexpr std::int32_t limited(std::int32_t offset, std::int32_t limit) {
  return offset > limit ? limit : offset < -limit ? -limit : offset;
}

static_assert(kForwardingIncomplete >> kStatusBits != 0, "no bit of an axis");

// 2^-32 turn in 2^-40 turn.
constexpr std::int64_t position_of(std::int32_t offset, bool rotary) {
  return std::int64_t{offset} * (rotary ? 256 : 1);
}

}  // namespace

// --- life

void NodeCycle::reset() {
  core_.running = open_ = core_.overdue = false;
  start_given_ = 0;
}

void NodeCycle::restart(bool operational) {
  core_.running = open_ = false;
  core_.arrived = 0;
  for (OffsetGate& gate : core_.gate)
    gate.forget();
  for (WirePosition& position : position_)
    position.reset();
  core_.objects.state = static_cast<std::uint8_t>(NodeState::idle);
  output_ = {};
  sync_us_ = 0;
  ahead_ = {};
  forwarding_.restart(operational);
  if (!operational) return;
  used_ = core_.used_axes();
  confirming_ = used_ & core_.confirming_axes();
  Status status = core_.configure();
  const Status ways = core_.check_ways();
  refused_ = !ways.ok();
  if (refused_) {
    status = ways;
    forwarding_.restart(false);
  }
  report(status, core_.objects);
}

void NodeCycle::begin() {
  start_at_given_offsets();
  report_status();
}

// While offsets are being sent, the drive holds what it was sent last.
AbortCode NodeCycle::check_start(std::uint8_t sub) const {
  if (sub == 0) return AbortCode::none;
  // Of a target in a drive neither it nor its offset is known: the controller has gone on.
  const bool forwarded = core_.way(sub - 1U) == Way::forwarded_target;
  return forwarded || core_.gate[sub - 1U].open() ? AbortCode::device_state : AbortCode::none;
}

void NodeCycle::note_start(std::uint8_t sub) {
  start_given_ |= bit(sub - 1U);
  if (core_.operational()) start_at_given_offsets();
}

// Each counts for one start: later the drive holds what it was sent.
void NodeCycle::start_at_given_offsets() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    OffsetGate& gate = core_.gate[a];
    const bool confirms = core_.way(a) == Way::offset && core_.objects.confirms[a] != 0;
    const bool given = !confirms && (start_given_ & bit(a)) != 0;
    if (given) gate.start_at(offset_to_wire(core_.objects.start_offset[a], gate.scale()));
  }
  start_given_ = 0;
}

// A drive that is silent goes on with the targets it is sent, and what the controller adds is not
// in the drive.
void NodeCycle::drive_gone(std::uint8_t node, bool booted) {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (core_.objects.drive[a] != node) continue;
    if (core_.way(a) == Way::offset) core_.gate[a].forget();
    if (booted) forwarding_.forget_mapping(a);
  }
}

bool NodeCycle::at_rest() const {
  if (drives_follow()) return false;
  if (!core_.running) return true;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const OffsetGate& gate = core_.gate[a];
    if (core_.corrects(a) && gate.open() && gate.last() != 0) return false;
  }
  return true;
}

// --- latency

void NodeCycle::before_read(canopen::ObjectId object) {
  if (object.index != object::latency_cycles.index) return;
  NodeObjects& o = core_.objects;
  o.latency_cycles = latency_.cycles();
  o.latency_least_us = latency_.least_us();
  o.latency_median_us = latency_.quantile_us(500);
  o.latency_most_us = latency_.quantile_us(999);
  o.latency_largest_us = latency_.largest_us();
  o.latency_targets_us = latency_.until_target_us();
}

// As it lies in memory: every target is little-endian, as CANopen is.
AbortCode NodeCycle::read_domain(canopen::ObjectId /*object*/,
                                 Span<const std::uint8_t>& source) const {
  const Latency::Histogram& bins = latency_.histogram();
  if (latency_.cycles() == 0) return AbortCode::no_data;
  source = {reinterpret_cast<const std::uint8_t*>(bins.data()), sizeof bins};
  return AbortCode::none;
}

// --- cycle

std::uint64_t NodeCycle::deadline_after_sync_us() const {
  if (core_.objects.deadline_us != 0) return core_.objects.deadline_us;
  const std::uint32_t period = core_.objects.communication.cycle_period_us;
  return period / 5U * 3U + period % 5U * 3U / 5U;
}

// Without a counter a second producer shows by the time alone. The drives take what they have at
// its SYNC, too.
bool NodeCycle::too_soon(std::uint64_t now_us) const {
  const canopen::CommunicationObjects& c = core_.objects.communication;
  return forwarding_.any() && c.sync_counter_overflow == 0 && sync_us_ != 0 &&
         now_us - sync_us_ < c.cycle_period_us / 2U;
}

void NodeCycle::sync(std::uint8_t counter, std::uint64_t now_us) {
  if (too_soon(now_us)) return bad_sync(canopen::SyncVerdict::foreign);
  sync_us_ = now_us;
  latency_.sync(now_us);
  if (open_) {
    ++core_.objects.cycles_skipped;
    compute();
  }
  forwarding_.end_cycle();
  probe_.end_cycle(counter);
  if (clean_syncs_ < kCleanCycles && ++clean_syncs_ == kCleanCycles) {
    core_.emergency().clear(ErrorCode::foreign_sync, 0);
    core_.emergency().clear(ErrorCode::sync_length, 0);
  }
  core_.open_counter = counter;
  core_.arrived = 0;
  open_ = true;
  deadline_us_ = now_us + deadline_after_sync_us();
}

void NodeCycle::bad_sync(canopen::SyncVerdict verdict) {
  clean_syncs_ = 0;
  const bool foreign = verdict == canopen::SyncVerdict::foreign;
  if (foreign) forwarding_.foreign_sync();
  core_.emergency().raise(foreign ? ErrorCode::foreign_sync : ErrorCode::sync_length, 0);
}

void NodeCycle::arrived(std::uint32_t bits, std::uint64_t now_us) {
  core_.arrived |= bits;
  if (axes_of(bits, Arrival::kTarget) != 0) latency_.target(now_us);
  const std::uint32_t held = axes_of(bits, Arrival::kHeld);
  for (std::size_t a = 0; held != 0 && a < kNodeAxes; ++a) {
    if ((held & bit(a)) != 0) core_.gate[a].report(core_.objects.held_offset[a]);
  }
  forwarding_.arrived(bits, !open_, now_us);
  if (open_ && complete()) compute();
}

void NodeCycle::due(std::uint64_t now_us) {
  forwarding_.watch_clock(now_us);
  if (!open_ || now_us < deadline_us_) return;
  ++core_.objects.deadline_missed;
  compute();
}

bool NodeCycle::complete() const {
  const std::uint32_t arrived = core_.arrived;
  const std::uint32_t moved =
      axes_of(arrived, Arrival::kTarget) & axes_of(arrived, Arrival::kActual);
  const std::uint32_t held = confirming_ & core_.correcting;
  return ((used_ & ~moved) | (held & ~axes_of(arrived, Arrival::kHeld))) == 0;
}

AxisSample NodeCycle::sample(std::size_t axis) {
  const bool from_actual =
      core_.objects.position_source == static_cast<std::uint8_t>(PositionSource::actual);
  const bool fresh =
      core_.has(Arrival::kActual, axis) && (from_actual || core_.has(Arrival::kTarget, axis));
  AxisSample s = core_.input.axis[axis];
  s.valid = fresh;
  if (!fresh) return s;
  s.homed = can_correct(axis);
  const std::int32_t wire = from_actual ? core_.objects.actual[axis] : core_.objects.target[axis];
  s.position = position_[axis].update(wire, core_.gate[axis].scale());
  s.valid = keeps_turn(axis);
  if (core_.way(axis) == Way::controller_adds) s.position = without_added(axis, s.position);
  return s;
}

// Enabled and referenced; a drive whose targets are forwarded must also follow them, and those that
// the controller corrects must have been seen disabled, or their offset is not known.
bool NodeCycle::can_correct(std::size_t axis) {
  const std::uint16_t status = core_.objects.drive_status[axis];
  const std::uint16_t mask = core_.objects.homed_mask[axis];
  const bool enabled = operation_enabled(status);
  OffsetGate& gate = core_.gate[axis];
  const bool added = core_.way(axis) == Way::controller_adds;
  if (added && !enabled && !gate.open()) gate.start_at(0);
  const bool follows = !forwarding_.has(axis) || forwarding_.takes_offset(axis);
  return follows && enabled && (status & mask) == mask;
}

// An axis that has lost its turn is dropped until it has been seen unreferenced.
bool NodeCycle::keeps_turn(std::size_t axis) {
  if (!position_[axis].lost()) return true;
  const std::uint16_t mask = core_.objects.homed_mask[axis];
  if ((core_.objects.drive_status[axis] & mask) != mask) position_[axis].reset();
  return false;
}

// A target that the controller has corrected: the compensator adds its offset to targets, so it is
// taken off.
std::int64_t NodeCycle::without_added(std::size_t axis, std::int64_t position) const {
  const bool targets =
      core_.objects.position_source == static_cast<std::uint8_t>(PositionSource::target);
  const bool rotary = core_.objects.rotary[axis] != 0;
  return position - (targets ? position_of(output_.offset[axis], rotary) : 0);
}

// From the offsets the drives hold, as soon as all of them are known.
bool NodeCycle::start_compensating() {
  if (!core_.compensator.active() || refused_) return false;
  PerAxis<std::int32_t> held{};
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (!core_.corrects(a)) continue;
    if (!core_.gate[a].open()) return false;
    held[a] = offset_from_wire(core_.gate[a].last(), core_.gate[a].scale());
  }
  const Status status = core_.compensator.start_from(held);
  if (status.ok()) {
    strokes_.start(held);
  } else {
    report(status, core_.objects);
  }
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    core_.gate[a].join();
    core_.gate[a].expect(offset_to_wire(held[a], core_.gate[a].scale()));
  }
  return status.ok();
}

void NodeCycle::compute() {
  open_ = false;
  core_.objects.sync_counter = core_.open_counter;
  ++core_.objects.cycles;
  for (OffsetGate& gate : core_.gate)
    gate.begin_cycle();
  forwarding_.judge();
  if (!core_.running) core_.running = start_compensating();
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    core_.input.axis[a] = sample(a);
  put_out();
  report_status();
}

void NodeCycle::put_out() {
  const std::int32_t learned = strokes_.tick();
  if (core_.running) {
    core_.compensator.tick(core_.input, output_);
    core_.objects.status = output_.status;
  }
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool forwards = forwarding_.has(a);
    const bool corrects = core_.running && core_.corrects(a);
    if (forwards) forwarding_.put_out(a, corrects ? wanted(a, learned) : 0);
    if (corrects && !forwards) send_offset(a, wanted(a, learned));
    if (forwards || (core_.running && a < core_.objects.axes))
      report_axis_errors(a, output_.status[a]);
  }
}

// In units of the drive. `learned`: what the axis of a grinder gets in addition.
std::int32_t NodeCycle::wanted(std::size_t axis, std::int32_t learned) {
  const std::int32_t limit = core_.objects.limit[axis];
  std::int32_t offset = output_.offset[axis];
  if (strokes_.learns_for(axis)) offset = strokes_.add(offset, learned);
  if (core_.way(axis) == Way::controller_adds) offset = limited(ahead_[axis].next(offset), limit);
  return offset_to_wire(offset, core_.gate[axis].scale());
}

void NodeCycle::send_offset(std::size_t axis, std::int32_t wanted) {
  std::int32_t value = 0;
  const std::size_t pdo = offset_pdo(core_.objects, axis);
  if (core_.gate[axis].next(wanted, value)) {
    core_.objects.offset[axis] = value;
    core_.device.trigger(pdo);
  } else {
    core_.device.withdraw(pdo);
  }
}

// The first transmit PDOs are those of the axes.
void NodeCycle::sent(std::size_t transmit_pdo) {
  if (transmit_pdo >= kNodeAxes) return;
  latency_.sent(core_.device.now_us());
  if (forwarding_.has(transmit_pdo)) return forwarding_.sent(transmit_pdo);
  for (std::size_t a = transmit_pdo; a < kNodeAxes; ++a) {
    const bool in_it = offset_pdo(core_.objects, a) == transmit_pdo;
    if (in_it) core_.gate[a].handed_over(core_.objects.offset[a]);
  }
}

bool NodeCycle::silent(std::size_t axis) const {
  if (forwarding_.has(axis)) return forwarding_.silent(axis);
  return core_.corrects(axis) && !core_.gate[axis].open();
}

void NodeCycle::raise_if(bool present, ErrorCode code, std::size_t axis, std::uint16_t status) {
  const auto source = static_cast<std::uint8_t>(axis + 1);
  const std::array<std::uint8_t, 4> detail{static_cast<std::uint8_t>(status),
                                           static_cast<std::uint8_t>(status >> 8U)};
  if (present) core_.emergency().raise(code, source, detail);
  if (!present && clean_cycles_[axis] >= kCleanCycles) core_.emergency().clear(code, source);
}

void NodeCycle::report_axis_errors(std::size_t axis, std::uint16_t status) {
  const bool silent = this->silent(axis);
  const bool cut = forwarding_.cut(axis);
  const bool tripped = core_.gate[axis].tripped();
  const bool jumped = core_.gate[axis].refused();
  const bool lost = position_[axis].lost();
  const bool late = forwarding_.late(axis);
  const bool trouble =
      lost || silent || cut || late || tripped || jumped || (status & kAxisTrouble) != 0;
  if (!trouble && clean_cycles_[axis] > kCleanCycles) return;
  clean_cycles_[axis] =
      trouble ? std::uint16_t{0} : static_cast<std::uint16_t>(clean_cycles_[axis] + 1);
  const auto has = [status](std::uint16_t bits) { return (status & bits) != 0; };
  raise_if(has(kNotHomed), ErrorCode::axis_not_referenced, axis, status);
  raise_if(has(kStale) && !has(kImplausible) && !lost, ErrorCode::rpdo_timeout, axis, status);
  raise_if(lost || has(kImplausible), ErrorCode::axis_implausible, axis, status);
  raise_if(has(kFarOutOfRange), ErrorCode::axis_out_of_range, axis, status);
  raise_if(cut || has(kClamped), ErrorCode::axis_clamped, axis, status);
  raise_if(has(kNoAuthority), ErrorCode::no_authority, axis, status);
  raise_if(late, ErrorCode::forwarded_late, axis, status);
  raise_if(silent, ErrorCode::offset_not_confirmed, axis, status);
  raise_if(tripped, ErrorCode::memory_damaged, axis, status);
  raise_if(jumped, ErrorCode::correction_jumped, axis, status);
}

// 2600h:01…03 and the status PDO that carries them, at most as often as its inhibit time allows.
void NodeCycle::report_status() {
  std::uint16_t any = 0;
  bool silent = false;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (a < core_.objects.axes) any = static_cast<std::uint16_t>(any | core_.objects.status[a]);
    silent = silent || this->silent(a) || core_.gate[a].goes_home();
  }
  if (forwarding_.incomplete()) any |= kForwardingIncomplete;
  NodeState state = NodeState::no_tables;
  if (core_.compensator.active()) {
    state = !core_.running ? NodeState::waiting : NodeState::compensating;
    if (core_.running && (silent || (any & kDegrading) != 0)) state = NodeState::degraded;
  }
  if (core_.overdue) state = NodeState::overdue;
  core_.objects.any_status = any;
  core_.objects.state = static_cast<std::uint8_t>(state);
  core_.device.trigger(kStatusPdo);
}

}  // namespace volcomp::node
