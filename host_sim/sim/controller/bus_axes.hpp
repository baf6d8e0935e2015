#pragma once
// Axes on a CAN bus: motion controller, CiA 402 drives and compensation node exchange frames,
// and nothing else passes between them.

#include <memory>
#include <optional>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/sim/controller/axis_group.hpp"
#include "host_sim/sim/controller/bus_controller.hpp"
#include "host_sim/sim/controller/can_gateway.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/controller/simulated_bus.hpp"
#include "host_sim/sim/drives/cia402_drive.hpp"
#include "host_sim/sim/instruments/touch_probe.hpp"

namespace volcomp::sim {

class BusAxes final : public AxisGroup {
 public:
  // Node in the same process, time that of the simulated bus. `image`: tables for the node, empty
  // for an uncompensated machine.
  BusAxes(const host::BusSettings& settings, const std::vector<std::uint8_t>& image,
          hal::FrameLength length = hal::FrameLength::nominal);
  // Node somewhere on the bus behind `gateway`, which must outlive this. Cycles run in lock step:
  // the next SYNC leaves when the node has answered the last one. Machine time is counted in
  // cycles and may run faster or slower than the clock on the wall; not faster by more than a third
  // where the node judges SYNC by the clock.
  BusAxes(const host::BusSettings& settings, const std::vector<std::uint8_t>& image,
          CanGateway& gateway);

  // Only before the first cycle.
  void stand_at(const Pose& pose) override;
  // Throws UserError when the machine stops: a node went silent, was refused or lost its reference.
  void cycle(const host::Targets& target) override;
  [[nodiscard]] double period_s() const override { return period_us_ * 1e-6; }

  [[nodiscard]] host::Targets target() const override { return target_; }
  [[nodiscard]] host::Offsets offset() const override;
  [[nodiscard]] Pose position() const override;
  [[nodiscard]] Approach approach() const override;
  [[nodiscard]] double following_error() const override;
  [[nodiscard]] double largest_unit_nm() const override;
  [[nodiscard]] Latches latches() const override;
  [[nodiscard]] bool ramping() const override;
  using AxisGroup::watch;
  void watch(MachineWatch& watch);

  [[nodiscard]] BusController& controller() { return controller_; }
  [[nodiscard]] const BusController& controller() const { return controller_; }
  [[nodiscard]] SimulatedBus& bus() { return bus_; }
  [[nodiscard]] Cia402Drive& drive(std::size_t a) { return *drive_.at(a); }
  // The node in this process; nullptr when it is elsewhere.
  [[nodiscard]] const node::Node* node() const { return node_.get(); }

  // The mechanics of an axis are others from now on. They count in nm or 2^-31 turn, whatever the
  // drive does.
  void couple(std::size_t a, ForeignMechanics mechanics);
  // Targets as the drives are sent them: in their units. Throws UserError where 32 bits are too
  // few.
  [[nodiscard]] std::vector<std::int32_t> on_wire(const host::Targets& target) const;

  // Puts a probe on the tool, instead of any other; its signal reaches every drive. The drives
  // latch it only when the settings have `probes`.
  void mount(TouchProbe probe);
  // The line from the probe to one drive is broken, or whole again.
  void break_probe_line(std::size_t a, bool broken) { line_broken_.at(a) = broken; }

  // Without power: off the bus until it comes back, then as after any power-on.
  void power_drive(std::size_t a, bool on);
  void power_node(bool on);
  // While full, the port of the node takes nothing.
  void fill_node_port(bool full) { node_port_->refuse(full); }
  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }

  // One cycle whatever the state of the machine: targets, answers, SYNC.
  void run_cycle(const std::vector<std::int32_t>& path);
  // Cycles until the machine may move; throws UserError after `timeout_s` of machine time.
  void bring_up(double timeout_s = 20.0);

 private:
  void add_states(MachineSnapshot& snapshot) const override;
  void build(const host::BusSettings& settings);
  void attach(const Cia402Drive::Settings& settings, const std::string& name);
  [[nodiscard]] bool node_answers();
  [[nodiscard]] std::uint64_t shortest_cycle_us() const;
  void await_node();
  void serve_drive(std::size_t a, std::uint64_t now_us);
  void serve_drives(std::uint64_t now_us);
  void feel();
  [[nodiscard]] std::int64_t drive_units(std::size_t a, std::int64_t run_time_units) const;

  double period_us_;
  SimulatedBus bus_;
  BusController controller_;
  std::vector<std::unique_ptr<Cia402Drive>> drive_;
  std::vector<SimulatedBus::Port*> drive_port_;
  std::vector<Rest> drive_rest_;
  SimulatedBus::Port* controller_port_ = nullptr;
  SimulatedBus::Port* node_port_ = nullptr;
  std::unique_ptr<node::Node> node_;  // in this process
  CanGateway* gateway_ = nullptr;
  SimulatedBus::Port* gateway_port_ = nullptr;
  std::optional<TouchProbe> probe_;
  std::array<bool, host::kMostAxes> line_broken_{};
  Stance felt_{};                         // where the probe has felt last
  std::uint64_t served_ns_ = UINT64_MAX;  // when the drives were, with a probe
  std::uint64_t felt_periods_ = 0;        // of all drives together
  host::Targets target_{};
  std::vector<std::int64_t> sent_;  // in units of the drives, last cycle
  std::uint64_t next_sync_ns_ = 0;
  std::uint64_t cycles_ = 0;
  std::uint64_t reports_before_start_ = 0;  // status PDOs of a node elsewhere
  bool was_operational_ = false;            // as its last heartbeat said
  bool up_ = false;
};

// Puts the axes of a machine on a bus, with the node wherever it is.
using BusAxesFactory = std::function<std::unique_ptr<BusAxes>(
    const host::BusSettings& settings, const std::vector<std::uint8_t>& image)>;
[[nodiscard]] BusAxesFactory loopback_axes();
[[nodiscard]] BusAxesFactory gateway_axes(CanGateway& gateway);  // must outlive the axes
// Axes with drives as people own them: host::with_models().
[[nodiscard]] BusAxesFactory with_drives(BusAxesFactory make_axes, std::vector<std::string> names);
// Axes that are looked at from their first cycle; `watch` must outlive them.
[[nodiscard]] BusAxesFactory watched(BusAxesFactory make_axes, MachineWatch& watch);

// Cells for the scenarios, whatever their axes are.
[[nodiscard]] CellFactory bus_cells(const host::MachineFile& machine, double cycle_hz,
                                    BusAxesFactory make_axes = loopback_axes());

// Cycle on the bus at 1 Mbit/s: 500 Hz for three axes, 250 Hz for up to five.
inline constexpr double kBusCycle_hz = 500.0;
inline constexpr double kBusCycleOfFive_hz = 250.0;

}  // namespace volcomp::sim
