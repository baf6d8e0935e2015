#pragma once
// The integrated form: the compensator inside the servo interrupt of the controller, simulated
// drives behind the HAL.

#include <memory>
#include <vector>

#include "comp/tick/instances.hpp"
#include "firmware/embed/cpp/servo_loop.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/controller/axis_group.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/controller/simulated_axes.hpp"

namespace volcomp::sim {

class IntegratedAxes final : public AxisGroup {
 public:
  // `image`: table image of the compensation, empty for an uncompensated machine. The image goes
  // the whole way: decoded, validated, folded, activated, ramped in. Throws UserError.
  IntegratedAxes(const host::AxisKinds& kinds, const host::CorrectionFile& settings,
                 const std::vector<std::uint8_t>& image);

  void stand_at(const Pose& pose) override { axes_.stand_at(pose); }
  void cycle(const host::Targets& target) override;
  [[nodiscard]] double period_s() const override { return period_s_; }

  [[nodiscard]] host::Targets target() const override { return axes_.target(); }
  [[nodiscard]] host::Offsets offset() const override { return axes_.offset(); }
  [[nodiscard]] Pose position() const override { return axes_.position(); }
  [[nodiscard]] Approach approach() const override { return axes_.approach(); }
  [[nodiscard]] double following_error() const override { return axes_.following_error(); }
  [[nodiscard]] bool ramping() const override;

 private:
  void add_states(MachineSnapshot& snapshot) const override;

  double period_s_;
  SimulatedAxes axes_;
  std::unique_ptr<OrientingCompensator> compensator_;
  ServoLoop<OrientingCompensator, SimulatedAxes> loop_;
};

// A CellFactory: one servo period per 1 / tick_hz of the machine file.
[[nodiscard]] std::unique_ptr<MotionCell> make_integrated_cell(
    const TrueMachine& machine, const host::CorrectionFile& correction,
    const std::vector<std::uint8_t>& image);

// The same with axes of these letters that are looked at; `watch` must outlive the cells.
[[nodiscard]] CellFactory watched_integrated_cells(std::string letters, MachineWatch& watch);

}  // namespace volcomp::sim
