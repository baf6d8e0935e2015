#pragma once
// Intervals of circular deviations (ISO 230-4) from circles that were gone round several times, or
// once with a stated uncertainty of a reading.

#include <cstdint>
#include <vector>

#include "host_sim/host/measure/intervals/interval.hpp"

namespace volcomp::host {

// Both directions at the same angles, which rise; radial deviations, mm, by run.
struct CircleRuns {
  double radius = 0.0;        // nominal, mm
  std::vector<double> theta;  // rad
  std::vector<std::vector<double>> ccw, cw;
  double sigma = 0.0;  // of a reading, mm; 0: from the runs, of which there are two or more
};

struct CircleIntervals {
  FigureInterval ccw, cw;  // G of a direction, about its own centre
  FigureInterval both;     // G(b), about the common one
};

// Draws 0…draws − 1 of RandomStream::intervals; mm.
[[nodiscard]] CircleIntervals circle_intervals(const CircleRuns& runs, std::uint64_t seed,
                                               std::size_t draws);

}  // namespace volcomp::host
