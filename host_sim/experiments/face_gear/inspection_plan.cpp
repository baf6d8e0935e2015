#include "host_sim/experiments/face_gear/inspection_plan.hpp"

namespace volcomp::face_gear {

std::vector<PlannedTouch> frame_touches(int teeth) {
  constexpr int kSlots = 3;
  constexpr std::array<std::array<std::size_t, 2>, 5> kCells{
      {{kCentreRow, kCentreColumn}, {1, 1}, {1, 13}, {5, 13}, {5, 1}}};
  std::vector<PlannedTouch> touches;
  for (int k = 0; k < kSlots; ++k) {
    for (const int side : kFaceSides) {
      for (const auto& [row, column] : kCells)
        touches.push_back({{side, k * teeth / kSlots}, row, column});
    }
  }
  return touches;
}

std::vector<PlannedTouch> map_touches(const FlankName& flank) {
  std::vector<PlannedTouch> touches;
  for (std::size_t c = 0; c < kGridColumns; ++c) {
    for (std::size_t i = 0; i < kGridRows; ++i)
      touches.push_back({flank, c % 2 == 0 ? i : kGridRows - 1 - i, c});
  }
  return touches;
}

std::vector<PlannedTouch> pitch_touches(int side, int teeth) {
  std::vector<PlannedTouch> touches;
  touches.reserve(static_cast<std::size_t>(teeth));
  for (int slot = 0; slot < teeth; ++slot)
    touches.push_back({{side, slot}, kCentreRow, kCentreColumn});
  return touches;
}

std::vector<int> mapped_slots(int flanks, int teeth) {
  std::vector<int> slots;
  slots.reserve(static_cast<std::size_t>(flanks));
  for (int i = 0; i < flanks; ++i)
    slots.push_back(i * teeth / flanks);
  return slots;
}

}  // namespace volcomp::face_gear
