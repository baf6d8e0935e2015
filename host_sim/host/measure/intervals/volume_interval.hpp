#pragma once
// Interval of the largest error in a volume, of places whose uncertainty is stated.

#include <cstdint>
#include <vector>

#include "host_sim/host/measure/intervals/interval.hpp"

namespace volcomp::host {

struct VolumeErrors {
  std::vector<double> error;     // x, y, z of one place after the other, the rigid motion removed
  double u = 0.0;                // standard uncertainty of every component
  std::vector<double> position;  // of the places, mm, where a scale is common to them
  double scale = 0.0;            // its standard uncertainty, unit of the errors a mm
};

// Draws 0…draws − 1 of RandomStream::intervals.
[[nodiscard]] FigureInterval volume_interval(const VolumeErrors& volume, std::uint64_t seed,
                                             std::size_t draws);

// As many draws as so many places can have in seconds, at most `wanted`; 0 where they are so many
// that the draws left would say little.
[[nodiscard]] std::size_t affordable_draws(std::size_t places, std::size_t wanted);

// Without draws, for very many places: the figure less and more the 95 % limit of what noise alone
// would show. It never covers less, but is wider, and the corrected figure is that of the data.
[[nodiscard]] FigureInterval widest_volume_interval(const VolumeErrors& volume);

}  // namespace volcomp::host
