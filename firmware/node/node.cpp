#include "firmware/node/node.hpp"

#include <algorithm>

#include "firmware/canopen/bytes.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtState;

namespace {

constexpr std::uint64_t kScrubPeriod_us = 10'000'000;

constexpr canopen::ObjectId kController{0x2000, 2};
constexpr canopen::ObjectId kProbe{0x2300, 1};
constexpr canopen::ObjectId kFeature{0x2310, 1};
constexpr canopen::ObjectId kGear{0x2311, 1};
constexpr canopen::ObjectId kStrokes{0x2500, 1};
constexpr canopen::ObjectId kLearn{0x2520, 1};
constexpr canopen::ObjectId kLearnedImage{0x2526, 1};

// What the cycle and its supervision rely on may change only while there is no cycle.
bool is_setting(std::uint16_t index) {
  return (index >= 0x1005 && index <= 0x1007) || index == 0x1016 || index == 0x1017 ||
         index == 0x1019 || index == 0x1029 || index == 0x2000 || index == 0x2010 ||
         (index >= 0x2030 && index <= 0x2033) || (index >= 0x2200 && index <= 0x2205) ||
         (kWatchesStrokes && index >= 0x2500 && index <= 0x2505);
}

}  // namespace

Node::Node(std::uint8_t node_id, Storage* storage, Preemption* preemption)
    : preemption_(preemption),
      device_({node_dictionary(),
               &objects_.communication,
               {receive_.data(), receive_.size()},
               {transmit_.data(), transmit_.size()},
               kNodeAxes},
              *this),
      download_(objects_, compensator_, running_, preemption_),
      probe_(objects_.probe, compensator_, preemption_),
      strokes_(objects_.stroke, preemption_),
      thermal_(objects_.thermal),
      storage_(storage) {
  device_.set_node_id(node_id);
}

// --- resets

void Node::power_on(std::uint64_t now_us, ResetCause cause) {
  reset_cause_ = cause;
  device_.power_on(now_us);
  const bool meant = cause == ResetCause::power_on || cause == ResetCause::request;
  if (!meant)
    device_.emergency().raise(ErrorCode::unexpected_reset, static_cast<std::uint8_t>(cause));
}

void Node::reset_application() {
  const Preemptible preemptible(preemption_);
  objects_ = {};
  objects_.reset_cause = static_cast<std::uint8_t>(reset_cause_);
  compensator_.restart({});
  download_.reset();
  probe_.reset();
  thermal_.reset();
  if constexpr (kWatchesStrokes) static_cast<void>(switch_strokes(StrokeCommand::off));
  running_ = cycle_open_ = overdue_ = false;
  start_given_ = 0;
  load_stored(true);
}

void Node::reset_communication() {
  const Preemptible preemptible(preemption_);
  canopen::CommunicationObjects& c = objects_.communication;
  canopen::CommunicationObjects fresh;
  fresh.error_register = c.error_register;
  fresh.error_count = c.error_count;
  fresh.error_history = c.error_history;
  c = fresh;
  c.device_type = 0;  // no standard device profile
  c.device_name = {"volcomp compensation"};
  c.hardware_version = {"1"};
  c.software_version = {VOLCOMP_NODE_VERSION};
  c.identity = {0, 0x564F4C43, 1, 0};  // "VOLC"; a vendor id has to be bought
  c.producer_heartbeat_ms = 100;
  c.sync_counter_overflow = 240;
  c.emergency_inhibit_100us = 100;
  set_default_pdos();
  load_stored(false);
}

void Node::state_changed(NmtState state, std::uint64_t now_us) {
  running_ = cycle_open_ = false;
  arrived_ = {};
  for (OffsetGate& gate : gate_)
    gate.forget();
  for (WirePosition& position : position_)
    position.reset();
  had_actual_ = 0;
  probe_.restart();
  next_scrub_us_ = now_us + kScrubPeriod_us;
  objects_.state = static_cast<std::uint8_t>(NodeState::idle);
  if (state != NmtState::operational) return;
  report(configure(), objects_);
  const auto probe = static_cast<ProbeCommand>(objects_.probe.command);
  if (probe == ProbeCommand::on) static_cast<void>(switch_probe(probe));
  if constexpr (kWatchesStrokes) restart_strokes();
  start_at_given_offsets();
  report_status();
}

// --- time

void Node::poll_cycle(std::uint64_t now_us) {
  if (device_.state() == NmtState::boot_up) return;
  device_.poll_cycle(now_us);
  if (!cycle_open_ || now_us < deadline_us_) return;
  ++objects_.deadline_missed;
  compute(now_us);
}

// Also how warm the tables are.
void Node::poll_scrub(std::uint64_t now_us) {
  if constexpr (kFollowsTemperature) poll_thermal(now_us);
  if (now_us < next_scrub_us_) return;
  next_scrub_us_ = now_us + kScrubPeriod_us;
  const Status status = scrub();
  if (status.ok()) return;
  if (!running_) compensator_.settle();
  report(status, objects_);
  download_.lost_active();
  device_.emergency().raise(ErrorCode::table_damaged, 0);
}

// Reads the active set and, if it is damaged, asks the tick to drop it. No tick exchanges the sets
// meanwhile: only the background hands one over.
Status Node::scrub() {
  const Preemptible preemptible(preemption_);
  return compensator_.scrub();
}

// --- the other context

void Node::frames_lost(std::uint32_t count) {
  if (device_.state() == NmtState::boot_up) return;
  if (count == 0) return device_.emergency().clear(ErrorCode::can_overrun, 0);
  const std::uint32_t room = UINT32_MAX - objects_.frames_lost;
  objects_.frames_lost += count < room ? count : room;
  device_.emergency().raise(ErrorCode::can_overrun, 0);
}

void Node::background_overdue(bool overdue) {
  if (device_.state() == NmtState::boot_up) return;
  overdue_ = overdue;
  if (overdue) {
    compensator_.deactivate();
    if constexpr (kWatchesStrokes) stop_strokes();
    if (!running_) compensator_.settle();
    download_.lost_active();
    device_.emergency().raise(ErrorCode::background_overdue, 0);
  } else {
    device_.emergency().clear(ErrorCode::background_overdue, 0);
  }
  if (device_.state() == NmtState::operational) report_status();
}

bool Node::at_rest() const {
  if (device_.state() == NmtState::boot_up || !running_) return true;
  const std::uint32_t correcting = correcting_axes();
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool moves = (correcting & (1U << a)) != 0 && gate_[a].open();
    if (moves && gate_[a].last() != 0) return false;
  }
  return true;
}

// --- other nodes

void Node::time_of_day(std::uint32_t midnight_ms, std::uint16_t days) {
  thermal_.time_of_day(midnight_ms, days);
}

bool Node::heartbeat(std::uint8_t node, canopen::HeartbeatEvent event, std::uint64_t /*now_us*/) {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool gone = event != canopen::HeartbeatEvent::back;
    if (gone && objects_.drive[a] == node) gate_[a].forget();
  }
  return node == objects_.controller;
}

void Node::bad_sync(canopen::SyncVerdict verdict, std::uint64_t /*now_us*/) {
  clean_syncs_ = 0;
  const bool foreign = verdict == canopen::SyncVerdict::foreign;
  device_.emergency().raise(foreign ? ErrorCode::foreign_sync : ErrorCode::sync_length, 0);
}

// --- objects

AbortCode Node::before_write(canopen::ObjectId object, const canopen::Entry& /*entry*/,
                             Span<const std::uint8_t> bytes) {
  if (is_setting(object.index) && device_.state() == NmtState::operational)
    return AbortCode::device_state;
  // While offsets are being sent, only they say what the drive holds.
  const bool starts = object.index == 0x2206 && object.sub != 0;
  if (starts && gate_[object.sub - 1U].open()) return AbortCode::device_state;
  if (object == kProbe) return switch_probe(static_cast<ProbeCommand>(bytes[0]));
  if constexpr (kWatchesStrokes) {
    if (object == kStrokes) return switch_strokes(static_cast<StrokeCommand>(bytes[0]));
    if (object == kLearn) return learn(static_cast<LearnCommand>(bytes[0]));
  }
  const auto number = static_cast<std::uint32_t>(
      canopen::load_le(bytes.data(), std::min(bytes.size(), sizeof(std::uint32_t))));
  if (object == kFeature || object == kGear) {
    const Reason why = object == kGear ? probe_.load_gear(number) : probe_.take_feature(number);
    return why == Reason::ok ? AbortCode::none : AbortCode::invalid_value;
  }
  switch (object.index) {
    case 0x1010:
      return run_store(bytes);
    case 0x1011:
      return run_restore(bytes);
    case 0x2111:
      return run_table_command(static_cast<TableCommand>(bytes[0]));
    case 0x2411:
      return release_point(number);
    default:
      return AbortCode::none;
  }
}

AbortCode Node::run_table_command(TableCommand command) {
  const AbortCode why = download_.command(command);
  canopen::Emergency& emergency = device_.emergency();
  if (why == AbortCode::general)
    emergency.raise(ErrorCode::table_refused, objects_.where_axis, {objects_.reason});
  if (why != AbortCode::none || command < TableCommand::validate) return why;
  for (std::size_t letter = 0; letter < 128; ++letter)
    emergency.clear(ErrorCode::table_refused, static_cast<std::uint8_t>(letter));
  if (command == TableCommand::activate) {
    emergency.clear(ErrorCode::table_damaged, 0);
    probe_.set_machine(download_.machine_description());
  }
  return why;
}

void Node::written(canopen::ObjectId object, std::uint64_t /*now_us*/) {
  objects_.store = objects_.restore = 1;
  const bool names_controller = (kWatchesStrokes || kFollowsTemperature) && object == kController;
  if (object.index == 0x2010 || names_controller) set_default_pdos();
  if (object.index == 0x2206) start_given_ |= 1U << (object.sub - 1U);
  thermal_.arrived(object);
  if (device_.state() == NmtState::operational) start_at_given_offsets();
}

// Each counts for one start: later the drive holds what it was sent.
void Node::start_at_given_offsets() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const bool given = objects_.drives_report == 0 && (start_given_ & (1U << a)) != 0;
    if (given) gate_[a].start_at(offset_to_wire(objects_.start_offset[a], scale_[a]));
  }
  start_given_ = 0;
}

void Node::before_read(canopen::ObjectId object) {
  if constexpr (kWatchesStrokes) read_strokes(object.index);
  if (object.index < 0x2600) return;
  const Diagnostics<kNodeAxes>& d = compensator_.diagnostics();
  objects_.activations = d.activations;
  objects_.sync_missed = device_.sync().missed();
  objects_.sync_foreign = device_.sync().foreign();
  objects_.largest = d.largest;
  objects_.began = d.began;
}

AbortCode Node::read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) {
  if (object == kTableImage) return download_.read(source);
  if constexpr (kWatchesStrokes) {
    if (object.index >= 0x2500) return read_stroke_domain(object, source);
  }
  source = probe_.points().oldest();
  return source.empty() ? AbortCode::no_data : AbortCode::none;
}

AbortCode Node::begin_domain(canopen::ObjectId object, std::size_t announced,
                             Span<std::uint8_t>& sink) {
  if constexpr (kWatchesStrokes) {
    if (object == kLearnedImage) return begin_learned(announced, sink);
  }
  return object == kTableImage ? download_.begin(announced, sink) : AbortCode::unsupported_access;
}

AbortCode Node::finish_domain([[maybe_unused]] canopen::ObjectId object, std::size_t size) {
  if constexpr (kWatchesStrokes) {
    if (object == kLearnedImage) return finish_learned(size);
  }
  download_.finish(size);
  return AbortCode::none;
}

void Node::abandon_domain([[maybe_unused]] canopen::ObjectId object) {
  if constexpr (kWatchesStrokes) {
    if (object == kLearnedImage) return;
  }
  download_.abandon();
}

}  // namespace volcomp::node
