// Whether the radius of a calibration is as far from the true one as its uncertainty says.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/host_sim/experiments/l300g/simulated_mandrel.hpp"

namespace volcomp::l300g {
namespace {

constexpr std::uint32_t kCalibrations = 1000;

// Of the calibrations, with an arm known so well: those within two standard uncertainties of the
// true radius.
struct CoveredPercent {
  double by_all = 0.0;
  double by_fit = 0.0;
};

CoveredPercent covered(double arm_length_mm) {
  constexpr double kOne = 100.0 / kCalibrations;
  MandrelBudget budget;
  budget.arm_length = arm_length_mm;
  CoveredPercent percent;
  for (std::uint32_t k = 0; k < kCalibrations; ++k) {
    const MandrelError e = mandrel_error(SwingArm{}, budget, 1, k);
    if (e.covered()) percent.by_all += kOne;
    if (std::abs(e.error) <= 2.0 * e.u_fit) percent.by_fit += kOne;
  }
  return percent;
}

// 95.45 of a normal distribution, with a sampling error of 0.66 (1 σ).
TEST(MandrelUncertainty, CoversTheTrueRadius) {
  EXPECT_NEAR(covered(MandrelBudget{}.arm_length).by_all, 95.45, 2.0);
  EXPECT_NEAR(covered(20e-3).by_all, 95.45, 2.0);
}

// 20 µm of the arm are 2.19 µm of the radius, which no fit shows: an independent program found 2.7
// % covered by it (measurement.md of the specification, section 5, where touches scatter by 0.25
// µm).
TEST(MandrelUncertainty, IsNotThatOfTheFit) {
  EXPECT_NEAR(effect_of_arm(SwingArm{}, 20e-3).radius, 2.19e-3, 0.005e-3);
  EXPECT_LT(covered(20e-3).by_fit, 6.0);
}

}  // namespace
}  // namespace volcomp::l300g
