#pragma once
// Three linear axes under compensation, moved one control period at a time. What carries the
// targets to the drives, a servo interrupt or a bus, is the matter of the implementation.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/geometry/frame.hpp"
#include "comp/units.hpp"
#include "host_sim/machine/true_machine.hpp"

namespace volcomp::sim {

inline constexpr std::size_t kGroupAxes = 3;

// By NC axis, in nm: the command of one period, without any offset.
using TargetsNm = std::array<std::int64_t, kGroupAxes>;
using OffsetsNm = std::array<std::int32_t, kGroupAxes>;

[[nodiscard]] inline TargetsNm to_targets(const Vec3& mm) {
  return {to_nm(mm.x()), to_nm(mm.y()), to_nm(mm.z())};
}

class AxisGroup {
 public:
  AxisGroup() = default;
  AxisGroup(const AxisGroup&) = delete;
  AxisGroup& operator=(const AxisGroup&) = delete;
  virtual ~AxisGroup() = default;

  // Puts the axes somewhere without a journey. The compensation sees a jump of position.
  virtual void stand_at(const Vec3& mm) = 0;
  // One control period: the drives take the target and the offset that belongs to it together.
  virtual void cycle(const TargetsNm& target) = 0;
  [[nodiscard]] virtual double period_s() const = 0;

  // What the world sees after the last period.
  [[nodiscard]] virtual TargetsNm target_nm() const = 0;
  [[nodiscard]] virtual OffsetsNm offset_nm() const = 0;  // as taken by the drives
  [[nodiscard]] virtual Pose position() const = 0;        // of the encoders, mm, offset included
  [[nodiscard]] virtual Approach approach() const = 0;
  // Largest distance between an axis and its target plus offset.
  [[nodiscard]] virtual double following_error_nm() const = 0;
  // A ramp of the compensation is running: offsets change while the targets stand still.
  [[nodiscard]] virtual bool ramping() const = 0;
};

}  // namespace volcomp::sim
