#pragma once
// The axes of a machine under compensation, moved one control period at a time. The implementation
// decides what carries the targets to the drives: a servo interrupt or a bus.

#include <memory>
#include <string>

#include "host_sim/host/machine/axis_kinds.hpp"
#include "host_sim/sim/controller/machine_watch.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// What has been reported of the touch probe input of one axis.
struct AxisLatch {
  std::uint64_t count = 0;    // latches reported so far
  double position = 0.0;      // of the last one: encoder, offset included, mm or rad
  std::uint32_t time_ns = 0;  // of the last one, since the SYNC before it
};
using Latches = std::array<AxisLatch, host::kMostAxes>;

class AxisGroup {
 public:
  AxisGroup() = default;
  AxisGroup(const AxisGroup&) = delete;
  AxisGroup& operator=(const AxisGroup&) = delete;
  virtual ~AxisGroup() = default;

  // Puts the axes somewhere (mm, rad) without a journey. The compensation sees a jump of position.
  virtual void stand_at(const Pose& pose) = 0;
  // One control period: the drives take the target and the offset that belongs to it together.
  virtual void cycle(const host::Targets& target) = 0;
  [[nodiscard]] virtual double period_s() const = 0;

  // What the world sees after the last period.
  [[nodiscard]] virtual host::Targets target() const = 0;
  [[nodiscard]] virtual host::Offsets offset() const = 0;  // as taken by the drives
  [[nodiscard]] virtual Pose position() const = 0;         // of the encoders, offset included
  [[nodiscard]] virtual Approach approach() const = 0;
  // Largest distance between an axis and its target plus offset: nm, or 2^-31 turn.
  [[nodiscard]] virtual double following_error() const = 0;
  // What targets and offsets of a linear axis are rounded to, the largest of them.
  [[nodiscard]] virtual double largest_unit_nm() const { return 1.0; }
  // None where no probe is mounted.
  [[nodiscard]] virtual Latches latches() const { return {}; }
  // A ramp of the compensation is running: offsets change while the targets stand still.
  [[nodiscard]] virtual bool ramping() const = 0;

  // From the next period on; `watch` must outlive the axes. `letters`: a name for each axis.
  void watch(MachineWatch& watch, std::string letters, const host::AxisKinds& kinds);

 protected:
  // To be called at the end of every period.
  void show();
  // Internal states of drives, node and bus.
  virtual void add_states(MachineSnapshot& /*snapshot*/) const {}

 private:
  std::unique_ptr<MachineObserver> observer_;  // null: nothing looks on
  std::string letters_;
  host::AxisKinds kinds_;
  MachineSnapshot snapshot_;
};

}  // namespace volcomp::sim
