#pragma once
// Three simulated axes behind the HAL of the integrated form: targets go to the compensator, its
// offsets to the drives.

#include <array>

#include "comp/geometry/frame.hpp"
#include "comp/realtime/instances.hpp"
#include "comp/units.hpp"
#include "host_sim/drives/axis_drive.hpp"
#include "host_sim/machine/true_machine.hpp"

namespace volcomp::sim {

class SimulatedAxes {
 public:
  static constexpr std::size_t kSlots = LoadedCompensator::kAxes;

  SimulatedAxes(double period_s, double time_constant_s)
      : drive_{AxisDrive(period_s, time_constant_s), AxisDrive(period_s, time_constant_s),
               AxisDrive(period_s, time_constant_s)} {}

  // --- the controller's side
  void set_target(const Vec3& mm) {
    for (std::size_t a = 0; a < 3; ++a)
      target_nm_[a] = to_nm(mm(static_cast<Eigen::Index>(a)));
  }
  void stand_at(const Vec3& mm) {
    set_target(mm);
    for (std::size_t a = 0; a < 3; ++a)
      drive_[a].stand_at(target_nm_[a]);
  }

  // --- the compensation's side (hal/axis_port.hpp)
  void sample(TickInput<kSlots>& in) const {
    for (std::size_t a = 0; a < 3; ++a)
      in.axis[a] = {target_nm_[a], true, true};
  }
  void apply(const TickOutput<kSlots>& out) {
    for (std::size_t a = 0; a < 3; ++a) {
      offset_nm_[a] = out.offset[a];
      drive_[a].command(target_nm_[a] + out.offset[a]);
    }
  }

  // --- what the world sees
  [[nodiscard]] const std::array<std::int64_t, 3>& target_nm() const { return target_nm_; }
  [[nodiscard]] const std::array<std::int32_t, 3>& offset_nm() const { return offset_nm_; }
  [[nodiscard]] Pose position() const {
    Pose q{};
    for (std::size_t a = 0; a < 3; ++a)
      q[a] = drive_[a].position_mm();
    return q;
  }
  [[nodiscard]] Approach approach() const {
    Approach from{};
    for (std::size_t a = 0; a < 3; ++a)
      from[a] = drive_[a].approach();
    return from;
  }
  // Largest distance between an axis and its command.
  [[nodiscard]] double following_error_nm() const {
    double worst = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto commanded = static_cast<double>(target_nm_[a] + offset_nm_[a]);
      worst = std::max(worst, std::abs(commanded - drive_[a].position_mm() * kNmPerMm));
    }
    return worst;
  }

 private:
  std::array<AxisDrive, 3> drive_;
  std::array<std::int64_t, 3> target_nm_{};
  std::array<std::int32_t, 3> offset_nm_{};
};

}  // namespace volcomp::sim
