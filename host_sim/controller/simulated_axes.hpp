#pragma once
// Three simulated axes behind the HAL of the integrated form: targets go to the compensator, its
// offsets to the drives.

#include <algorithm>
#include <array>
#include <cmath>

#include "comp/realtime/instances.hpp"
#include "comp/units.hpp"
#include "host_sim/controller/axis_group.hpp"
#include "host_sim/drives/axis_drive.hpp"

namespace volcomp::sim {

class SimulatedAxes {
 public:
  static constexpr std::size_t kSlots = LoadedCompensator::kAxes;

  SimulatedAxes(double period_s, double time_constant_s)
      : drive_{AxisDrive(period_s, time_constant_s), AxisDrive(period_s, time_constant_s),
               AxisDrive(period_s, time_constant_s)} {}

  // --- the controller's side
  void set_target(const TargetsNm& target) { target_nm_ = target; }
  void stand_at(const TargetsNm& position) {
    set_target(position);
    for (std::size_t a = 0; a < kGroupAxes; ++a)
      drive_[a].stand_at(target_nm_[a]);
  }

  // --- the compensation's side (hal/axis_port.hpp)
  void sample(TickInput<kSlots>& in) const {
    for (std::size_t a = 0; a < kGroupAxes; ++a)
      in.axis[a] = {target_nm_[a], true, true};
  }
  void apply(const TickOutput<kSlots>& out) {
    for (std::size_t a = 0; a < kGroupAxes; ++a) {
      offset_nm_[a] = out.offset[a];
      drive_[a].command(target_nm_[a] + out.offset[a]);
    }
  }

  // --- what the world sees
  [[nodiscard]] const TargetsNm& target_nm() const { return target_nm_; }
  [[nodiscard]] const OffsetsNm& offset_nm() const { return offset_nm_; }
  [[nodiscard]] Pose position() const {
    Pose q{};
    for (std::size_t a = 0; a < kGroupAxes; ++a)
      q[a] = drive_[a].position_mm();
    return q;
  }
  [[nodiscard]] Approach approach() const {
    Approach from{};
    for (std::size_t a = 0; a < kGroupAxes; ++a)
      from[a] = drive_[a].approach();
    return from;
  }
  // Largest distance between an axis and its command.
  [[nodiscard]] double following_error_nm() const {
    double worst = 0.0;
    for (std::size_t a = 0; a < kGroupAxes; ++a) {
      const auto commanded = static_cast<double>(target_nm_[a] + offset_nm_[a]);
      worst = std::max(worst, std::abs(commanded - drive_[a].position_mm() * kNmPerMm));
    }
    return worst;
  }

 private:
  std::array<AxisDrive, kGroupAxes> drive_;
  TargetsNm target_nm_{};
  OffsetsNm offset_nm_{};
};

}  // namespace volcomp::sim
