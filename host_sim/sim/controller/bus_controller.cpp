#include "host_sim/sim/controller/bus_controller.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/tables/image.hpp"
#include "comp/tick/tick_types.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"

namespace volcomp::sim {

using canopen::NmtCommand;
using canopen::NmtState;

namespace {

constexpr std::uint64_t kRetryPause_us = 200'000;
constexpr std::uint64_t kResetPause_us = 1'000'000;
// SDO frames per cycle to a node that runs. More of them, and their answers, leave no gap on the
// bus for a heartbeat; a drive whose controller sends in the order of its queue then keeps its
// position back behind it for cycles.
constexpr int kMostNodeRequests = 6;
constexpr int kUnheededStarts = 3;  // heartbeats before a node that should run is started again

}  // namespace

BusController::BusController(host::BusSettings settings, std::vector<std::uint8_t> image)
    : settings_(std::move(settings)),
      axis_(settings_.axes.size()),
      probe_(settings_.axes.size()),
      added_(settings_.axes.size()) {
  stations_.reserve(settings_.axes.size() + 1);
  for (const host::BusAxis& axis : settings_.axes)
    stations_.emplace_back(axis.drive, fmt::format("drive {} (node {})", axis.letter, axis.drive));
  stations_.emplace_back(settings_.node, fmt::format("compensation node {}", settings_.node));
  load_tables(std::move(image));
}

void BusController::load_tables(std::vector<std::uint8_t> image) {
  image_ = std::move(image);
  image_crc_ = image_crc({image_.data(), image_.size()});
  Station& node = stations_.back();
  node.refusal.clear();
  if (node.phase == Station::Phase::running && !image_.empty()) queue_tables(node.channel);
}

void BusController::use_probe(const host::NodeProbe& probe) {
  node_probe_ = probe;
  Station& node = stations_.back();
  if (node.phase == Station::Phase::running)
    host::queue_plan(node.channel, host::probe_plan(probe));
}

void BusController::command(NmtCommand what, std::uint8_t node) {
  outgoing_.push_back({canopen::kNmt, 2, {static_cast<std::uint8_t>(what), node}});
}

void BusController::power_on(std::uint64_t now_us) {
  next_heartbeat_us_ = now_us;
  outgoing_.clear();
  for (Station& s : stations_) {
    s.phase = Station::Phase::absent;
    s.boots = 0;
    s.retry_us = now_us + kResetPause_us;
  }
  command(NmtCommand::reset_node, 0);
}

Station* BusController::station(std::uint8_t id) {
  for (Station& s : stations_) {
    if (s.id == id) return &s;
  }
  return nullptr;
}

// --- in

void BusController::receive(const hal::CanFrame& frame, std::uint64_t now_us) {
  const auto node = static_cast<std::uint8_t>(frame.id & canopen::kMaxNodeId);
  switch (frame.id & ~unsigned{canopen::kMaxNodeId}) {
    case canopen::kHeartbeat:
      if (Station* s = station(node); s != nullptr && frame.size == 1)
        take_heartbeat(*s, frame.data[0], now_us);
      return;
    case canopen::kSdoResponse:
      if (Station* s = station(node)) s->channel.receive(frame, now_us);
      return;
    case canopen::kEmergency:
      if (node == 0 || frame.size != 8) return;
      emergencies_.push_back(
          {now_us,
           node,
           static_cast<std::uint16_t>(load_le(frame.data.data(), 2)),
           frame.data[2],
           {frame.data[3], frame.data[4], frame.data[5], frame.data[6], frame.data[7]}});
      return;
    default:
      take_process_data(frame);
      return;
  }
}

void BusController::take_heartbeat(Station& s, std::uint8_t state, std::uint64_t now_us) {
  s.last_heard_us = now_us;
  s.state = static_cast<NmtState>(state & 0x7FU);
  if (s.state == NmtState::boot_up) {
    ++s.boots;
    configure(s);
    return;
  }
  if (s.boots == 0) return;  // has not heeded our reset yet
  if (s.phase == Station::Phase::absent) {
    // Back without a boot: its configuration is still there.
    s.phase = Station::Phase::running;
    s.not_started = 0;
    s.retry_us = 0;
    tell_held_offsets(s);
  }
  if (is_drive(s)) confirm_mapping(static_cast<std::size_t>(&s - stations_.data()));
  const bool heeds = s.phase != Station::Phase::running || s.state == NmtState::operational;
  s.not_started = heeds ? 0 : s.not_started + 1;
  if (s.not_started < kUnheededStarts) return;
  s.not_started = 0;
  // A node that is PRE-OPERATIONAL may have booted without a boot-up received here.
  if (s.state == NmtState::pre_operational) {
    configure(s);
  } else {
    command(NmtCommand::enter_pre_operational, s.id);
  }
}

// --- time

void BusController::poll(std::uint64_t now_us) {
  if (now_us >= next_heartbeat_us_) {
    next_heartbeat_us_ = now_us + 1000U * std::uint64_t{settings_.heartbeat_ms};
    send_latest({static_cast<std::uint16_t>(canopen::kHeartbeat + settings_.controller),
                 1,
                 {static_cast<std::uint8_t>(NmtState::operational)}});
  }
  for (Station& s : stations_)
    supervise(s, now_us);
}

void BusController::supervise(Station& s, std::uint64_t now_us) {
  s.channel.poll(now_us);
  const std::uint64_t timeout_us = 1000U * std::uint64_t{settings_.heartbeat_timeout_ms};
  const bool silent = now_us - s.last_heard_us > timeout_us;
  if (silent && s.phase == Station::Phase::running) {
    s.phase = Station::Phase::absent;
    s.retry_us = now_us + kResetPause_us;
    if (is_drive(s)) axis_[static_cast<std::size_t>(&s - stations_.data())].drive_lost();
    return;
  }
  const bool refused = !s.channel.failure().empty() || s.refused;
  if (refused && s.phase == Station::Phase::configuring) {
    if (!s.refused) take_refusal(s);
    s.phase = Station::Phase::failed;
    s.retry_us = now_us + kRetryPause_us;
  } else if (s.phase == Station::Phase::configuring && s.channel.idle()) {
    s.phase = Station::Phase::running;
    s.refusal.clear();
    command(NmtCommand::start, s.id);
    tell_held_offsets(s);
  } else if (s.phase == Station::Phase::failed && now_us >= s.retry_us) {
    configure(s);
  } else if (s.phase == Station::Phase::running && !is_drive(s)) {
    retry_tables(s, now_us);
  } else if (s.phase == Station::Phase::absent) {
    reset_silent(s, now_us);
  }
}

std::uint64_t BusController::sends_at_us() const {
  const auto idle = [](const Station& s) { return s.channel.idle(); };
  const bool nothing = outgoing_.empty() && std::all_of(stations_.begin(), stations_.end(), idle);
  return nothing ? UINT64_MAX : 0;
}

std::uint64_t BusController::rests_until_us() const {
  std::uint64_t until_us = std::min(next_heartbeat_us_, sends_at_us());
  for (const Station& s : stations_)
    until_us = std::min(until_us, supervises_at_us(s));
  return until_us;
}

// When supervise() has something to do, with nothing to read or write.
std::uint64_t BusController::supervises_at_us(const Station& s) const {
  const std::uint64_t retry_us = s.retry_us == 0 ? UINT64_MAX : s.retry_us;
  switch (s.phase) {
    case Station::Phase::configuring:
      return 0;
    case Station::Phase::failed:
      return s.retry_us;
    case Station::Phase::absent:
      return retry_us;
    case Station::Phase::running:
      break;
  }
  const std::uint64_t timeout_us = 1000U * std::uint64_t{settings_.heartbeat_timeout_ms};
  const std::uint64_t silent_us = s.last_heard_us + timeout_us + 1U;
  if (is_drive(s)) return silent_us;
  if (s.retry_us == 0 && !s.channel.failure().empty()) return 0;
  return std::min(silent_us, retry_us);
}

// Resets a silent node: one that has booted unnoticed has not been configured to send heartbeats.
void BusController::reset_silent(Station& s, std::uint64_t now_us) {
  if (s.retry_us == 0 || now_us < s.retry_us) return;
  s.retry_us = now_us + kResetPause_us;
  command(NmtCommand::reset_communication, s.id);
}

// Another client may have got in between.
void BusController::retry_tables(Station& s, std::uint64_t now_us) {
  if (s.retry_us == 0 && !s.channel.failure().empty()) {
    s.retry_us = now_us + kRetryPause_us;
    take_refusal(s);
  } else if (s.retry_us != 0 && now_us >= s.retry_us) {
    s.retry_us = 0;
    s.channel.clear();
    if (!image_.empty()) queue_tables(s.channel);
  }
}

// --- out

// Replaces a frame that has not left yet: it is out of date, and a burst would count as extra
// cycles.
void BusController::send_latest(const hal::CanFrame& frame) {
  const auto same = [&frame](const hal::CanFrame& waiting) { return waiting.id == frame.id; };
  const auto waiting = std::find_if(outgoing_.begin(), outgoing_.end(), same);
  if (waiting == outgoing_.end()) {
    outgoing_.push_back(frame);
  } else {
    *waiting = frame;
  }
}

bool BusController::offer(hal::CanFrame& frame, std::uint64_t /*now_us*/) {
  offered_sdo_ = nullptr;
  if (!outgoing_.empty()) {
    frame = outgoing_.front();
    return true;
  }
  for (Station& s : stations_) {
    const bool enough =
        !is_drive(s) && s.phase == Station::Phase::running && node_requests_ >= kMostNodeRequests;
    if (enough || !s.channel.offer(frame)) continue;
    offered_sdo_ = &s.channel;
    return true;
  }
  return false;
}

void BusController::taken(std::uint64_t /*now_us*/) {
  if (offered_sdo_ != nullptr) {
    offered_sdo_->taken();
    if (offered_sdo_ == &stations_.back().channel) ++node_requests_;
  } else {
    outgoing_.pop_front();
  }
}

// The mode of operation is not in a PDO: one SDO at a time.
void BusController::set_modes() {
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    const std::int8_t mode = axis_[a].wanted_mode();
    host::SdoChannel& sdo = stations_[a].channel;
    if (mode == 0 || !sdo.idle()) continue;
    if (!sdo.failure().empty()) sdo.clear();
    set_mode(sdo, a, mode);
  }
}

// Only the state of the drive counts: a response may be lost or belong to an earlier request.
void BusController::set_mode(host::SdoChannel& sdo, std::size_t axis, std::int8_t mode) {
  axis_[axis].mode_is(0);
  sdo.write(host::cia402::mode, mode);
  sdo.read(host::cia402::mode_display,
           [this, axis](std::int8_t display) { axis_[axis].mode_is(display); });
}

// --- verdict

std::string BusController::trouble() const {
  for (const Station& s : stations_) {
    if (s.phase == Station::Phase::failed) return s.refusal;
    if (s.phase == Station::Phase::configuring)
      return s.refusal.empty() ? s.name + " is being configured" : s.refusal;
    if (s.phase == Station::Phase::absent) return s.name + " is silent";
    if (s.state != NmtState::operational) return s.name + " has not started";
  }
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    if (!axis_[a].following()) {
      return fmt::format("axis {} does not follow: status word {:04X}h", settings_.axes[a].letter,
                         axis_[a].status_word());
    }
  }
  if (image_.empty() && !settings_.node_brings_tables) return {};
  const Station& node = stations_.back();
  if (!node.channel.failure().empty()) return node.channel.failure();
  if (image_.empty()) {
    if (report_.count == 0) return "the node has not reported its state yet";
    if (report_.active_crc == 0) return {};
  } else if (report_.active_crc != image_crc_) {
    return node.refusal.empty() ? "the node does not have the tables yet" : node.refusal;
  }
  if (report_.state != static_cast<std::uint8_t>(node::NodeState::compensating))
    return fmt::format("the node does not compensate every axis: status {:04X}h",
                       report_.any_status);
  return {};
}

bool BusController::motion_allowed() const { return trouble().empty(); }

}  // namespace volcomp::sim
