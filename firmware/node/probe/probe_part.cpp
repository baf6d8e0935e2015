#include "firmware/node/probe/probe_part.hpp"

#include <algorithm>
#include <utility>

#include "comp/core/bytes.hpp"
#include "firmware/node/object_handles.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;

namespace {

constexpr canopen::ObjectId kProbe = object::probe::command.id();
constexpr canopen::ObjectId kFeature = object::probe::feature.id();
constexpr canopen::ObjectId kGear = object::probe::gear.id();
constexpr canopen::ObjectId kRelease = object::probe::release.id();

std::int64_t position_from_wire(std::int32_t wire, const WireScale& scale) {
  WirePosition position;
  return position.update(wire, scale);
}

}  // namespace

TouchProbe::TouchProbe(NodeCore& core)
    : core_(core), path_(core.objects.probe, core.compensator, core.preemption) {}

void TouchProbe::restart(bool operational) {
  had_actual_ = stored_ = 0;
  edges_counted_ = {};
  path_.restart();
  const auto command = static_cast<ProbeCommand>(core_.objects.probe.command);
  if (operational && command == ProbeCommand::on) static_cast<void>(switch_to(command));
}

// --- tick

void TouchProbe::end_cycle(std::uint8_t next_counter) {
  const std::uint8_t overflow = core_.objects.communication.sync_counter_overflow;
  const bool wraps = next_counter == 1 && core_.open_counter == overflow;
  const bool consecutive = overflow < 2 || wraps || next_counter == core_.open_counter + 1;
  if (probes()) {
    for (std::size_t a = 0; a < kNodeAxes; ++a) {
      if (core_.objects.drive[a] == 0) continue;
      LatchReport report = latch_report(a, consecutive);
      if ((uncounted_ & bit(a)) != 0) count_edge(a, report);
      path_.report(a, report);
    }
    path_.end_cycle();
  }
  previous_actual_ = core_.objects.actual;
  had_actual_ = axes_of(core_.arrived, Arrival::kActual);
}

// Speed: what the axis has travelled between the SYNC before the edge and the one after it.
LatchReport TouchProbe::latch_report(std::size_t axis, bool consecutive) const {
  LatchReport r;
  r.latched = core_.has(Arrival::kLatched, axis);
  r.counted = core_.has(Arrival::kCounted, axis);
  r.edge_count = core_.objects.edge_count[axis];
  const std::uint16_t mask = core_.objects.homed_mask[axis];
  r.homed = (core_.objects.drive_status[axis] & mask) == mask;
  r.moving = consecutive && core_.has(Arrival::kActual, axis) && (had_actual_ & bit(axis)) != 0;
  if (!r.latched) return r;
  r.time_ns = core_.objects.latch_time[axis];
  r.axis.position = position_from_wire(core_.objects.latched[axis], core_.gate[axis].scale());
  // Wraps by design: the difference of two unsigned counters.
  const auto moved =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(core_.objects.actual[axis]) -
                                static_cast<std::uint32_t>(previous_actual_[axis]));
  const double period_s = core_.objects.communication.cycle_period_us * 1e-6;
  r.axis.velocity = moved * units_per_wire(core_.gate[axis].scale()) / period_s;
  r.axis.direction = core_.compensator.direction(axis);
  if (moved != 0) r.axis.direction = moved > 0 ? Direction::forward : Direction::backward;
  return r;
}

// A drive without 60D5h: an edge is a rise of "positive edge stored" in 60B9h, or a latch where
// that word does not come every cycle.
void TouchProbe::count_edge(std::size_t axis, LatchReport& report) {
  constexpr std::uint16_t kPositiveStored = 1U << 1U;
  bool edge = report.latched;
  if ((flagged_ & bit(axis)) != 0) {
    if (!core_.has(Arrival::kActual, axis)) return;
    const bool stored = (core_.objects.probe_status[axis] & kPositiveStored) != 0;
    edge = stored && (stored_ & bit(axis)) == 0;
    stored_ = stored ? stored_ | bit(axis) : stored_ & ~bit(axis);
  }
  if (edge) ++edges_counted_[axis];
  report.counted = true;
  report.edge_count = edges_counted_[axis];
}

// Whether one of these RPDOs brings an object.
bool TouchProbe::hears(std::size_t first, std::size_t end, std::uint32_t mapped) const {
  for (std::size_t i = first; i < end; ++i) {
    const canopen::Pdo& pdo = core_.receive[i];
    const canopen::PdoParameters& p = pdo.parameters();
    for (std::size_t k = 0; pdo.valid() && k < p.count; ++k) {
      if (p.mapping[k] == mapped) return true;
    }
  }
  return false;
}

void TouchProbe::note_what_is_told() {
  untimed_ = uncounted_ = flagged_ = 0;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (core_.objects.drive[a] == 0) continue;
    if (!hears(0, kCycleReceivePdos, object::latch_time[a].mapped())) untimed_ |= bit(a);
    if (!hears(0, kCycleReceivePdos, object::edge_count[a].mapped())) uncounted_ |= bit(a);
    const std::size_t actual = kNodeAxes + a;
    if (hears(actual, actual + 1, object::probe_status[a].mapped())) flagged_ |= bit(a);
  }
}

// The cycle period may have been taken away since it was switched on.
bool TouchProbe::probes() const {
  return path_.on() && core_.objects.communication.cycle_period_us != 0;
}

// --- background

void TouchProbe::background(std::uint64_t /*now_us*/) {
  if (!core_.booting() && path_.work()) report_point();
}

// A point goes into the process data whatever became of it, a rejected one is an emergency, too.
void TouchProbe::report_point() {
  const ProbePoint& point = path_.last();
  canopen::Emergency& emergency = core_.emergency();
  for (std::size_t part = 0; part < kPointPdos; ++part)
    core_.device.trigger(kFirstPointPdo + part);
  if (path_.losing()) emergency.raise(ErrorCode::point_lost, 0);
  const bool rejected_before = std::exchange(touch_rejected_, !accepted(point.verdict));
  if (touch_rejected_) {
    std::array<std::uint8_t, 4> number{};
    store_le(number.data(), number.size(), point.sequence);
    emergency.raise(ErrorCode::touch_rejected, static_cast<std::uint8_t>(point.verdict), number);
  } else if (rejected_before) {
    for (std::uint8_t verdict = 0; verdict < kTouchVerdicts; ++verdict)
      emergency.clear(ErrorCode::touch_rejected, verdict);
  }
}

// --- objects

AbortCode TouchProbe::check_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
  if (object == kProbe) return switch_to(static_cast<ProbeCommand>(bytes[0]));
  const auto number = static_cast<std::uint32_t>(
      load_le(bytes.data(), std::min(bytes.size(), sizeof(std::uint32_t))));
  if (object == kRelease) return release_point(number);
  Reason why = Reason::ok;
  if (object == kGear) why = path_.load_gear(number);
  if (object == kFeature) why = path_.take_feature(number);
  return why == Reason::ok ? AbortCode::none : AbortCode::invalid_value;
}

AbortCode TouchProbe::switch_to(ProbeCommand command) {
  if (command == ProbeCommand::off) {
    path_.switch_off();
    return AbortCode::none;
  }
  note_what_is_told();
  const Status status =
      path_.apply(core_.used_axes(), untimed_, core_.objects.communication.cycle_period_us);
  return status.ok() ? AbortCode::none : AbortCode::invalid_value;
}

AbortCode TouchProbe::release_point(std::uint32_t sequence) {
  if (!path_.points().release(sequence)) return AbortCode::invalid_value;
  path_.released();
  core_.emergency().clear(ErrorCode::point_lost, 0);
  return AbortCode::none;
}

AbortCode TouchProbe::read_domain(canopen::ObjectId /*object*/, Span<const std::uint8_t>& source) {
  source = path_.points().oldest();
  return source.empty() ? AbortCode::no_data : AbortCode::none;
}

}  // namespace volcomp::node
