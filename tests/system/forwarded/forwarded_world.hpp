#pragma once
// Three simulated drives that take their targets from the node (way 1), their controller, and
// everything that can go wrong between them. Each may behave as no data sheet tells
// (DriveBehaviour), and have RPDOs that act at SYNC or when they come.
//
// What the controller put on the bus, and what befell it on its way to the drives, is kept: a twin
// bus without node gets the same (forwarded_twin.hpp).

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/sim/controller/bus_controller.hpp"
#include "host_sim/sim/controller/simulated_bus.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "tests/system/forwarded/forwarded_judge.hpp"

namespace volcomp::sim {

// A drive beyond its data sheet.
struct DriveKind {
  DriveBehaviour behaviour;
  bool controlword_at_once = false;            // RPDO1 of type 255, whatever is written
  bool target_at_once = false;                 // RPDO2
  bool watches_node = true;                    // 1016h has a second entry
  std::uint16_t watch_ms = 0;                  // its time; 0: that of the settings
  std::uint32_t following_window = 5'000'000;  // 6065h, nm
  std::uint16_t following_timeout_ms = 0;      // 6066h
  std::uint32_t deceleration = 2'000'000'000;  // 6085h, nm/s²
};
using DriveKinds = std::array<DriveKind, kForwardedAxes>;

// Shares of the frames to each receiver.
struct BusDisorder {
  double lost = 0.0;
  double twice = 0.0;
  double late = 0.0;  // at most two cycles, so that later frames overtake
};

// A frame as it was on the bus, and what happens to the drives themselves.
struct BusEvent {
  std::uint64_t begin_ns;
  std::uint64_t cycle;
  hal::CanFrame frame;
};
struct DriveEvent {
  enum class Kind : std::uint8_t {
    power_off,
    power_on,
    off_bus,
    on_bus,
    lose_reference,
    deaf,  // hears no SYNC
    hears,
  };
  std::uint64_t cycle;
  std::size_t axis;
  Kind kind;
};

inline constexpr std::uint64_t kForwardedPeriod_us = 2000;
inline constexpr std::int32_t kForwardedBegin_nm = -200'000'000;

[[nodiscard]] Cia402Drive::Settings drive_settings(std::size_t axis, const DriveKind& kind);
// All but what becomes of SYNC.
void apply(const DriveEvent& event, Cia402Drive& drive, SimulatedBus::Port& port,
           std::uint64_t now_us);

// The fate of the frames of a controller on their way to a drive: the same in every bus with this
// seed, whoever else sends.
class SharedFates {
 public:
  SharedFates(std::uint64_t seed, const BusDisorder& disorder) : seed_(seed), disorder_(disorder) {}
  // A frame is at its end. Then its fate at each drive, by number.
  void count(const hal::CanFrame& frame) { ordinal_ = ++count_[frame.id]; }
  [[nodiscard]] hal::LoopbackBus::Fate at(const hal::CanFrame& frame, std::size_t axis) const;

 private:
  std::uint64_t seed_;
  BusDisorder disorder_;
  std::map<std::uint16_t, std::uint64_t> count_;
  std::uint64_t ordinal_ = 0;
};

// Makes a frame to a drive what this kind of drive makes of it.
[[nodiscard]] hal::CanFrame as_taken_by(const DriveKind& kind, hal::CanFrame frame);

class ForwardedWorld {
 public:
  ForwardedWorld(std::uint64_t seed, host::BusSettings settings, const DriveKinds& kinds,
                 const BusDisorder& disorder);

  // Until the axes may move; false when they may not after 4000 cycles.
  [[nodiscard]] bool bring_up();
  // From now on frames are lost, doubled and late.
  void disturb() { disturbed_from_ = cycle_; }
  // One cycle; each axis that follows goes on by `step`.
  void cycle(const std::array<std::int32_t, kForwardedAxes>& step);

  void power_node(bool on);
  void stall_node(bool on) { stalled_ = on; }
  void fill_node_port(bool on) {
    full_ = on;
    node_port_->refuse(on);
  }
  void silence_controller(bool on) { controller_port_->connect(!on); }
  void restart_controller() { controller_.power_on(bus_.now_us()); }
  // 6040h for every drive in place of what the controller would send; nothing: what it sends.
  void command(std::optional<std::uint16_t> controlword) { controlword_ = controlword; }
  // The controller goes on hearing that the node is well (180h + 32), though it is dead.
  void pretend_node(bool on) { pretends_ = on; }
  void to_drive(std::size_t axis, DriveEvent::Kind kind);
  // SYNC does not reach the node.
  void deafen_node(bool on) { deaf_node_ = on; }
  // Somebody else on the bus.
  void send(const hal::CanFrame& frame) { static_cast<void>(intruder_->send(frame)); }

  [[nodiscard]] BusController& controller() { return controller_; }
  [[nodiscard]] node::Node& node() { return node_; }
  [[nodiscard]] Cia402Drive& drive(std::size_t axis) { return *drive_.at(axis); }
  [[nodiscard]] const ForwardedJudge& judge() const { return judge_; }
  [[nodiscard]] std::uint64_t cycles() const { return cycle_; }
  [[nodiscard]] const std::vector<BusEvent>& controller_frames() const { return said_; }
  [[nodiscard]] const std::vector<DriveEvent>& drive_events() const { return drive_events_; }
  [[nodiscard]] const DriveKinds& kinds() const { return kinds_; }
  [[nodiscard]] const host::BusSettings& settings() const { return controller_.settings(); }
  [[nodiscard]] SharedFates fates() const { return {seed_, disorder_}; }
  // Cycle of disturb().
  [[nodiscard]] std::uint64_t disturbed_from() const { return disturbed_from_; }

 private:
  void attach_controller();
  void attach_node();
  void attach_drives();
  void pretend();
  void note(std::uint64_t time_ns, const hal::CanFrame& frame, const SimulatedBus::Port& sender);
  [[nodiscard]] hal::LoopbackBus::Fate fate(const hal::CanFrame& frame,
                                            const SimulatedBus::Port& sender,
                                            const SimulatedBus::Port& receiver);
  [[nodiscard]] hal::LoopbackBus::Fate any_fate(bool of_node);
  [[nodiscard]] bool of_controller(const SimulatedBus::Port& port) const {
    return &port == controller_port_ || &port == intruder_;
  }

  std::uint64_t seed_;
  DriveKinds kinds_;
  BusDisorder disorder_;
  SharedFates fates_;
  Random random_;
  SimulatedBus bus_;
  BusController controller_;
  node::Node node_;
  std::array<std::unique_ptr<Cia402Drive>, kForwardedAxes> drive_;
  std::array<SimulatedBus::Port*, kForwardedAxes> drive_port_{};
  SimulatedBus::Port* controller_port_ = nullptr;
  SimulatedBus::Port* node_port_ = nullptr;
  SimulatedBus::Port* intruder_ = nullptr;
  ForwardedJudge judge_;
  std::vector<BusEvent> said_;
  std::vector<DriveEvent> drive_events_;
  std::array<bool, kForwardedAxes> deaf_{};
  std::vector<std::int32_t> path_;
  std::uint64_t cycle_ = 0;
  std::uint64_t disturbed_from_ = UINT64_MAX;
  bool deaf_node_ = false;
  bool stalled_ = false;
  bool dead_ = false;
  bool full_ = false;
  bool served_ = false;
  bool pretends_ = false;
  std::optional<std::uint16_t> controlword_;
};

}  // namespace volcomp::sim
