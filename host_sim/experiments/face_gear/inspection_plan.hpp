#pragma once
// Which points of a face gear are touched, in which order: for the inspection and for its NC
// program.

#include <array>
#include <vector>

#include "comp/metrology/faces/face_grid.hpp"
#include "host_sim/experiments/face_gear/face_path.hpp"

namespace volcomp::face_gear {

inline constexpr std::array<int, 2> kFaceSides{1, -1};  // left is the flank at y > 0
inline constexpr std::array<const char*, 2> kFaceSideNames{"left", "right"};

// A node of the grid on one flank.
struct PlannedTouch {
  FlankName flank;
  std::size_t row = 0;
  std::size_t column = 0;
};

// For the frame: both flanks of three slots, the centre of each and four cells far out.
[[nodiscard]] std::vector<PlannedTouch> frame_touches(int teeth);
// The whole grid of a flank, column after column, there and back.
[[nodiscard]] std::vector<PlannedTouch> map_touches(const FlankName& flank);
// The centres of all flanks of a side.
[[nodiscard]] std::vector<PlannedTouch> pitch_touches(int side, int teeth);
// The slots whose flanks are mapped: `flanks` of them, evenly over the gear.
[[nodiscard]] std::vector<int> mapped_slots(int flanks, int teeth);

}  // namespace volcomp::face_gear
