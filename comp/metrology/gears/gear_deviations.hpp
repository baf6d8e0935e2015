#pragma once
// Deviations of one trace of a cylindrical gear, in the unit of the input.

#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

struct TraceDeviations {
  double total = 0.0;  // F: range of the trace
  double form = 0.0;   // f_f: range about the mean line
  double slope = 0.0;  // f_H: rise of the mean line over the evaluation range
  std::size_t used = 0;
};

struct EvaluationRange {
  double low = 0.0;
  double high = 0.0;
};

// Profile (`at`: roll length) or lead (`at`: x): unweighted least-squares line through the points
// within `range`, ends included. Refused: length_mismatch, not_finite (index), too_few_points
// (count) for fewer than 3 in the range.
Status evaluate_trace(Span<const double> at, Span<const double> deviation,
                      const EvaluationRange& range, TraceDeviations& out);

}  // namespace volcomp
