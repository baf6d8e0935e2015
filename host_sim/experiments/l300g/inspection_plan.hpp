#pragma once
// What an inspection touches, in which order, and how the machine moves at each touch.

#include <array>
#include <string>
#include <vector>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_path.hpp"
#include "host_sim/experiments/l300g/grinder.hpp"

namespace volcomp::l300g {

inline constexpr std::array<FlankSide, 2> kSides{FlankSide::left, FlankSide::right};
inline constexpr std::array<const char*, 2> kSideNames{"left", "right"};

// Roll length of the middle of the flank, where pitch and lead are taken.
[[nodiscard]] double pitch_roll(const InvoluteGear& gear);

// What profile and lead are taken of.
struct TracePlan {
  std::size_t teeth = 1;     // spread evenly round the gear, from tooth 0 on
  std::size_t points = 101;  // within the evaluation range of ISO 1328-1:1995, both ends included
};
[[nodiscard]] std::vector<int> traced_teeth(const InvoluteGear& gear, const TracePlan& plan);

// From root to tip; along the width; every tooth once.
[[nodiscard]] std::vector<FlankTouch> profile_touches(const InvoluteGear& gear, const Flank& flank,
                                                      std::size_t points = TracePlan{}.points);
[[nodiscard]] std::vector<FlankTouch> lead_touches(const InvoluteGear& gear, const Flank& flank,
                                                   std::size_t points = TracePlan{}.points);
[[nodiscard]] std::vector<FlankTouch> pitch_touches(const InvoluteGear& gear, FlankSide side);

// Throws UserError with `name` where a ball of this radius, mm, on one flank of a tooth space is
// not clear of the other by what a touch moves.
void require_ball_fits(const InvoluteGear& gear, double ball_radius, const std::string& name);

// What the paths of an inspection depend on.
struct InspectionSetup {
  GrinderGeometry geometry;
  InvoluteGear gear;
  PathStyle style = PathStyle::fixed_a;
  double ball_radius = 0.0;  // effective, mm
  TracePlan traces{};

  // Y with the ball beside the gear.
  [[nodiscard]] double beside() const;
};

// Only B moves on the way to the flank. NC coordinates.
struct FlankMove {
  Pose from{};
  Pose contact{};
  Pose beyond{};         // as far as it may go without a touch
  Vec3 normal;           // of the part, workpiece frame
  double lift_mm = 0.0;  // of the ball per radian of B
};

// `stand_off`: from flank to ball before the touch, mm. Throws UserError where B cannot reach.
[[nodiscard]] FlankMove flank_move(const InspectionSetup& setup, const FlankTouch& touch,
                                   double stand_off);

}  // namespace volcomp::l300g
