#pragma once
// Positioning figures of ISO 230-2 from bidirectional runs, in the unit of the input.

#include <array>

#include "comp/core/span.hpp"
#include "comp/metrology/tables/error_table.hpp"

namespace volcomp {

// One direction: mean and standard deviation (n − 1; 0 for one run) per target.
struct DirectionStatistics {
  Span<const double> mean;
  Span<const double> deviation;
};

struct Iso230Figures {
  double A = 0.0;     // bidirectional accuracy
  double A_up = 0.0;  // unidirectional accuracies
  double A_down = 0.0;
  double R = 0.0;  // bidirectional repeatability
  double R_up = 0.0;
  double R_down = 0.0;
  double E = 0.0;  // bidirectional systematic deviation
  double B = 0.0;  // reversal value, max |B_i|
  double M = 0.0;  // range of the mean bidirectional deviation
};

// Both directions must have the same, non-zero number of targets (else too_few_points); with one
// direction only, give it twice: B is then 0 and the caller must report that the reversal is
// unknown.
Status iso230_figures(const DirectionStatistics& up, const DirectionStatistics& down,
                      Iso230Figures& out);

}  // namespace volcomp
