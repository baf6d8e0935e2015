#pragma once
// A tool that changes a simulated drive for a while, killed or interrupted where a test wants it.

#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_sim/host/bus/drive_check/drive_changes.hpp"
#include "host_sim/host/bus/drive_check/drive_ready.hpp"
#include "host_sim/host/bus/drive_check/mapping_trial.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "tests/host_sim/host/bus/drive_bench.hpp"

namespace volcomp::host {

// The process is gone: nothing of it runs any more.
struct Killed {};

// All that a drive holds.
struct DriveState {
  explicit DriveState(sim::Cia402Drive& drive) : objects(sizeof(Cia402Objects)) {
    std::memcpy(objects.data(), &drive.objects(), objects.size());
    for (const canopen::Pdo& pdo : drive.device().pdos().receive())
      receive.push_back(pdo.parameters());
    for (const canopen::Pdo& pdo : drive.device().pdos().transmit())
      transmit.push_back(pdo.parameters());
  }
  std::vector<std::uint8_t> objects;
  std::vector<canopen::PdoParameters> receive;
  std::vector<canopen::PdoParameters> transmit;
};

inline bool same(const canopen::PdoParameters& a, const canopen::PdoParameters& b) {
  return a.cob_id == b.cob_id && a.type == b.type && a.inhibit_100us == b.inhibit_100us &&
         a.event_timer_ms == b.event_timer_ms && a.count == b.count && a.mapping == b.mapping;
}

inline bool same(const std::vector<canopen::PdoParameters>& a,
                 const std::vector<canopen::PdoParameters>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return same(x, y); });
}

inline bool same(const DriveState& a, const DriveState& b) {
  return a.objects == b.objects && same(a.receive, b.receive) && same(a.transmit, b.transmit);
}

// A valid PDO is one that nobody has touched.
inline bool no_trial_is_valid(const DriveState& before, const DriveState& now) {
  const auto untouched = [](const auto& was, const auto& is) {
    return (is.cob_id & canopen::kPdoInvalid) != 0 || same(was, is);
  };
  return std::equal(before.receive.begin(), before.receive.end(), now.receive.begin(), untouched) &&
         std::equal(before.transmit.begin(), before.transmit.end(), now.transmit.begin(),
                    untouched);
}

// Thousands of journals: in memory where there is such a place.
inline std::filesystem::path quick_place() {
  const std::filesystem::path memory = "/dev/shm";
  std::error_code none;
  return std::filesystem::is_directory(memory, none) ? memory
                                                     : std::filesystem::temp_directory_path();
}

// A drive of a profile on a bus, the process of a tool, and its journal.
class TrialBench {
 public:
  explicit TrialBench(const std::string& profile_name, sim::Cia402Drive::Settings settings = {})
      : drive(with_profile(profile_name, std::move(settings))) {
    bus.attach(drive, "drive");
    bus.attach_served("tool", [this](sim::SimulatedBus::Port& port, std::uint64_t now_us) {
      canopen::exchange(*tool, port, now_us);
    });
    start_process();
    drive.power_on(0);
    run_ms(3);
    read = read_drive(*tool);
    identity = read_identity(*tool);
    before.emplace(drive);
    bus.bus().set_observer([this](std::uint64_t, const hal::CanFrame& frame,
                                  const hal::LoopbackBus::Port&) { observe(frame); });
  }

  static sim::Cia402Drive::Settings with_profile(const std::string& name,
                                                 sim::Cia402Drive::Settings settings) {
    settings.node_id = kDrive;
    if (!name.empty()) settings.profile = profile(name);
    return settings;
  }

  void start_process() {
    killed_after = kNever;
    tool = std::make_unique<NodeClient>(kDrive, [this](NodeClient&) {
      run_ms(1);
      // Before the process has seen the answer.
      if (killed_after == 0) throw Killed();
      return bus.now_us();
    });
  }

  void run_ms(std::uint64_t ms) { bus.run_until(bus.bus().now_ns() + ms * 1'000'000U); }

  // Requests that write: expedited downloads begin with 001.
  void observe(const hal::CanFrame& frame) {
    if (frame.id == 0x600 + kDrive && frame.data[0] >> 5U == 1)
      written.insert(static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8U));
    if (frame.id == 0x600 + kDrive || frame.id == 0x580 + kDrive) ++sdo_frames;
    if (killed_after > 0 && killed_after != kNever) --killed_after;
    always_invalid = always_invalid && no_trial_is_valid(*before, DriveState(drive));
  }

  [[nodiscard]] DriveChanges changes(const DriveChanges::Check& check = {}) {
    return DriveChanges(*tool, journal(), {"can0", kDrive, identity}, check);
  }
  [[nodiscard]] std::filesystem::path journal() const { return folder.path() / "can0-3.journal"; }

  TriedMappings try_all(const DriveChanges::Check& check = {}) {
    DriveChanges all = changes(check);
    return try_mappings(all, read, pdos_for_trial(read, {}));
  }

  // What any command does first, in a new process.
  Restored call_again() {
    start_process();
    auto left = DriveJournal::open(journal());
    return left ? restore(*tool, *left) : Restored{};
  }

  [[nodiscard]] bool is_as_before() { return same(*before, DriveState(drive)); }

  static constexpr std::size_t kNever = SIZE_MAX;
  TemporaryFolder folder{quick_place()};
  sim::SimulatedBus bus;
  sim::Cia402Drive drive;
  std::unique_ptr<NodeClient> tool;
  ForeignDrive read;
  std::array<std::uint32_t, 4> identity{};
  std::optional<DriveState> before;
  std::set<std::uint16_t> written;
  std::size_t killed_after = kNever;  // frames
  std::size_t sdo_frames = 0;
  bool always_invalid = true;
};

}  // namespace volcomp::host
