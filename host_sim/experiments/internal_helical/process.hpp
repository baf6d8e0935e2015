#pragma once
// The grinder while it grinds slot after slot: what is commanded and what the axes make of it. What
// carries commands and offsets to the axes comes from outside: once per SYNC, and it moves the
// plant.

#include <functional>

#include "host_sim/experiments/internal_helical/grinder_plant.hpp"

namespace volcomp::internal_helical {

// One pass over a slot.
struct StrokeTrace {
  std::uint16_t slot = 0;
  Direction direction = Direction::unknown;
  std::vector<LagErrors> at;  // every tick; z grows with `forward`, falls with `backward`
};

class GrindingProcess {
 public:
  // One SYNC with these targets.
  using Sync = std::function<void(const StrokeStep&)>;

  // `seed`: of everything random.
  GrindingProcess(const host::GrindingFile& job, const GrindingTruth& truth, std::uint64_t seed);

  // All slots once, up and down in turns, from rest. With an odd number of teeth every slot is
  // ground the other way in the next round.
  std::vector<StrokeTrace> round(const Sync& sync);
  // The next slot.
  StrokeTrace pass(const Sync& sync);
  // Stands until all axes are at rest, whatever was done before.
  void rest(const Sync& sync) const;

  [[nodiscard]] GrinderPlant& plant() { return plant_; }
  [[nodiscard]] const StrokeStep& standing() const { return plan_.standing(); }

 private:
  int teeth_;
  StrokePlan plan_;
  GrinderPlant plant_;
};

// C as commanded while slot k stands under the wheel at stroke z: the gear turns against its
// angles.
[[nodiscard]] double slot_place(const InternalGear& gear, std::uint16_t slot);

}  // namespace volcomp::internal_helical
