#pragma once
// Measuring again with the compensation running: the machine really moves, nothing is subtracted
// off line.

#include <string>
#include <vector>

#include "comp/evaluation/diagonals.hpp"
#include "host_sim/controller/motion_cell.hpp"
#include "host_sim/instruments/noise.hpp"

namespace volcomp::sim {

// One diagonal measured in both directions, µm over mm.
struct MeasuredDiagonal {
  std::string name;
  std::vector<double> distance_mm;
  std::vector<double> mean_um;  // of both directions, relative to the first point
  double max_abs_um = 0.0;      // of the mean
  double range_um = 0.0;
  double reversal_um = 0.0;  // largest difference between the directions
};

// Interferometer along the diagonal: scale error and repeatability of `runs` averaged readings per
// direction.
struct InterferometerSetup {
  double scale = 0.0;
  double repeatability_mm = 0.0;
  int runs = 1;
};

[[nodiscard]] MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal,
                                                std::size_t points,
                                                const InterferometerSetup& setup, Random& random);

// Error vectors at random places of the box, after the workpiece frame has been aligned to them by
// a best-fit rigid motion (what every workpiece set-up does); µm.
struct VolumeFigures {
  double max_um = 0.0;
  double rms_um = 0.0;
};
[[nodiscard]] VolumeFigures measure_volume(MotionCell& cell, const DiagonalBox& box, int points,
                                           std::uint64_t seed);

}  // namespace volcomp::sim
