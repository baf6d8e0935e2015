#pragma once
// The low-pass filter of a trace before its parameters are evaluated: Gaussian, half the amplitude
// at the cut-off, no phase (ISO 16610-21; for gears ISO 1328-1:2013. Both quoted from memory, the
// prints were not at hand).
//
// The standard is silent on uneven spacing and on the ends. Here: regression of first order with
// Gaussian weights over every point of the trace (as the linear case of ISO 16610-31), which keeps
// every straight line exactly, up to both ends. There it hardly reduces noise: measure half a
// cut-off beyond the evaluation range where the flank allows it.

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

// Of which order the regression is. Order 0, the plain weighted mean, bends slopes at the ends.
enum class FilterOrder : unsigned char { mean = 0, line = 1 };

// Least cut-off of a gear trace, mm: remembered with 0.05 mm as well, to be checked in the print.
inline constexpr double kLeastCutoff = 0.25;

// ISO 1328-1:2013: a thirtieth of the evaluated length, not below `least`; the unit of `length`.
[[nodiscard]] constexpr double trace_cutoff(double length, double least = kLeastCutoff) {
  return length / 30.0 > least ? length / 30.0 : least;
}

// `at` ascends strictly; `cutoff` in its unit. `out` is as long as `deviation`, and not the same.
// Refused, in this order: length_mismatch, not_finite (field 'at', then 'deviation'; index),
// too_few_points (count) for fewer than 3, positions_not_monotone (index), bad_setting 'cutoff',
// gap (index of the point after it) where points are more than half the cut-off apart: the filter
// would leave the noise in.
Status filter_trace(Span<const double> at, Span<const double> deviation, double cutoff,
                    FilterOrder order, Span<double> out);

}  // namespace volcomp
