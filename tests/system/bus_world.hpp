#pragma once
// A machine on the bus that moves about, and its disturbances. Shared by the bus tests and the
// soak.

#include <memory>
#include <string>
#include <vector>

#include "host_sim/host/bus/sdo_channel.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::sim {

// The XYFZ machine as commissioned without noise, at the cycle of the bus, and two images of it
// that differ in their values.
inline constexpr std::size_t kBusMachineAxes = 3;
struct BusMachine {
  host::MachineFile file;
  TrueMachine truth;
  std::unique_ptr<host::BuiltTables> built;
  std::vector<std::uint8_t> image;
  std::vector<std::uint8_t> other_image;
};
[[nodiscard]] const BusMachine& bus_machine();
// Whether they report the offset they hold: all, none, all but the first.
enum class Drives : std::uint8_t { confirm, trust, trust_first };
[[nodiscard]] host::BusSettings bus_machine_settings(Drives drives = Drives::confirm);

// Another participant on the bus: an SDO client to the compensation node, and single frames.
class Intruder {
 public:
  explicit Intruder(SimulatedBus& bus);

  void send(const hal::CanFrame& frame) { static_cast<void>(port_->send(frame)); }
  void connect(bool on) { port_->connect(on); }
  [[nodiscard]] host::SdoChannel& sdo() { return sdo_; }

  void receive(const hal::CanFrame& frame, std::uint64_t now_us) { sdo_.receive(frame, now_us); }
  void poll(std::uint64_t now_us) { sdo_.poll(now_us); }
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t /*now_us*/) {
    return sdo_.offer(frame);
  }
  void taken(std::uint64_t /*now_us*/) { sdo_.taken(); }

 private:
  host::SdoChannel sdo_;
  SimulatedBus::Port* port_;
};

class BusWorld {
 public:
  explicit BusWorld(std::uint64_t seed,
                    const std::vector<std::uint8_t>& image = bus_machine().image,
                    Drives drives = Drives::confirm);

  // The axes travel between random places inside the travel, each at its set speed, and stop while
  // the controller forbids motion.
  void run(int cycles);
  // Stays where it is.
  void stand(int cycles);
  // Moves straight to a place and stands there until nothing changes any more. False when that
  // takes too long.
  [[nodiscard]] bool go_to(const Vec3& mm);
  // To one place, always from the same side.
  [[nodiscard]] bool approach();
  // Runs until everything is as after a bring-up: motion allowed, node compensating, no error in
  // its register nor message waiting. False after `most` cycles.
  [[nodiscard]] bool recover(int most);
  // What is missing for that.
  [[nodiscard]] std::string trouble();

  // Goes on moving whatever the controller commands.
  void keep_moving(bool on) { keep_moving_ = on; }

  // Emergency messages since mark(): whether one with this code came from this node.
  void mark() { mark_ = axes_.controller().emergencies().size(); }
  [[nodiscard]] bool emergency(std::uint8_t node, std::uint16_t code);
  // Codes since mark(), for messages.
  [[nodiscard]] std::string emergencies();

  // What was wrong at the inputs of the drives since the beginning; empty: nothing. A step above
  // the slew limit or an offset above the limit.
  [[nodiscard]] const std::string& violation() const { return violation_; }
  [[nodiscard]] std::int32_t largest_step() const { return largest_step_; }
  void forget_steps() { largest_step_ = 0; }
  [[nodiscard]] std::uint64_t inputs() const { return inputs_; }

  [[nodiscard]] BusAxes& axes() { return axes_; }
  [[nodiscard]] BusController& controller() { return axes_.controller(); }
  [[nodiscard]] hal::LoopbackBus& bus() { return axes_.bus().bus(); }
  [[nodiscard]] Intruder& intruder() { return intruder_; }
  [[nodiscard]] const node::NodeObjects& node() const { return axes_.node()->objects(); }
  [[nodiscard]] host::Offsets offsets() const { return axes_.offset(); }
  [[nodiscard]] std::uint64_t cycles() const { return axes_.cycles(); }

 private:
  void watch(std::size_t axis);
  void step(const std::vector<std::int32_t>& goal);
  [[nodiscard]] bool at(const std::vector<std::int32_t>& goal) const { return path_ == goal; }
  void choose_goal();
  void vouch();

  Drives drives_;
  std::size_t vouched_ = 0;
  Random random_;
  BusAxes axes_;
  Intruder intruder_;
  std::vector<std::int32_t> path_;
  std::vector<std::int32_t> goal_;
  std::int32_t step_nm_ = 200'000;
  std::string violation_;
  std::int32_t largest_step_ = 0;
  std::uint64_t inputs_ = 0;
  std::size_t mark_ = 0;
  bool keep_moving_ = false;
};

}  // namespace volcomp::sim
