#pragma once
// The identification procedure as Yang et al. print it (docs/papers/l300g.md, eq. 18) and what it
// can give: it shows why one reading of each axis is not enough.

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp {

struct ReadingFigures {
  double mean = 0.0;
  double deviation = 0.0;  // standard, n − 1; 0 for one reading
  double range = 0.0;      // peak to peak
};

// Figures of the differences actual − ideal of one axis, in their unit. Refused: too_few_points,
// not_finite (index).
Status reading_figures(Span<const double> difference, ReadingFigures& out);

struct PrintedSolution {
  int rank = 0;                             // of six
  ErrorMotion least = ErrorMotion::Zero();  // of all solutions the shortest in mm and rad
};

// Eq. 18 for the X axis: the same three rows for every reading, since the station does not enter
// them. `difference`: mm; `start`: x₀, mm.
Status printed_x_solution(Span<const double> difference, double start, PrintedSolution& out);

}  // namespace volcomp
