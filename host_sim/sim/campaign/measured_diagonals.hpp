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

// A straight line of all axes together, measured at evenly spaced points.
struct MeasuredLine {
  std::string name;
  Pose start{};
  Pose end{};
  Vec3 along = Vec3::Zero();  // in which the tool goes, work frame
  double length_mm = 0.0;     // of its way
  std::size_t points = 0;
  double feed_mm_s = 10000.0 / 60.0;
};
[[nodiscard]] MeasuredLine line_of(const host::XyzAxes& axes, const Diagonal& diagonal,
                                   std::size_t points);

// Readings of one run up and one down, mm, by point; each run begins beyond the line, so that the
// first point is approached like all others. `read`: of the instrument, mm, at a distance from the
// beginning in mm.
struct DiagonalPass {
  std::vector<double> up;
  std::vector<double> down;
};
[[nodiscard]] DiagonalPass pass_along(MotionCell& cell, const MeasuredLine& line,
                                      const std::function<double(double)>& read);

[[nodiscard]] MeasuredDiagonal mean_of_directions(const MeasuredLine& line,
                                                  const DiagonalPass& pass);

// First three axes: X, Y and Z.
[[nodiscard]] MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal,
                                                std::size_t points,
                                                const InterferometerSetup& setup, Random& random);

// Error vectors at random places of the travel, both in the work frame.
[[nodiscard]] std::vector<host::VolumePoint> visit_volume(MotionCell& cell,
                                                          const host::XyzAxes& axes, int points,
                                                          std::uint64_t seed);

}  // namespace volcomp::sim
