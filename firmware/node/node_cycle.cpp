// The cycle of the node: SYNC, process data in, one tick, offsets out.

#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

namespace {

constexpr std::uint16_t kAxisTrouble = kNotHomed | kStale | kDropped | kImplausible |
                                       kFarOutOfRange | kClamped | kNoAuthority | kTableDamaged;
// An axis far beyond its table or at its limit is an alarm, but it is corrected as far as that
// goes: a controller that stopped for it could never drive it back.
constexpr auto kDegrading =
    static_cast<std::uint16_t>(kAxisTrouble & ~unsigned{kFarOutOfRange | kClamped});
constexpr std::uint16_t kCleanCycles = 100;  // before an error counts as gone

constexpr std::uint32_t bit(std::size_t axis) { return 1U << axis; }

[[maybe_unused]] constexpr std::int32_t limited(std::int32_t offset, std::int32_t limit) {
  return offset > limit ? limit : offset < -limit ? -limit : offset;
}

// CiA 402-2, table 33: operation enabled = xxxx xxxx x01x 0111b.
constexpr bool operation_enabled(std::uint16_t status_word) {
  return (status_word & 0x006FU) == 0x0027U;
}

}  // namespace

std::uint64_t Node::deadline_after_sync_us() const {
  if (objects_.deadline_us != 0) return objects_.deadline_us;
  const std::uint32_t period = objects_.communication.cycle_period_us;
  return period / 5U * 3U + period % 5U * 3U / 5U;
}

void Node::sync(std::uint8_t counter, std::uint64_t now_us) {
  if (cycle_open_) {
    ++objects_.cycles_skipped;
    compute(now_us);
  }
  end_probe_cycle(counter);
  if (clean_syncs_ < kCleanCycles && ++clean_syncs_ == kCleanCycles) {
    device_.emergency().clear(ErrorCode::foreign_sync, 0);
    device_.emergency().clear(ErrorCode::sync_length, 0);
  }
  open_counter_ = counter;
  arrived_ = {};
  cycle_open_ = true;
  deadline_us_ = now_us + deadline_after_sync_us();
}

void Node::received(const canopen::Pdo& pdo, std::uint64_t now_us) {
  const canopen::PdoParameters& p = pdo.parameters();
  for (std::size_t i = 0; i < p.count; ++i) {
    const canopen::ObjectId object = canopen::object_of(p.mapping[i]);
    const std::size_t axis = object.sub - 1U;
    if (object.index == 0x2011) arrived_.target |= bit(axis);
    if (object.index == 0x2014) arrived_.actual |= bit(axis);
    if (object.index == 0x2017) arrived_.latched |= bit(axis);
    if (object.index == 0x2019) arrived_.counted |= bit(axis);
    if constexpr (kWatchesStrokes) {
      if (object.index == 0x201A) arrived_.process_state = true;
    }
    thermal_.arrived(object);
    if (object.index != 0x2016) continue;
    arrived_.held |= bit(axis);
    gate_[axis].report(objects_.held_offset[axis]);
  }
  if (cycle_open_ && complete()) compute(now_us);
}

std::uint32_t Node::correcting_axes() const {
  const RuntimeChain& chain = compensator_.machine().chain;
  std::uint32_t axes = 0;
  for (std::size_t c = 0; c < chain.correcting_count; ++c)
    axes |= bit(chain.correcting[c]);
  if constexpr (kOrientsTool) {
    for (std::size_t o = 0; o < chain.orienting_count; ++o)
      axes |= bit(chain.orienting[o]);
  }
  return axes;
}

bool Node::complete() const {
  std::uint32_t used = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    used |= uses(a) ? bit(a) : 0U;
  const std::uint32_t held = objects_.drives_report != 0 ? used & correcting_axes() : 0U;
  return (used & ~arrived_.target) == 0 && (used & ~arrived_.actual) == 0 &&
         (held & ~arrived_.held) == 0;
}

AxisSample Node::sample(std::size_t axis) {
  const bool from_actual =
      objects_.position_source == static_cast<std::uint8_t>(PositionSource::actual);
  const bool fresh =
      (arrived_.actual & bit(axis)) != 0 && (from_actual || (arrived_.target & bit(axis)) != 0);
  AxisSample s = input_.axis[axis];
  s.valid = fresh;
  if (!fresh) return s;
  const std::uint16_t status = objects_.drive_status[axis];
  const std::uint16_t mask = objects_.homed_mask[axis];
  s.homed = operation_enabled(status) && (status & mask) == mask;
  const std::int32_t wire = from_actual ? objects_.actual[axis] : objects_.target[axis];
  s.position = position_[axis].update(wire, scale_[axis]);
  return s;
}

// From the offsets the drives hold, as soon as all of them are known.
bool Node::start_compensating() {
  if (!compensator_.active()) return false;
  const std::uint32_t correcting = correcting_axes();
  PerAxis<std::int32_t> held{};
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if ((correcting & bit(a)) == 0) continue;
    if (!gate_[a].open()) return false;
    held[a] = offset_from_wire(gate_[a].last(), scale_[a]);
  }
  const Status status = compensator_.start_from(held);
  if (!status.ok()) report(status, objects_);
  return status.ok();
}

void Node::compute(std::uint64_t /*now_us*/) {
  cycle_open_ = false;
  objects_.sync_counter = open_counter_;
  ++objects_.cycles;
  const std::uint32_t correcting = correcting_axes();
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    gate_[a].begin_cycle();
  if (!running_) running_ = start_compensating();
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    input_.axis[a] = sample(a);
  std::int32_t learned = 0;
  if constexpr (kWatchesStrokes) learned = tick_strokes();
  if (running_) {
    compensator_.tick(input_, output_);
    objects_.status = output_.status;
    for (std::size_t a = 0; a < kNodeAxes; ++a) {
      if ((correcting & bit(a)) != 0) send_offset(a, learned);
      if (a < objects_.axes) report_axis_errors(a, output_.status[a]);
    }
  }
  report_status();
}

// `learned`: what the axis of a grinder gets in addition.
void Node::send_offset(std::size_t axis, [[maybe_unused]] std::int32_t learned) {
  std::int32_t value = 0;
  std::int32_t offset = output_.offset[axis];
  if constexpr (kWatchesStrokes) {
    if (learns_for(axis)) offset = limited(offset + learned, objects_.limit[axis]);
  }
  const std::int32_t wanted = offset_to_wire(offset, scale_[axis]);
  if (gate_[axis].next(wanted, value)) {
    objects_.offset[axis] = value;
    device_.trigger(axis);
  } else {
    device_.withdraw(axis);
  }
}

void Node::raise_if(bool present, ErrorCode code, std::size_t axis, std::uint16_t status) {
  const auto source = static_cast<std::uint8_t>(axis + 1);
  const std::array<std::uint8_t, 4> detail{static_cast<std::uint8_t>(status),
                                           static_cast<std::uint8_t>(status >> 8U)};
  if (present) device_.emergency().raise(code, source, detail);
  if (!present && clean_cycles_[axis] >= kCleanCycles) device_.emergency().clear(code, source);
}

void Node::report_axis_errors(std::size_t axis, std::uint16_t status) {
  const bool silent = (correcting_axes() & bit(axis)) != 0 && !gate_[axis].open();
  const bool trouble = silent || (status & kAxisTrouble) != 0;
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
}

// 2600h:01…03 and the status PDO that carries them, at most as often as its inhibit time allows.
void Node::report_status() {
  std::uint16_t any = 0;
  bool silent = false;
  const std::uint32_t correcting = correcting_axes();
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (a < objects_.axes) any = static_cast<std::uint16_t>(any | objects_.status[a]);
    silent = silent || ((correcting & bit(a)) != 0 && !gate_[a].open());
  }
  NodeState state = NodeState::no_tables;
  if (compensator_.active()) {
    state = !running_ ? NodeState::waiting : NodeState::compensating;
    if (running_ && (silent || (any & kDegrading) != 0)) state = NodeState::degraded;
  }
  if (overdue_) state = NodeState::overdue;
  objects_.any_status = any;
  objects_.state = static_cast<std::uint8_t>(state);
  device_.trigger(kStatusPdo);
}

}  // namespace volcomp::node
