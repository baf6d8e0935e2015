#pragma once
// Intervals of the figures of ISO 230-2 from bidirectional runs. The truth of E, M, B and
// `largest` is that of the means without noise, of A and R that of the means and of the spread of
// single readings.

#include <cstdint>
#include <optional>
#include <vector>

#include "comp/core/status.hpp"
#include "host_sim/host/measure/intervals/interval.hpp"
#include "host_sim/host/measure/intervals/run_draws.hpp"

namespace volcomp::host {

struct PositioningIntervals {
  FigureInterval E, M, B, A, R;
  FigureInterval largest;  // mean of both directions, from the first target, magnitude
  // Whole runs differ by more than chance: the intervals of A and R may cover less than 95 %.
  bool runs_differ = false;
};

// Draws 0…draws − 1 of RandomStream::intervals.
[[nodiscard]] PositioningIntervals positioning_intervals(const RunReadings& readings,
                                                         const StatedErrors& stated,
                                                         std::uint64_t seed, std::size_t draws);

// The same where runs are enough for it, by run and target; else why not (run_check.hpp).
struct RunIntervals {
  std::optional<PositioningIntervals> of;
  Status refusal;
};
[[nodiscard]] RunIntervals run_intervals(const std::vector<double>& positions,
                                         const std::vector<std::vector<double>>& up,
                                         const std::vector<std::vector<double>>& down,
                                         const StatedErrors& stated, std::uint64_t seed,
                                         std::size_t draws);

}  // namespace volcomp::host
