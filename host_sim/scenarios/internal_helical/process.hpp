#pragma once
// The axes of the grinder while it grinds slot after slot: command, position loops with lag,
// ripple, indexing errors, encoders. One ProcessState per SYNC is all that a compensation gets to
// see, here by a call, on a machine in frames.

#include <functional>
#include <vector>

#include "comp/realtime/helix_tick.hpp"
#include "comp/realtime/stroke_offsets.hpp"
#include "comp/surfaces/internal_gear.hpp"
#include "host_sim/instruments/noise.hpp"
#include "host_sim/scenarios/internal_helical/constants.hpp"

namespace volcomp::sim {

// At one SYNC: positions of the axes, and from the controller what it is doing.
struct ProcessState {
  TrackedAxis x;  // nm
  TrackedAxis z;
  TrackedAxis c;  // 2^-40 turn
  TrackedAxis a;
  std::uint16_t sequence = 0;
  std::uint16_t slot = 0;
  Direction stroke = Direction::unknown;
  bool in_face = false;
  bool stroke_end = false;
  std::int32_t feed_nm_per_s = 0;
};
[[nodiscard]] HelixFrame helix_frame(const ProcessState& state);
[[nodiscard]] StrokeState stroke_state(const ProcessState& state);

// What is added to the command of C after this SYNC, 2^-32 turn.
using StrokeCompensation = std::function<std::int32_t(const ProcessState&)>;

// Where the axes really are, which only the flank shows: actual − original command.
struct LagErrors {
  double z = 0.0;  // position of the wheel, mm
  double e_x = 0.0;
  double e_z = 0.0;
  double e_c = 0.0;
};

// One pass over a slot.
struct StrokeTrace {
  std::uint16_t slot = 0;
  Direction direction = Direction::unknown;
  std::vector<LagErrors> at;  // every tick; z grows with `forward`, falls with `backward`
};

class GrindingProcess {
 public:
  // `seed`: of everything random.
  GrindingProcess(const InternalGear& gear, const GrindingTruth& truth, std::uint64_t seed);

  // All slots once, up and down in turns; with an odd number of teeth every slot is ground the
  // other way in the next round.
  std::vector<StrokeTrace> round(const StrokeCompensation& compensation);

 private:
  void grind_slot(StrokeTrace& trace, const StrokeCompensation& compensation);
  [[nodiscard]] ProcessState observe(const StrokeTrace& trace, double z, const LagErrors& errors);
  [[nodiscard]] double indexing_error(const StrokeTrace& trace, double z) const;

  InternalGear gear_;
  GrindingTruth truth_;
  Random random_;
  std::vector<double> slot_error_;  // of C, repeatable, rad
  Direction next_ = Direction::forward;
  double z_ = 0.0;  // of the loop, without ripple
  double c_ = 0.0;  // of the loop, against the place of the slot, without indexing errors
  double pass_error_ = 0.0;
  double x_error_ = 0.0;
  std::uint16_t sequence_ = 0;
};

// C as commanded while slot k stands under the wheel at stroke z: the gear turns against its
// angles.
[[nodiscard]] double slot_place(const InternalGear& gear, std::uint16_t slot);

}  // namespace volcomp::sim
