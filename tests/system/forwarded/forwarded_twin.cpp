#include "tests/system/forwarded/forwarded_twin.hpp"

#include <algorithm>
#include <deque>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint64_t kPeriod_ns = 1000 * kForwardedPeriod_us;
constexpr std::uint64_t kSyncPhase_ns = 300'000;

// Of the drive of a machine with a node only: PDOs that make room for it, and who watches it. As it
// comes this drive has {6040h, 607Ah} on 200h + n.
bool prepares_the_node(const hal::CanFrame& frame) {
  if ((frame.id & ~unsigned{canopen::kMaxNodeId}) != canopen::kSdoRequest) return false;
  const std::uint64_t index = load_le(&frame.data[1], 2);
  const bool type = (index == 0x1400 || index == 0x1401) && frame.data[3] == 2;
  const bool pdo = index >= 0x1400 && index < 0x1800;
  return (pdo && !type) || (index == 0x1016 && frame.data[3] == 2);
}

class TwinBus {
 public:
  explicit TwinBus(const ForwardedWorld& world) : world_(world), fates_(world.fates()) {
    player_ = &bus_.attach_served("controller",
                                  [this](SimulatedBus::Port& port, std::uint64_t) { play(port); });
    for (std::size_t a = 0; a < kForwardedAxes; ++a)
      attach_drive(a);
    bus_.bus().set_observer(
        [this](std::uint64_t, const hal::CanFrame& frame, const SimulatedBus::Port& sender) {
          if (&sender == player_) note(frame);
        });
    bus_.bus().set_fault_hook(
        [this](const hal::CanFrame& frame, const SimulatedBus::Port& sender,
               const SimulatedBus::Port& receiver) { return fate(frame, sender, receiver); });
  }

  void run() {
    auto event = world_.drive_events().begin();
    for (std::uint64_t cycle = 0; cycle < world_.cycles(); ++cycle) {
      for (; event != world_.drive_events().end() && event->cycle == cycle; ++event)
        to_drive(*event);
      run_until((cycle + 1) * kPeriod_ns + kSyncPhase_ns);
    }
  }
  [[nodiscard]] const std::vector<DriveAtSync>& history(std::size_t axis) const {
    return history_.at(axis);
  }

 private:
  // Everybody is served when a frame of the other bus began.
  void run_until(std::uint64_t time_ns) {
    const std::vector<BusEvent>& all = world_.controller_frames();
    while (bus_.bus().now_ns() < time_ns) {
      std::size_t later = next_;
      while (later < all.size() && all[later].begin_ns <= bus_.bus().now_ns())
        ++later;
      bus_.run_until(later < all.size() ? std::min(time_ns, all[later].begin_ns) : time_ns);
    }
  }

  // There is nobody to hear them.
  [[nodiscard]] bool to_node(const hal::CanFrame& frame) const {
    return frame.id == canopen::kSdoRequest + world_.settings().node;
  }

  void play(SimulatedBus::Port& port) {
    hal::CanFrame frame;
    while (port.receive(frame)) {
    }
    const std::vector<BusEvent>& all = world_.controller_frames();
    while (next_ < all.size() && all[next_].begin_ns <= bus_.bus().now_ns() &&
           (to_node(all[next_].frame) || port.send(all[next_].frame)))
      ++next_;
  }

  void note(const hal::CanFrame& frame) {
    fates_.count(frame);
    const std::vector<BusEvent>& all = world_.controller_frames();
    while (to_node(all[seen_].frame))
      ++seen_;
    cycle_ = all[seen_++].cycle;
  }

  void attach_drive(std::size_t a);
  void to_drive(const DriveEvent& event);
  hal::LoopbackBus::Fate fate(const hal::CanFrame& frame, const SimulatedBus::Port& sender,
                              const SimulatedBus::Port& receiver);

  const ForwardedWorld& world_;
  SharedFates fates_;
  SimulatedBus bus_;
  SimulatedBus::Port* player_ = nullptr;
  std::array<std::unique_ptr<Cia402Drive>, kForwardedAxes> drive_;
  std::array<SimulatedBus::Port*, kForwardedAxes> port_{};
  std::array<std::vector<DriveAtSync>, kForwardedAxes> history_;
  std::array<bool, kForwardedAxes> deaf_{};
  std::size_t next_ = 0;
  std::size_t seen_ = 0;
  std::uint64_t cycle_ = 0;  // in which the last frame of the controller was said in the other bus
};

void TwinBus::attach_drive(std::size_t a) {
  drive_[a] = std::make_unique<Cia402Drive>(drive_settings(a, world_.kinds()[a]));
  Cia402Drive& drive = *drive_[a];
  port_[a] = &bus_.attach_served(
      "drive", [this, &drive, a](SimulatedBus::Port& port, std::uint64_t now_us) {
        hal::CanFrame frame;
        while (port.receive(frame)) {
          const std::uint64_t periods = drive.periods();
          if (!prepares_the_node(frame))
            drive.receive(as_taken_by(world_.kinds()[a], frame), now_us);
          if (frame.id != canopen::kSync || drive.periods() == periods) continue;
          history_[a].push_back({cycle_, drive.objects().controlword, drive.objects().target});
        }
        drive.poll(now_us);
        while (drive.offer(frame, now_us) && port.send(frame))
          drive.taken(now_us);
      });
  drive.stand_at(kForwardedBegin_nm);
  drive.power_on(0);
}

void TwinBus::to_drive(const DriveEvent& event) {
  apply(event, *drive_.at(event.axis), *port_.at(event.axis), bus_.now_us());
  if (event.kind == DriveEvent::Kind::deaf || event.kind == DriveEvent::Kind::hears)
    deaf_.at(event.axis) = event.kind == DriveEvent::Kind::deaf;
}

hal::LoopbackBus::Fate TwinBus::fate(const hal::CanFrame& frame, const SimulatedBus::Port& sender,
                                     const SimulatedBus::Port& receiver) {
  const auto* const to = std::find(port_.begin(), port_.end(), &receiver);
  if (&sender != player_ || to == port_.end()) return {};
  const auto axis = static_cast<std::size_t>(to - port_.begin());
  if (frame.id == canopen::kSync && deaf_.at(axis)) return {true, false, 0};
  if (cycle_ < world_.disturbed_from()) return {};
  return fates_.at(frame, axis);
}

// How many targets of the controller lie between two of them, both said up to this cycle.
class Ages {
 public:
  Ages(const std::vector<BusEvent>& frames, std::size_t axis) : frames_(frames), axis_(axis) {}

  std::int64_t between(std::int32_t older, std::int32_t newer, std::uint64_t cycle) {
    for (; next_ < frames_.size() && frames_[next_].cycle <= cycle; ++next_) {
      const hal::CanFrame& frame = frames_[next_].frame;
      if (frame.id != canopen::kRpdo1 + axis_ + 1U) continue;
      number_[static_cast<std::int32_t>(load_le(&frame.data[2], 4))] = ++said_;
    }
    return number_[newer] - number_[older];
  }

 private:
  const std::vector<BusEvent>& frames_;
  std::size_t axis_;
  std::size_t next_ = 0;
  std::int64_t said_ = 0;
  std::map<std::int32_t, std::int64_t> number_;
};

std::string difference(const ForwardedWorld& world, const TwinBus& twin, std::size_t axis) {
  const std::vector<DriveAtSync>& with = world.judge().history(axis);
  const std::vector<DriveAtSync>& without = twin.history(axis);
  Ages ages(world.controller_frames(), axis);
  for (std::size_t i = 0; i < std::min(with.size(), without.size()); ++i) {
    const std::uint64_t cycle = with[i].cycle;
    if (cycle != without[i].cycle)
      return fmt::format("axis {}: SYNC of cycle {} and {}", axis, cycle, without[i].cycle);
    if (with[i].controlword != without[i].controlword)
      return fmt::format("axis {}, cycle {}: 6040h is {:04X}h, without node {:04X}h", axis, cycle,
                         with[i].controlword, without[i].controlword);
    if (!with[i].target) continue;
    const std::int64_t older = ages.between(*with[i].target, *without[i].target, cycle);
    const auto hits = static_cast<std::int64_t>(world.judge().hits_until(cycle));
    if (older > hits)
      return fmt::format("axis {}, cycle {}: the target is {} older than without node, after {}",
                         axis, cycle, older, hits);
  }
  if (with.size() != without.size())
    return fmt::format("axis {}: {} SYNCs, without node {}", axis, with.size(), without.size());
  return {};
}

}  // namespace

std::string difference_without_node(const ForwardedWorld& world) {
  TwinBus twin(world);
  twin.run();
  for (std::size_t a = 0; a < kForwardedAxes; ++a) {
    if (world.kinds()[a].watches_node) continue;  // leaves OPERATIONAL when the node is gone
    std::string found = difference(world, twin, a);
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace volcomp::sim
