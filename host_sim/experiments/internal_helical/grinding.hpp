#pragma once
// Slot after slot is ground: what is commanded, what the axes make of it, and what the passes leave
// on the flanks.

#include <functional>

#include "comp/metrology/gears/flank_error.hpp"
#include "comp/metrology/tables/left_error.hpp"
#include "host_sim/experiments/internal_helical/grinder_plant.hpp"

namespace volcomp::internal_helical {

// One pass over a slot.
struct StrokeTrace {
  std::uint16_t slot = 0;
  Direction direction = Direction::unknown;
  std::vector<LagErrors> at;  // every tick; z grows with `forward`, falls with `backward`
};

// What carries commands and offsets to the axes comes from outside: once per SYNC, and it moves the
// plant.
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

inline constexpr std::size_t kProfilePoints = 13;
inline constexpr std::array<FlankSide, 2> kHelicalSides{FlankSide::left, FlankSide::right};
inline constexpr std::array<const char*, 2> kHelicalSideNames{"left", "right"};

[[nodiscard]] MachineChain helical_chain();

// The flanks at mid face: the first order at the instant of contact, cut to the lower envelope over
// the strokes around it, because the wheel is too large to follow the ripple
// (docs/papers/internal-helical.md, "What we do").
class FlankGrinding {
 public:
  FlankGrinding(const host::GrindingFile& job, const GrindingTruth& truth);

  // dn in mm of the flank that a pass has left, excess material positive: at the pitch circle, and
  // from the tip to the form circle.
  [[nodiscard]] double pitch_point(const StrokeTrace& pass, std::size_t side) const;
  [[nodiscard]] double profile_point(const StrokeTrace& pass, std::size_t side,
                                     std::size_t point) const;

  [[nodiscard]] const std::array<double, kProfilePoints>& roll_length() const { return roll_; }
  // |dn| per error of X at the pitch circle.
  [[nodiscard]] double flank_per_x() const;

 private:
  // A point of a flank: when it is touched, what errors do to it, how round the wheel is there.
  struct Place {
    double stroke = 0.0;
    SensitivityRows rows{};
    double kappa = 0.0;
    double wheel_form = 0.0;  // mm
  };
  [[nodiscard]] Place place_at(std::size_t side, double roll_length) const;
  [[nodiscard]] double first_order(const Place& place, const LagErrors& errors,
                                   std::uint16_t slot) const;
  [[nodiscard]] double ground(const Place& place, const StrokeTrace& pass) const;

  host::GrindingFile job_;
  GrindingTruth truth_;
  std::array<double, kProfilePoints> roll_{};
  std::array<Place, 2> pitch_{};
  std::array<std::array<Place, kProfilePoints>, 2> profile_{};
};

}  // namespace volcomp::internal_helical
