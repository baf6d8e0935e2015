#include "comp/metrology/fits/effective_radius.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

constexpr double kPlausible_mm = 0.05;
constexpr double kShortArc = kPi / 6.0;

// Seen from the centre, from the mean direction of the points; right for arcs up to a turn.
double covered_arc(Span<const double> y, Span<const double> z, const Circle& circle) {
  double mean_y = 0.0;
  double mean_z = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    mean_y += y[i] - circle.y;
    mean_z += z[i] - circle.z;
  }
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double dy = y[i] - circle.y;
    const double dz = z[i] - circle.z;
    const double angle = std::atan2(mean_y * dz - mean_z * dy, mean_y * dy + mean_z * dz);
    low = std::min(low, angle);
    high = std::max(high, angle);
  }
  return high - low;
}

}  // namespace

Status effective_radius(Span<const double> y, Span<const double> z, const CircleFit& fit,
                        const MandrelRules& rules, EffectiveRadius& out) {
  Where where;
  where.has_value = true;
  where.value = fit.rms;
  if (!(fit.rms <= rules.largest_rms)) {
    where.index = static_cast<int>(fit.worst);
    where.has_deviation = true;
    where.deviation = fit.largest;
    return refuse(Reason::residuals_too_large, where);
  }
  const double rc = fit.geometric.radius - rules.mandrel_radius;
  where.value = rc;
  if (!(rc > 0.0 && rc < rules.ball_radius + kPlausible_mm))
    return refuse(Reason::implausible_radius, where);
  const double arc = covered_arc(y, z, fit.geometric);
  out = {rc, arc, arc < kShortArc};
  return {};
}

}  // namespace volcomp
