#include "tests/system/forwarded/forwarded_world.hpp"

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

using Fate = hal::LoopbackBus::Fate;

constexpr std::uint64_t kPeriod_ns = 1000 * kForwardedPeriod_us;
constexpr std::uint64_t kSyncPhase_ns = 300'000;  // after SYNC, before the targets are sent
constexpr std::uint64_t kMostLate = 2;            // cycles, 2200h:04
constexpr std::uint64_t kBehind_ns = 500'000;
constexpr int kLongestStart = 4000;  // cycles

// The same for the same numbers on every computer: splitmix64.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E37'79B9'7F4A'7C15U;
  x = (x ^ (x >> 30U)) * 0xBF58'476D'1CE4'E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D0'49BB'1331'11EBU;
  return x ^ (x >> 31U);
}

double share_of(std::uint64_t x) { return static_cast<double>(mixed(x) >> 11U) * 0x1p-53; }

// A port as the node sees it, with somebody who looks on.
struct WatchedPort {
  SimulatedBus::Port& port;
  ForwardedJudge& judge;

  bool receive(hal::CanFrame& frame) {
    if (!port.receive(frame)) return false;
    judge.node_hears(frame);
    return true;
  }
  bool send(const hal::CanFrame& frame) {
    if (!port.send(frame)) return false;
    judge.node_sends(frame);
    return true;
  }
};

}  // namespace

Cia402Drive::Settings drive_settings(std::size_t axis, const DriveKind& kind) {
  Cia402Drive::Settings s;
  s.node_id = static_cast<std::uint8_t>(axis + 1);
  s.period_s = 1e-6 * kForwardedPeriod_us;
  s.behaviour = kind.behaviour;
  s.following_window = kind.following_window;
  s.following_timeout_ms = kind.following_timeout_ms;
  s.deceleration = kind.deceleration;
  return s;
}

void apply(const DriveEvent& event, Cia402Drive& drive, SimulatedBus::Port& port,
           std::uint64_t now_us) {
  switch (event.kind) {
    case DriveEvent::Kind::power_off:
      port.connect(false);
      return drive.power_off();
    case DriveEvent::Kind::power_on:
      port.connect(true);
      return drive.power_on(now_us);
    case DriveEvent::Kind::off_bus:
    case DriveEvent::Kind::on_bus:
      return port.connect(event.kind == DriveEvent::Kind::on_bus);
    case DriveEvent::Kind::lose_reference:
      return drive.lose_reference();
    default:
      return;
  }
}

// Targets are late by whole cycles and come behind those of then, whatever else is on the bus.
Fate SharedFates::at(const hal::CanFrame& frame, std::size_t axis) const {
  const std::uint64_t key =
      mixed(seed_ ^ mixed(frame.id)) ^ mixed(ordinal_ * kForwardedAxes + axis);
  Fate fate;
  fate.lost = share_of(key) < disorder_.lost;
  fate.twice = share_of(key + 1) < disorder_.twice;
  const double late = share_of(key + 2);
  const bool target = frame.id - canopen::kRpdo1 - 1U < kForwardedAxes;
  if (late < disorder_.late && target)
    fate.delay_ns = (late < disorder_.late / 2 ? 1 : kMostLate) * kPeriod_ns + kBehind_ns;
  return fate;
}

hal::CanFrame as_taken_by(const DriveKind& kind, hal::CanFrame frame) {
  constexpr std::uint8_t kDownloadOfOne = 0x2F;
  constexpr std::uint8_t kDownloadOfFour = 0x23;
  constexpr std::uint8_t kAtOnce = 255;
  const bool request = (frame.id & ~unsigned{canopen::kMaxNodeId}) == canopen::kSdoRequest;
  if (!request || frame.data[3] != 2) return frame;
  const std::uint64_t index = load_le(&frame.data[1], 2);
  const bool at_once =
      (index == 0x1400 && kind.controlword_at_once) || (index == 0x1401 && kind.target_at_once);
  if (at_once && frame.data[0] == kDownloadOfOne) frame.data[4] = kAtOnce;
  if (index != 0x1016 || frame.data[0] != kDownloadOfFour) return frame;
  if (kind.watch_ms != 0) store_le(&frame.data[4], 2, kind.watch_ms);
  if (!kind.watches_node) store_le(&frame.data[4], 4, 0);
  return frame;
}

ForwardedWorld::ForwardedWorld(std::uint64_t seed, host::BusSettings settings,
                               const DriveKinds& kinds, const BusDisorder& disorder)
    : seed_(seed),
      kinds_(kinds),
      disorder_(disorder),
      fates_(seed, disorder),
      random_(seed),
      controller_(settings, bus_machine().image),
      node_(settings.node, nullptr),
      judge_(node_, settings.limits.axis[0].limit, settings.limits.axis[0].rate),
      path_(kForwardedAxes, kForwardedBegin_nm) {
  attach_controller();
  attach_drives();
  attach_node();
  intruder_ = &bus_.attach_served("intruder", {});
  bus_.bus().set_observer(
      [this](std::uint64_t time_ns, const hal::CanFrame& frame, const SimulatedBus::Port& sender) {
        note(time_ns, frame, sender);
      });
  bus_.bus().set_fault_hook(
      [this](const hal::CanFrame& frame, const SimulatedBus::Port& sender,
             const SimulatedBus::Port& receiver) { return fate(frame, sender, receiver); });
}

void ForwardedWorld::attach_controller() {
  controller_port_ =
      &bus_.attach_served("controller", [this](SimulatedBus::Port& port, std::uint64_t now_us) {
        hal::CanFrame frame;
        while (port.receive(frame))
          controller_.receive(frame, now_us);
        controller_.poll(now_us);
        while (controller_.offer(frame, now_us)) {
          const unsigned axis = frame.id - canopen::kRpdo1 - 1U;
          if (controlword_ && axis < kForwardedAxes) store_le(frame.data.data(), 2, *controlword_);
          if (!port.send(frame)) return;
          controller_.taken(now_us);
        }
      });
}

void ForwardedWorld::attach_drives() {
  for (std::size_t a = 0; a < kForwardedAxes; ++a) {
    drive_[a] = std::make_unique<Cia402Drive>(drive_settings(a, kinds_[a]));
    Cia402Drive& drive = *drive_[a];
    drive.on_input = [this, a](const Cia402Drive::InputStep& in) { judge_.input(a, in.target); };
    const bool at_once = kinds_[a].target_at_once && kinds_[a].behaviour.target_acts ==
                                                         DriveBehaviour::TargetActs::at_reception;
    drive_port_[a] = &bus_.attach_served(
        "drive", [this, &drive, a, at_once](SimulatedBus::Port& port, std::uint64_t now_us) {
          hal::CanFrame frame;
          while (port.receive(frame)) {
            judge_.before(a, drive, drive.device(), frame);
            drive.receive(as_taken_by(kinds_[a], frame), now_us);
            judge_.after(a, drive, at_once, frame);
          }
          drive.poll(now_us);
          while (drive.offer(frame, now_us) && port.send(frame))
            drive.taken(now_us);
        });
    drive.stand_at(kForwardedBegin_nm);
    drive.power_on(0);
  }
}

void ForwardedWorld::attach_node() {
  node_port_ = &bus_.attach_served("node", [this](SimulatedBus::Port& port, std::uint64_t now_us) {
    if (stalled_) return;
    WatchedPort watched{port, judge_};
    canopen::exchange(node_.device(), watched, now_us);
  });
  node_.power_on(0);
}

// --- frames

void ForwardedWorld::note(std::uint64_t time_ns, const hal::CanFrame& frame,
                          const SimulatedBus::Port& sender) {
  // A drive that boots has its own PDOs again.
  const unsigned booted = frame.id - canopen::kHeartbeat - 1U;
  if (booted < kForwardedAxes && frame.data[0] == 0) judge_.drive_boots(booted);
  if (!of_controller(sender)) return;
  fates_.count(frame);
  said_.push_back({time_ns - bus_.bus().duration_ns(frame), cycle_, frame});
  judge_.said(frame);
}

Fate ForwardedWorld::any_fate(bool of_node) {
  Fate fate;
  fate.lost = random_.uniform() < disorder_.lost;
  fate.twice = random_.uniform() < disorder_.twice;
  if (random_.uniform() < disorder_.late)
    fate.delay_ns = static_cast<std::uint64_t>(random_.uniform() * double{kMostLate * kPeriod_ns});
  // What is sent right after SYNC belongs to the next cycle.
  if (of_node && (fate.lost || fate.twice)) judge_.hit(1);
  if (of_node && fate.delay_ns != 0) judge_.hit(kMostLate + 1);
  return fate;
}

Fate ForwardedWorld::fate(const hal::CanFrame& frame, const SimulatedBus::Port& sender,
                          const SimulatedBus::Port& receiver) {
  const bool sync = frame.id == canopen::kSync;
  const auto* const to = std::find(drive_port_.begin(), drive_port_.end(), &receiver);
  const bool to_drive = to != drive_port_.end();
  const auto axis = static_cast<std::size_t>(to - drive_port_.begin());
  if (sync && to_drive && deaf_.at(axis)) return {true, false, 0};
  if (sync && &receiver == node_port_ && deaf_node_) return {true, false, 0};
  if (cycle_ < disturbed_from_) return {};
  if (to_drive && of_controller(sender)) return fates_.at(frame, axis);
  const bool process_data =
      sync || (frame.id >= canopen::kTpdo1 && frame.id < canopen::kSdoResponse);
  const bool of_node = &sender == node_port_ || &receiver == node_port_;
  Fate fate = any_fate(of_node && process_data);
  // Late is counted from SYNC, which is itself the first of its cycle or lost.
  if (sync) fate.delay_ns = 0;
  return fate;
}

// --- what happens

void ForwardedWorld::power_node(bool on) {
  dead_ = !on;
  node_port_->connect(on);
  stalled_ = false;
  judge_.node_restarts();
  if (on) node_.power_on(bus_.now_us());
}

void ForwardedWorld::to_drive(std::size_t axis, DriveEvent::Kind kind) {
  drive_events_.push_back({cycle_, axis, kind});
  if (kind == DriveEvent::Kind::power_on) judge_.drive_boots(axis);
  if (kind == DriveEvent::Kind::deaf || kind == DriveEvent::Kind::hears)
    deaf_.at(axis) = kind == DriveEvent::Kind::deaf;
  apply(drive_events_.back(), *drive_.at(axis), *drive_port_.at(axis), bus_.now_us());
}

void ForwardedWorld::cycle(const std::array<std::int32_t, kForwardedAxes>& step) {
  for (std::size_t a = 0; a < kForwardedAxes; ++a) {
    const AxisCommander& axis = controller_.axis(a);
    path_[a] = axis.following() ? path_[a] + step.at(a) : axis.standing_at();
  }
  controller_.send_targets(path_);
  if (pretends_) pretend();
  bus_.run_until((cycle_ + 1) * kPeriod_ns);
  constexpr std::uint16_t kIncomplete = 0x8000;  // 2600h:03
  const bool serves = node_.device().state() == canopen::NmtState::operational &&
                      (node_.objects().any_status & kIncomplete) == 0;
  if (dead_ || stalled_ || full_ || deaf_node_ || !serves || !served_) judge_.hit(1);
  served_ = serves;  // a node that has just started says nothing yet
  controller_.send_sync();
  bus_.run_until((cycle_ + 1) * kPeriod_ns + kSyncPhase_ns);
  judge_.begin_cycle(++cycle_);
}

void ForwardedWorld::pretend() {
  hal::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(canopen::kTpdo1 + settings().node);
  frame.size = 8;
  store_le(frame.data.data(), 4, controller_.report().active_crc);
  frame.data[4] = controller_.report().state;
  frame.data[5] = controller_.sync_counter();
  send(frame);
}

bool ForwardedWorld::bring_up() {
  controller_.power_on(bus_.now_us());
  for (int i = 0; i < kLongestStart && !controller_.motion_allowed(); ++i)
    cycle({});
  return controller_.motion_allowed();
}

}  // namespace volcomp::sim
