#include "comp/metrology/gears/flank_envelope.hpp"

#include <cmath>

namespace volcomp {

Frame generating_frame(const InternalGear& gear, const WheelSetup& setup, double stroke) {
  // C = −stroke / p turns the gear; seen from it the wheel turns the other way.
  const Frame turned_along{axis_rotation(Axis::z, stroke * gear.turn_per_mm), {0.0, 0.0, stroke}};
  return turned_along * wheel_at_rest(setup);
}

Status wheel_gap(const WheelProfile& profile, const Frame& wheel, const SpaceFlankPoint& flank,
                 double& gap) {
  constexpr int kMostSteps = 30;
  constexpr double kEnd_mm = 1e-13;
  const Vec3 q0 = wheel.apply_inverse(flank.P);
  const Vec3 m = turned_back(wheel.R, flank.n);
  double t = 0.0;
  double step = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    const Vec3 q = added(q0, t, m);
    const double rho = std::hypot(q.x(), q.z());
    const WheelProfile::At at = profile.at(rho);
    const double rise = m.y() - at.slope * (q.x() * m.x() + q.z() * m.z()) / rho;
    step = (at.y - q.y()) / rise;
    t += step;
    if (!(std::abs(step) > kEnd_mm)) break;
  }
  if (!(std::abs(step) <= 1e-9)) return refuse(Reason::no_contact);
  gap = t;
  return {};
}

}  // namespace volcomp
