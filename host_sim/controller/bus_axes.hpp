#pragma once
// Three axes on a CAN bus: motion controller, CiA 402 drives and compensation node exchange frames,
// and nothing else passes between them.

#include <memory>
#include <vector>

#include "firmware/node/node.hpp"
#include "host_sim/controller/axis_group.hpp"
#include "host_sim/controller/bus_controller.hpp"
#include "host_sim/controller/can_gateway.hpp"
#include "host_sim/controller/motion_cell.hpp"
#include "host_sim/controller/simulated_bus.hpp"
#include "host_sim/drives/cia402_drive.hpp"

namespace volcomp::sim {

class BusAxes final : public AxisGroup {
 public:
  // Node in the same process, time that of the simulated bus. `image`: tables for the node, empty
  // for an uncompensated machine.
  BusAxes(const BusSettings& settings, const std::vector<std::uint8_t>& image,
          hal::FrameLength length = hal::FrameLength::nominal);
  // Node somewhere on the bus behind `gateway`, which must outlive this. Cycles run in lock step:
  // the next SYNC leaves when the node has answered the last one. Machine time is counted in
  // cycles and may run faster or slower than the clock on the wall.
  BusAxes(const BusSettings& settings, const std::vector<std::uint8_t>& image, CanGateway& gateway);

  // Only before the first cycle.
  void stand_at(const Vec3& mm) override;
  // Throws UserError when the machine stops: somebody went silent, was refused or lost a reference.
  void cycle(const TargetsNm& target) override;
  [[nodiscard]] double period_s() const override { return period_us_ * 1e-6; }

  [[nodiscard]] TargetsNm target_nm() const override { return target_; }
  [[nodiscard]] OffsetsNm offset_nm() const override;
  [[nodiscard]] Pose position() const override;
  [[nodiscard]] Approach approach() const override;
  [[nodiscard]] double following_error_nm() const override;
  [[nodiscard]] bool ramping() const override;

  [[nodiscard]] BusController& controller() { return controller_; }
  [[nodiscard]] SimulatedBus& bus() { return bus_; }
  [[nodiscard]] Cia402Drive& drive(std::size_t a) { return *drive_.at(a); }
  // The node in this process; nullptr when it is elsewhere.
  [[nodiscard]] const node::Node* node() const { return node_.get(); }

  // Without power: off the bus until it comes back, then as after any power-on.
  void power_drive(std::size_t a, bool on);
  void power_node(bool on);
  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }

  // One cycle whatever the state of the machine: targets, answers, SYNC.
  void run_cycle(const std::vector<std::int32_t>& path);
  // Cycles until the machine may move; throws UserError after `timeout_s` of machine time.
  void bring_up(double timeout_s = 20.0);

 private:
  void build(const BusSettings& settings);
  void await_node();

  double period_us_;
  SimulatedBus bus_;
  BusController controller_;
  std::vector<std::unique_ptr<Cia402Drive>> drive_;
  std::vector<SimulatedBus::Port*> drive_port_;
  SimulatedBus::Port* node_port_ = nullptr;
  std::unique_ptr<node::Node> node_;  // in this process
  CanGateway* gateway_ = nullptr;
  SimulatedBus::Port* gateway_port_ = nullptr;
  TargetsNm target_{};
  std::uint64_t next_sync_ns_ = 0;
  std::uint64_t cycles_ = 0;
  bool up_ = false;
};

// Cell factories for the scenarios.
[[nodiscard]] CellFactory loopback_cells(const MachineFile& machine, double cycle_hz);
[[nodiscard]] CellFactory gateway_cells(const MachineFile& machine, double cycle_hz,
                                        CanGateway& gateway);

// Cycle on the bus: 500 Hz for three axes (architecture page: 1 Mbit/s).
inline constexpr double kBusCycle_hz = 500.0;

}  // namespace volcomp::sim
