#include "firmware/node/node_cycle.hpp"

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

// CiA 402-2, table 33: operation enabled = xxxx xxxx x01x 0111b.
constexpr bool operation_enabled(std::uint16_t status_word) {
  return (status_word & 0x006FU) == 0x0027U;
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
  if (!operational) return;
  used_ = core_.used_axes();
  confirming_ = used_ & core_.confirming_axes();
  report(core_.configure(), core_.objects);
}

void NodeCycle::begin() {
  start_at_given_offsets();
  report_status();
}

// While offsets are being sent, the drive holds what it was sent last.
AbortCode NodeCycle::check_start(std::uint8_t sub) const {
  return sub != 0 && core_.gate[sub - 1U].open() ? AbortCode::device_state : AbortCode::none;
}

void NodeCycle::note_start(std::uint8_t sub) {
  start_given_ |= bit(sub - 1U);
  if (core_.operational()) start_at_given_offsets();
}

// Each counts for one start: later the drive holds what it was sent.
void NodeCycle::start_at_given_offsets() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    OffsetGate& gate = core_.gate[a];
    const bool given = core_.objects.confirms[a] == 0 && (start_given_ & bit(a)) != 0;
    if (given) gate.start_at(offset_to_wire(core_.objects.start_offset[a], gate.scale()));
  }
  start_given_ = 0;
}

void NodeCycle::forget_drive(std::uint8_t node) {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (core_.objects.drive[a] == node) core_.gate[a].forget();
  }
}

bool NodeCycle::at_rest() const {
  if (!core_.running) return true;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const OffsetGate& gate = core_.gate[a];
    if (core_.corrects(a) && gate.open() && gate.last() != 0) return false;
  }
  return true;
}

// --- cycle

std::uint64_t NodeCycle::deadline_after_sync_us() const {
  if (core_.objects.deadline_us != 0) return core_.objects.deadline_us;
  const std::uint32_t period = core_.objects.communication.cycle_period_us;
  return period / 5U * 3U + period % 5U * 3U / 5U;
}

void NodeCycle::sync(std::uint8_t counter, std::uint64_t now_us) {
  if (open_) {
    ++core_.objects.cycles_skipped;
    compute();
  }
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
  core_.emergency().raise(foreign ? ErrorCode::foreign_sync : ErrorCode::sync_length, 0);
}

void NodeCycle::arrived(std::uint32_t bits) {
  core_.arrived |= bits;
  const std::uint32_t held = axes_of(bits, Arrival::kHeld);
  for (std::size_t a = 0; held != 0 && a < kNodeAxes; ++a) {
    if ((held & bit(a)) != 0) core_.gate[a].report(core_.objects.held_offset[a]);
  }
  if (open_ && complete()) compute();
}

void NodeCycle::due(std::uint64_t now_us) {
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
  const std::uint16_t status = core_.objects.drive_status[axis];
  const std::uint16_t mask = core_.objects.homed_mask[axis];
  s.homed = operation_enabled(status) && (status & mask) == mask;
  const std::int32_t wire = from_actual ? core_.objects.actual[axis] : core_.objects.target[axis];
  s.position = position_[axis].update(wire, core_.gate[axis].scale());
  return s;
}

// From the offsets the drives hold, as soon as all of them are known.
bool NodeCycle::start_compensating() {
  if (!core_.compensator.active()) return false;
  PerAxis<std::int32_t> held{};
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (!core_.corrects(a)) continue;
    if (!core_.gate[a].open()) return false;
    held[a] = offset_from_wire(core_.gate[a].last(), core_.gate[a].scale());
  }
  const Status status = core_.compensator.start_from(held);
  if (!status.ok()) report(status, core_.objects);
  for (OffsetGate& gate : core_.gate)
    gate.join();
  return status.ok();
}

void NodeCycle::compute() {
  open_ = false;
  core_.objects.sync_counter = core_.open_counter;
  ++core_.objects.cycles;
  for (OffsetGate& gate : core_.gate)
    gate.begin_cycle();
  if (!core_.running) core_.running = start_compensating();
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    core_.input.axis[a] = sample(a);
  const std::int32_t learned = strokes_.tick();
  if (core_.running) {
    core_.compensator.tick(core_.input, output_);
    core_.objects.status = output_.status;
    for (std::size_t a = 0; a < kNodeAxes; ++a) {
      if (core_.corrects(a)) send_offset(a, learned);
      if (a < core_.objects.axes) report_axis_errors(a, output_.status[a]);
    }
  }
  report_status();
}

// `learned`: what the axis of a grinder gets in addition.
void NodeCycle::send_offset(std::size_t axis, std::int32_t learned) {
  std::int32_t value = 0;
  std::int32_t offset = output_.offset[axis];
  if (strokes_.learns_for(axis)) offset = limited(offset + learned, core_.objects.limit[axis]);
  const std::int32_t wanted = offset_to_wire(offset, core_.gate[axis].scale());
  if (core_.gate[axis].next(wanted, value)) {
    core_.objects.offset[axis] = value;
    core_.device.trigger(axis);
  } else {
    core_.device.withdraw(axis);
  }
}

// The first transmit PDOs are the offsets.
void NodeCycle::sent(std::size_t transmit_pdo) {
  if (transmit_pdo < kNodeAxes)
    core_.gate[transmit_pdo].handed_over(core_.objects.offset[transmit_pdo]);
}

void NodeCycle::raise_if(bool present, ErrorCode code, std::size_t axis, std::uint16_t status) {
  const auto source = static_cast<std::uint8_t>(axis + 1);
  const std::array<std::uint8_t, 4> detail{static_cast<std::uint8_t>(status),
                                           static_cast<std::uint8_t>(status >> 8U)};
  if (present) core_.emergency().raise(code, source, detail);
  if (!present && clean_cycles_[axis] >= kCleanCycles) core_.emergency().clear(code, source);
}

void NodeCycle::report_axis_errors(std::size_t axis, std::uint16_t status) {
  const bool silent = core_.corrects(axis) && !core_.gate[axis].open();
  const bool tripped = core_.gate[axis].tripped();
  const bool trouble = silent || tripped || (status & kAxisTrouble) != 0;
  if (!trouble && clean_cycles_[axis] > kCleanCycles) return;
  clean_cycles_[axis] =
      trouble ? std::uint16_t{0} : static_cast<std::uint16_t>(clean_cycles_[axis] + 1);
  const auto has = [status](std::uint16_t bits) { return (status & bits) != 0; };
  raise_if(has(kNotHomed), ErrorCode::axis_not_referenced, axis, status);
  raise_if(has(kStale) && !has(kImplausible), ErrorCode::rpdo_timeout, axis, status);
  raise_if(has(kImplausible), ErrorCode::axis_implausible, axis, status);
  raise_if(has(kFarOutOfRange), ErrorCode::axis_out_of_range, axis, status);
  raise_if(has(kClamped), ErrorCode::axis_clamped, axis, status);
  raise_if(has(kNoAuthority), ErrorCode::no_authority, axis, status);
  raise_if(silent, ErrorCode::offset_not_confirmed, axis, status);
  raise_if(tripped, ErrorCode::memory_damaged, axis, status);
}

// 2600h:01…03 and the status PDO that carries them, at most as often as its inhibit time allows.
void NodeCycle::report_status() {
  std::uint16_t any = 0;
  bool silent = false;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (a < core_.objects.axes) any = static_cast<std::uint16_t>(any | core_.objects.status[a]);
    silent = silent || (core_.corrects(a) && !core_.gate[a].open()) || core_.gate[a].tripped();
  }
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
