#pragma once

#include "comp/core/span.hpp"

namespace volcomp {

// Slope of the unweighted least-squares line of y over x: at least two different x.
[[nodiscard]] double least_squares_slope(Span<const double> x, Span<const double> y);

}  // namespace volcomp
