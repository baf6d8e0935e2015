#pragma once
// The effective radius of a probe's ball from the circle that its centre describes around a mandrel
// (docs/papers/l300g.md; eq. 9 of the paper subtracts the ball instead of the mandrel).

#include "comp/metrology/fits/circle_fit.hpp"

namespace volcomp {

// mm
struct MandrelRules {
  double mandrel_radius = 0.0;
  double ball_radius = 0.0;  // nominal
  double largest_rms = 0.01;
};

struct EffectiveRadius {
  double rc = 0.0;         // mm
  double arc = 0.0;        // that the points cover, rad
  bool short_arc = false;  // below 30°: the radius is badly determined, see the cofactors
};

// `fit`: of these points. Refused: residuals_too_large (index of the worst point, value = rms),
// implausible_radius (value = r_c).
Status effective_radius(Span<const double> y, Span<const double> z, const CircleFit& fit,
                        const MandrelRules& rules, EffectiveRadius& out);

}  // namespace volcomp
