#pragma once
// The integrated form: the compensator inside the servo interrupt of the controller, simulated
// drives behind the HAL.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "comp/core/units.hpp"
#include "comp/tick/instances.hpp"
#include "firmware/embed/cpp/servo_loop.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/controller/axis_group.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/drives/cia402_axis.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Simulated axes behind the HAL of the integrated form: targets go to the compensator, its offsets
// to the drives.
class SimulatedAxes {
 public:
  static constexpr std::size_t kSlots = LoadedCompensator::kAxes;

  SimulatedAxes(const host::AxisKinds& kinds, double period_s, double time_constant_s)
      : kinds_(kinds), drive_(kinds.count, AxisDrive(period_s, time_constant_s)) {}

  // --- the controller's side
  void set_target(const host::Targets& target) { target_ = target; }
  void stand_at(const Pose& pose) {
    set_target(kinds_.targets(pose));
    for (std::size_t a = 0; a < drive_.size(); ++a)
      drive_[a].stand_at(drive_units(a, target_[a]));
  }

  // --- the compensation's side (firmware/embed/cpp/axis_port.hpp)
  void sample(TickInput<kSlots>& in) const {
    for (std::size_t a = 0; a < drive_.size(); ++a)
      in.axis[a] = {target_[a], true, true};
  }
  void apply(const TickOutput<kSlots>& out) {
    // Offsets of rotary axes come in 2^-32 turn.
    constexpr std::int64_t kFiner = 256;
    for (std::size_t a = 0; a < drive_.size(); ++a) {
      offset_[a] = out.offset[a] * (kinds_.rotary[a] ? kFiner : 1);
      drive_[a].command(drive_units(a, target_[a] + offset_[a]));
    }
  }

  // --- what the world sees
  [[nodiscard]] const host::Targets& target() const { return target_; }
  [[nodiscard]] const host::Offsets& offset() const { return offset_; }
  [[nodiscard]] Pose position() const {
    Pose q{};
    for (std::size_t a = 0; a < drive_.size(); ++a)
      q[a] = kinds_.rotary[a] ? counted(a) * (2.0 * kPi / kDriveUnitsPerTurn)
                              : drive_[a].position_mm();
    return q;
  }
  [[nodiscard]] Approach approach() const {
    Approach from{};
    for (std::size_t a = 0; a < drive_.size(); ++a)
      from[a] = drive_[a].approach();
    return from;
  }
  // Largest distance between an axis and its command, drive units.
  [[nodiscard]] double following_error() const {
    double worst = 0.0;
    for (std::size_t a = 0; a < drive_.size(); ++a) {
      const auto commanded = static_cast<double>(drive_units(a, target_[a] + offset_[a]));
      worst = std::max(worst, std::abs(commanded - counted(a)));
    }
    return worst;
  }

 private:
  // Nearest unit of the drive, 1 nm or 2^-31 turn.
  [[nodiscard]] std::int64_t drive_units(std::size_t a, std::int64_t run_time_units) const {
    if (!kinds_.rotary[a]) return run_time_units;
    return (run_time_units + 256) >> 9;
  }
  [[nodiscard]] double counted(std::size_t a) const { return drive_[a].position_mm() * kNmPerMm; }

  host::AxisKinds kinds_;
  std::vector<AxisDrive> drive_;
  host::Targets target_{};
  host::Offsets offset_{};
};

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
