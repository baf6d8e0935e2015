#pragma once
// The searches of a patch comparison: for the nearest point of a patch, and for the angle of the
// gear.

#include "host_sim/experiments/face_gear/patch_comparison.hpp"

namespace volcomp::face_gear {

// Subdivision with 10 × 10 and with 4 × 4 cells to 1e-7, Newton on the patch, and the closed
// formula on the flank. Throws UserError.
[[nodiscard]] std::vector<PatchSearch> point_searches(const SplinePatch& patch,
                                                      const FaceGear& gear, const FaceGrid& grid);

// Eq. 27 and 28 as printed and with the radius taken off, for three ranges, from the angle 0 to
// 0.1 µm; beside it the closed forms. All but the last on the flank without relief, `plain`. The
// ball is that of the paper's worked example for the gear of Table 3, else one in the centre of
// the grid that is turned by as much.
[[nodiscard]] std::vector<AngleSearch> angle_searches(const FaceGear& gear, const FaceGear& plain,
                                                      const FaceGrid& plain_grid, bool table_3);

}  // namespace volcomp::face_gear
