#pragma once
// The grid of points a face-gear flank is measured in: 7 rows along the profile, 15 columns along
// the face width. Row 1 and column 1 of a table are index 0 here. See docs/papers/face-gear.md.

#include <array>
#include <cstddef>

#include "comp/machine/error_motion.hpp"

namespace volcomp {

inline constexpr std::size_t kGridRows = 7;
inline constexpr std::size_t kGridColumns = 15;
inline constexpr std::size_t kGridCells = kGridRows * kGridColumns;

// Where a map is zeroed: row 4, column 8 of the tables.
inline constexpr std::size_t kCentreRow = 3;
inline constexpr std::size_t kCentreColumn = 7;

// Lists over the grid are row by row.
constexpr std::size_t grid_index(std::size_t row, std::size_t column) {
  return row * kGridColumns + column;
}

// A point of the nominal flank in the frame of the gear, mm, and the unit normal out of the
// material.
struct SurfacePoint {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};

}  // namespace volcomp
