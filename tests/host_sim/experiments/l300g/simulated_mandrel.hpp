#pragma once
// Calibrations on a mandrel without machine and bus: every part of the budget is drawn as large as
// it is stated.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/experiments/l300g/mandrel.hpp"

namespace volcomp::l300g {

// The arm is longer than the model has it, and its pivot higher than the axis of A: a true height z
// of the ball becomes the height that the model believes.
inline double believed_height(const SwingArm& arm, double longer, double higher, double z) {
  const double length = arm.length - longer;  // of the true arm, `longer` in the model
  const double theta = std::asin((z - higher) / length) - std::asin(-higher / length);
  return arm.length * std::sin(theta);
}

// Of r_c, mm.
struct MandrelError {
  double error = 0.0;
  double u = 0.0;      // as stated
  double u_fit = 0.0;  // what the fit alone would say

  [[nodiscard]] bool covered() const { return std::abs(error) <= 2.0 * u; }
};

inline MandrelError mandrel_error(const SwingArm& arm, const MandrelBudget& budget,
                                  std::uint64_t seed, std::uint32_t campaign) {
  constexpr double kEffectiveRadius_mm = 1.4935;  // behind mandrel_centres()
  const auto z = [&](RandomStream stream, std::uint32_t reading) {
    return normal(seed, {static_cast<std::uint32_t>(stream), campaign, 0, reading});
  };
  const double radius = budget.mandrel * z(RandomStream::set_up, kCommon);
  const double longer = budget.arm_length * z(RandomStream::set_up, kCommon - 1);
  const double higher = budget.pivot_height * z(RandomStream::set_up, kCommon - 2);
  std::vector<double> ys, zs;
  std::uint32_t touch = 0;
  for (const Transverse& centre : mandrel_centres()) {
    const double R = std::hypot(centre.y, centre.z);
    const double outside = radius + budget.repeatability * z(RandomStream::probe, touch++);
    ys.push_back(centre.y * (1.0 + outside / R));
    zs.push_back(believed_height(arm, longer, higher, centre.z * (1.0 + outside / R)));
  }
  const MandrelCalibration found = mandrel_calibration(std::move(ys), std::move(zs), budget, arm);
  return {found.rc - kEffectiveRadius_mm, found.u_rc,
          found.fit.rms * std::sqrt(found.fit.cofactors(2, 2))};
}

}  // namespace volcomp::l300g
