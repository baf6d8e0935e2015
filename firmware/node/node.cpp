#include "firmware/node/node.hpp"

#include <algorithm>

#include "firmware/canopen/device.inl"
#include "firmware/node/object_handles.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtState;

namespace {

constexpr canopen::ObjectId kController = object::controller.id();
constexpr canopen::ObjectId kDrivesReport = object::drives_report.id();

bool is_fixed(const canopen::ObjectDictionary& objects, canopen::ObjectId object) {
  const canopen::Entry* const entry = objects.find(object).entry;  // there is none for a PDO
  return entry != nullptr && entry->has(canopen::kFixed);
}

void count_up(std::uint32_t& counter, std::uint32_t by) {
  const std::uint32_t room = UINT32_MAX - counter;
  counter += by < room ? by : room;
}

static_assert(kReceivePdos <= NodeDevice::kMostReceive &&
              kTransmitPdos <= NodeDevice::kMostTransmit);

}  // namespace

Node::Node(std::uint8_t node_id, Storage* storage, Preemption* preemption)
    : core_(*this, node_id, preemption),
      probe_(core_),
      strokes_(core_),
      cycle_(core_, probe_, strokes_),
      tables_(core_, probe_),
      thermal_(core_, tables_),
      store_(core_, tables_, strokes_, storage),
      scrub_(core_, tables_) {}

// --- resets

void Node::power_on(std::uint64_t now_us, ResetCause cause) {
  reset_cause_ = cause;
  core_.device.power_on(now_us);
  const bool meant = cause == ResetCause::power_on || cause == ResetCause::request;
  if (!meant)
    core_.emergency().raise(ErrorCode::unexpected_reset, static_cast<std::uint8_t>(cause));
}

void Node::reset_application() {
  const Preemptible preemptible(core_.preemption);
  core_.objects = default_objects();
  core_.objects.reset_cause = static_cast<std::uint8_t>(reset_cause_);
  core_.compensator.restart({});
  core_.note_machine();
  each_part([](auto& part) { part.reset(); });
  store_.load(true);
}

void Node::reset_communication() {
  const Preemptible preemptible(core_.preemption);
  canopen::CommunicationObjects& c = core_.objects.communication;
  canopen::CommunicationObjects fresh;
  fresh.error_register = c.error_register;
  fresh.error_count = c.error_count;
  fresh.error_history = c.error_history;
  c = fresh;
  c.device_type = 0;  // no standard device profile
  c.device_name = {"volcomp compensation"};
  c.hardware_version = {"1"};
  c.software_version = {VOLCOMP_NODE_VERSION};
  c.product_code = kProductCode;
  c.revision = 1;  // a vendor id has to be bought
  c.producer_heartbeat_ms = 100;
  c.sync_counter_overflow = 240;
  c.emergency_inhibit_100us = 100;
  core_.set_default_pdos();
  store_.load(false);
}

void Node::state_changed(NmtState state, std::uint64_t /*now_us*/) {
  const bool operational = state == NmtState::operational;
  each_part([operational](auto& part) { part.restart(operational); });
  if (operational) cycle_.begin();
}

void Node::received(const canopen::Pdo& pdo, std::uint64_t now_us) {
  const std::uint32_t bits = pdo.arrivals();
  thermal_.arrived(bits);
  cycle_.arrived(bits, now_us);
}

// --- background

void Node::background(std::uint64_t now_us) {
  poll_probe();
  poll_strokes();
  poll_scrub(now_us);
}

void Node::poll_scrub(std::uint64_t now_us) {
  thermal_.background(now_us);
  scrub_.background(now_us);
}

// The parts whose background() or due() is called.
std::uint64_t Node::rests_until_us() const {
  if (core_.booting()) return UINT64_MAX;
  const std::uint64_t device_us = core_.device.rests_until_us();
  const std::uint64_t cycle_us = std::min(device_us, cycle_.rests_until_us());
  const std::uint64_t point_us = std::min(probe_.rests_until_us(), strokes_.rests_until_us());
  const std::uint64_t scrub_us = std::min(thermal_.rests_until_us(), scrub_.rests_until_us());
  return std::min({cycle_us, point_us, scrub_us});
}

// --- the other context

void Node::frames_lost(std::uint32_t count) {
  if (core_.booting()) return;
  if (count == 0) return core_.emergency().clear(ErrorCode::can_overrun, 0);
  count_up(core_.objects.frames_lost, count);
  cycle_.end_forwarding();  // how many targets were among them nobody knows
  core_.emergency().raise(ErrorCode::can_overrun, 0);
}

void Node::controller_errors(std::uint32_t count) {
  if (!core_.booting()) count_up(core_.objects.controller_errors, count);
}

void Node::bus_state(hal::CanBusState state) {
  if (core_.booting()) return;
  canopen::Emergency& emergency = core_.emergency();
  const bool off = state == hal::CanBusState::off;
  const bool recovered = bus_off_ && !off;
  bus_off_ = off;
  if (off) cycle_.end_forwarding();
  if (recovered) emergency.raise(ErrorCode::bus_off_recovered, 0);
  if (state == hal::CanBusState::passive) emergency.raise(ErrorCode::can_passive, 0);
  if (off || recovered || state == hal::CanBusState::passive) return;
  emergency.clear(ErrorCode::can_passive, 0);
  if (state == hal::CanBusState::active) emergency.clear(ErrorCode::bus_off_recovered, 0);
}

void Node::background_overdue(bool overdue) {
  if (core_.booting()) return;
  core_.overdue = overdue;
  if (overdue) {
    strokes_.stop();
    tables_.drop(ErrorCode::background_overdue, 0);
  } else {
    core_.emergency().clear(ErrorCode::background_overdue, 0);
  }
  if (core_.operational()) cycle_.report_status();
}

// --- other nodes

bool Node::heartbeat(std::uint8_t node, canopen::HeartbeatEvent event, std::uint64_t /*now_us*/) {
  if (event != canopen::HeartbeatEvent::back)
    cycle_.drive_gone(node, event == canopen::HeartbeatEvent::booted);
  return node == core_.objects.controller;
}

// --- objects

AbortCode Node::before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
  if (core_.operational() && is_fixed(core_.device.objects(), object))
    return AbortCode::device_state;
  AbortCode why = AbortCode::none;
  each_part([&](auto& part) {
    if (why == AbortCode::none) why = part.before_write(object, bytes);
  });
  return why;
}

void Node::written(canopen::ObjectId object, std::uint64_t /*now_us*/) {
  if (object.index == object::drive.index || object == kController) core_.set_default_pdos();
  if (object.index == object::way.index) core_.set_default_axis_pdos(object.sub - 1U);
  if (object == kDrivesReport) {
    core_.objects.confirms.fill(core_.objects.drives_report);
    core_.set_default_receive_pdos(kFirstHeldPdo, kFirstHeldPdo + kNodeAxes);
  }
  if (object.index == object::confirms.index)
    core_.set_default_receive_pdos(kFirstHeldPdo + object.sub - 1U, kFirstHeldPdo + object.sub);
  each_part([object](auto& part) { part.written(object); });
}

void Node::before_read(canopen::ObjectId object) {
  each_part([object](auto& part) { part.before_read(object); });
  if (object.index < object::state.index) return;
  NodeObjects& o = core_.objects;
  const Diagnostics<kNodeAxes>& d = core_.compensator.diagnostics();
  o.activations = d.activations;
  o.sync_missed = core_.device.sync().missed();
  o.sync_foreign = core_.device.sync().foreign();
  o.largest = d.largest;
  o.largest_lag = d.largest_lag;
  o.began = d.began;
}

AbortCode Node::read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) {
  AbortCode why = AbortCode::no_data;
  each_part([&](auto& part) {
    if (part.owns_domain(object)) why = part.read_domain(object, source);
  });
  return why;
}

AbortCode Node::begin_domain(canopen::ObjectId object, std::size_t announced,
                             Span<std::uint8_t>& sink) {
  AbortCode why = AbortCode::unsupported_access;
  each_part([&](auto& part) {
    if (part.owns_domain(object)) why = part.begin_domain(announced, sink);
  });
  return why;
}

AbortCode Node::finish_domain(canopen::ObjectId object, std::size_t size) {
  AbortCode why = AbortCode::none;
  each_part([&](auto& part) {
    if (part.owns_domain(object)) why = part.finish_domain(size);
  });
  return why;
}

void Node::abandon_domain(canopen::ObjectId object) {
  each_part([object](auto& part) {
    if (part.owns_domain(object)) part.abandon_domain();
  });
}

}  // namespace volcomp::node

namespace volcomp::canopen {

template class Device<node::Node>;

}  // namespace volcomp::canopen
