#pragma once
// The points of a flank of a face gear that are measured: 7 rows from tip to root by 15 columns
// from the inside out (docs/papers/face-gear.md).

#include <array>
#include <cstddef>

#include "comp/metrology/faces/measuring_grid.hpp"
#include "comp/probe/face_flank.hpp"

namespace volcomp {

// Where the generated points lie: columns at equal steps of x, the gear axis to the middle of slot
// 0; rows 0 to 2 at fixed depths, the last at a depth that grows linearly with x, the others at
// equal steps between. mm.
struct FaceGridPlan {
  double first_x = 0.0;
  double last_x = 0.0;
  std::array<double, 3> tip_depths{};
  double first_root_depth = 0.0;
  double last_root_depth = 0.0;
};

// That of the paper's Table 3, decoded; only the corner blocks of its points are printed, so that
// the linear growth between is an assumption.
[[nodiscard]] FaceGridPlan face_grid_of_table_3();

// The same for any gear: columns end a twentieth of the face width before its radii, rows 0.15
// modules before tip and fillet, as those of Table 3 do.
[[nodiscard]] FaceGridPlan plan_face_grid(const FaceGear& gear);

// Depth of a flank of slot 0 where the fillet begins, at `x` along the middle of the slot.
[[nodiscard]] double fillet_depth(const FaceGear& gear, double x);

struct FaceGridNode {
  FaceParameters at;  // of the generated point
  Vec3 point;         // relieved, flank of side +1 in slot 0
  Vec3 normal;
};
using FaceGrid = std::array<std::array<FaceGridNode, kGridColumns>, kGridRows>;

// For other flanks: from_flank() of points and normals. Refused with the index (row ·
// kGridColumns + column) of the first: not_finite, inside_gear_base, no_regular_flank, or the
// reason a point is not on the flank for.
Status make_face_grid(const FaceGear& gear, const FaceGridPlan& plan, FaceGrid& out);

}  // namespace volcomp
