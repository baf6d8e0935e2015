#pragma once
// What the controller of the grinder commands, SYNC by SYNC: C indexes to the next slot while the
// wheel stands outside the face, then Z and C follow the helix, up and down in turns.

#include "host_sim/experiments/internal_helical/constants.hpp"
#include "host_sim/host/bus/watched_strokes.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/controller/straight_move.hpp"

namespace volcomp::internal_helical {

// The targets that the drives take at one SYNC, in their units, and what is done at them.
struct StrokeStep : host::ProcessState {
  std::int64_t x = 0;  // nm
  std::int64_t z = 0;  // nm
  std::int64_t c = 0;  // 2^-31 turn, counted through
};

class StrokePlan {
 public:
  // `x_mm`: distance of the wheel from the axis of the gear.
  StrokePlan(const host::GrindingFile& job, double x_mm);

  // Where the machine stands now, outside the face: before the first pass, or after the last one.
  [[nodiscard]] const StrokeStep& standing() const { return standing_; }

  // The next slot and the other way; pass k grinds slot k modulo the teeth, so that with an odd
  // number of teeth every slot is ground the other way in the next round.
  void begin_pass();
  [[nodiscard]] int index_ticks() const;
  [[nodiscard]] int stroke_ticks() const;
  // Steps of the pass, from tick 0 on.
  [[nodiscard]] StrokeStep index(int tick) const;
  [[nodiscard]] StrokeStep stroke(int tick) const;
  // The machine stands where its last stroke has ended.
  void end_pass();

 private:
  // `turned`: C, rad, while Z is at 0.
  [[nodiscard]] StrokeStep at(double z_mm, double turned) const;
  [[nodiscard]] Direction way() const {
    return pass_ % 2 == 0 ? Direction::forward : Direction::backward;
  }
  [[nodiscard]] double travel_mm() const { return job_.width_mm + 2.0 * job_.overrun_mm; }
  [[nodiscard]] double begin_mm() const {  // of the stroke
    return way() == Direction::forward ? -0.5 * travel_mm() : 0.5 * travel_mm();
  }
  [[nodiscard]] double slot_rad() const { return 2.0 * kPi / job_.gear.teeth; }

  host::GrindingFile job_;
  std::int64_t x_;
  sim::Trapezoid stroke_;
  sim::Trapezoid index_;
  long pass_ = 0;
  bool begun_ = false;
  StrokeStep standing_;
};

}  // namespace volcomp::internal_helical
