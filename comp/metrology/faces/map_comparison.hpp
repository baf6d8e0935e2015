#pragma once
// Two measurements of the same flanks: how far they differ, and how much of the difference is
// only a frame that was not quite the same (docs/papers/face-gear.md, "How to reproduce").

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/metrology/faces/error_map.hpp"
#include "comp/metrology/faces/measuring_grid.hpp"

namespace volcomp {

struct MapDifference {
  ErrorMap difference;  // first − second, where both are there
  CellStatistics overall;
  std::array<CellStatistics, kGridRows> row{};
  std::array<CellStatistics, kGridColumns> column{};
};

// Refused: too_few_points where the maps have no cell in common.
Status compare_maps(const ErrorMap& first, const ErrorMap& second, MapDifference& out);

// Which small motions of a frame take part, and whether each flank may also have a constant of its
// own: what zeroing has left behind.
struct FrameMotions {
  std::array<bool, 6> motion{};  // X, Y, Z, about X, Y, Z; the frame of the gear
  bool constants = false;
};
inline constexpr FrameMotions kShiftInXz{{true, false, true, false, false, false}, true};
inline constexpr FrameMotions kWholeFrame{{true, true, true, true, true, true}, false};
inline constexpr FrameMotions kTurnAboutAxis{{false, false, false, false, false, true}, false};

// The difference of one flank, and the nominal flank it was measured on: kGridCells points.
struct ComparedFlank {
  const ErrorMap* difference = nullptr;
  Span<const SurfacePoint> nominal;
};
inline constexpr std::size_t kMaxComparedFlanks = 2;

struct FrameShare {
  Vec3 shift = Vec3::Zero();  // unit of the map
  Vec3 turn = Vec3::Zero();   // unit of the map per mm: µm give mrad
  std::array<double, kMaxComparedFlanks> constant{};
  std::array<ErrorMap, kMaxComparedFlanks> rest;  // the difference without its frame
  double rms_before = 0.0;
  double rms_after = 0.0;
  double explained = 0.0;  // share of the sum of squares, 0…1
  int rank = 0;            // combinations the points distinguish
};

// Least squares over n·t + (p × n)·w + constant of the flank. What the points do not distinguish —
// a turn about the gear axis and the constants of a flank, for instance — is shared out by the
// pseudo-inverse: the smallest motion that does it, rotations measured at the mean radius of the
// points. `flanks`: one or two. Refused: too_few_points (count of flanks), length_mismatch (index
// of the flank), not_finite (index) for a nominal point, too_few_points (count of cells) for fewer
// cells than unknowns.
Status frame_share(Span<const ComparedFlank> flanks, const FrameMotions& freedom, FrameShare& out);

}  // namespace volcomp
