#include "comp/metrology/gears/l300g.hpp"

#include <cmath>

namespace volcomp {
double arm_foreshortening(const SwingArm& arm, double B) {
  const double s = std::sin(0.5 * (B - arm.zero));
  return 2.0 * arm.length * s * s;
}

double arm_lift(const SwingArm& arm, double B) { return arm.length * std::cos(B - arm.zero); }

Status arm_angle(const SwingArm& arm, double height, double& B) {
  if (!std::isfinite(height)) return refuse_value(Reason::not_finite, nullptr, height);
  if (std::abs(height) > arm.length) return refuse_value(Reason::out_of_reach, nullptr, height);
  B = arm.zero + std::asin(height / arm.length);
  return {};
}

}  // namespace volcomp
