#include "comp/metrology/tables/interpolation.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

struct Differences {
  Span<const double> x;
  Span<const double> y;

  [[nodiscard]] double width(std::size_t i) const { return x[i + 1] - x[i]; }
  [[nodiscard]] double slope(std::size_t i) const { return (y[i + 1] - y[i]) / width(i); }
};

// Three-point end slope of PCHIP, limited so that the curve does not overshoot.
double pchip_end(double h0, double h1, double d0, double d1) {
  const double slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0.0) return 0.0;
  if (d0 * d1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(d0)) return 3.0 * d0;
  return slope;
}

double pchip_interior(double h0, double h1, double d0, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// Segment that holds `at`; the first or last one outside the knots.
std::size_t segment_of(Span<const double> x, double at) {
  const double* upper = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  return static_cast<std::size_t>(upper - x.begin()) - 1;
}

}  // namespace

void knot_slopes(Interpolation kind, Span<const double> x, Span<const double> y,
                 Span<double> slopes) {
  if (kind == Interpolation::linear) return;
  const std::size_t n = x.size();
  const Differences d{x, y};
  if (n == 2) {
    slopes[0] = slopes[1] = d.slope(0);
    return;
  }
  const std::size_t last = n - 1;
  if (kind == Interpolation::pchip) {
    slopes[0] = pchip_end(d.width(0), d.width(1), d.slope(0), d.slope(1));
    for (std::size_t i = 1; i < last; ++i) {
      slopes[i] = pchip_interior(d.width(i - 1), d.width(i), d.slope(i - 1), d.slope(i));
    }
    slopes[last] =
        pchip_end(d.width(last - 1), d.width(last - 2), d.slope(last - 1), d.slope(last - 2));
    return;
  }
  slopes[0] = 0.5 * (3.0 * d.slope(0) - d.slope(1));
  for (std::size_t i = 1; i < last; ++i)
    slopes[i] = (y[i + 1] - y[i - 1]) / (x[i + 1] - x[i - 1]);
  slopes[last] = 0.5 * (3.0 * d.slope(last - 1) - d.slope(last - 2));
}

double interpolate(Interpolation kind, Ends ends, Span<const double> x, Span<const double> y,
                   Span<const double> slopes, double at) {
  const std::size_t last = x.size() - 1;
  const bool below = at < x[0];
  const bool above = at > x[last];
  const bool cubic = kind != Interpolation::linear;
  if (below || above) {
    const std::size_t end = below ? 0 : last;
    if (ends == Ends::hold) return y[end];
    const std::size_t segment = below ? 0 : last - 1;
    const double slope = cubic ? slopes[end] : Differences{x, y}.slope(segment);
    return y[end] + slope * (at - x[end]);
  }
  const std::size_t i = segment_of(x, at);
  const double h = x[i + 1] - x[i];
  const double t = (at - x[i]) / h;
  if (!cubic) return y[i] + t * (y[i + 1] - y[i]);
  const double s = 1.0 - t;
  return s * s * (1.0 + 2.0 * t) * y[i] + t * t * (3.0 - 2.0 * t) * y[i + 1] +
         h * t * s * (s * slopes[i] - t * slopes[i + 1]);
}

}  // namespace volcomp
