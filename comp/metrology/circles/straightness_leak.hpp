#pragma once
// What a straightness error of one axis adds to the squareness that a circle and that lines tell.

namespace volcomp {

// Straightness c₂u² + c₃u³ + c₄u⁴ over the travel u of an axis, mm.
struct StraightnessCurve {
  double c2 = 0.0, c3 = 0.0, c4 = 0.0;
};

// Slope, rad, that a full circle of `radius` about `centre` takes it for: of the error only odd
// powers about the centre of the circle count (∫cos²sin² = π/4, ∫cos⁴sin² = π/8).
constexpr double slope_by_circle(const StraightnessCurve& e, double centre, double radius) {
  const double u = centre;
  const double r2 = radius * radius;
  return 2.0 * e.c2 * u + e.c3 * (3.0 * u * u + 0.5 * r2) + e.c4 * (4.0 * u * u * u + 2.0 * u * r2);
}

// Slope, rad, of the line of least squares over middle ± half.
constexpr double slope_by_line(const StraightnessCurve& e, double middle, double half) {
  const double u = middle;
  const double h2 = half * half;
  return 2.0 * e.c2 * u + e.c3 * (3.0 * u * u + 0.6 * h2) + e.c4 * (4.0 * u * u * u + 2.4 * u * h2);
}

}  // namespace volcomp
