#include "comp/metrology/tables/interpolation.hpp"

int main() {
  double slopes[2];
  const double knots[2] = {0.0, 1.0};
  volcomp::knot_slopes(volcomp::Interpolation::pchip, {knots, 2}, {knots, 2}, {slopes, 2});
  return slopes[0] > 0.0 ? 0 : 1;
}
