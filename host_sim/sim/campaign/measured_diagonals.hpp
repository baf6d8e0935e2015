#pragma once
// Measuring again with the compensation running: the machine really moves, nothing is subtracted
// off line.

#include <functional>
#include <string>
#include <vector>

#include "comp/metrology/tables/diagonals.hpp"
#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/truth/noise.hpp"

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

// Readings of one run up and one down, mm, by point. `reading_error` of the instrument, mm, at a
// distance from the beginning in mm.
struct DiagonalPass {
  std::vector<double> up;
  std::vector<double> down;
};
[[nodiscard]] DiagonalPass pass_along(MotionCell& cell, const host::XyzAxes& axes,
                                      const Diagonal& diagonal, std::size_t points,
                                      const std::function<double(double)>& reading_error);

// Both directions of a line of that length, its points evenly spaced.
[[nodiscard]] MeasuredDiagonal mean_of_directions(const std::string& name, double length_mm,
                                                  const DiagonalPass& pass);

// First three axes: X, Y and Z.
[[nodiscard]] MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal,
                                                std::size_t points,
                                                const InterferometerSetup& setup, Random& random);

// Error vectors at random places of the travel, both in the work frame.
[[nodiscard]] std::vector<host::VolumePoint> visit_volume(MotionCell& cell,
                                                          const host::XyzAxes& axes, int points,
                                                          std::uint64_t seed);
// Figures of error vectors at random places of the box, aligned. First three axes: X, Y and Z.
[[nodiscard]] host::VolumeFigures measure_volume(MotionCell& cell, const DiagonalBox& box,
                                                 int points, std::uint64_t seed);

}  // namespace volcomp::sim
