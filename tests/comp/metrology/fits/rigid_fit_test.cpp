// Six error motions from targets: what layouts promise.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include "tests/oracle/rigid_fit.hpp"

namespace volcomp::test {
namespace {

std::vector<Vec3> square(double h, const Vec3& centre) {
  std::vector<Vec3> p;
  for (const double x : {-h, h}) {
    for (const double y : {-h, h})
      p.push_back(centre + Vec3(x, y, 0.0));
  }
  return p;
}

ErrorMotion some_motion() {
  ErrorMotion e;
  e << 4e-3, -3e-3, 2e-3, 70e-6, -50e-6, 30e-6;
  return e;
}

// Fits the targets after they were moved so.
Status fit_moved(const std::vector<Vec3>& position, const ErrorMotion& e, RigidFit& fit) {
  std::vector<Vec3> d;
  for (const Vec3& p : position)
    d.push_back(translation(e) + rotation(e).cross(p));
  return fit_rigid(position, d, fit);
}

TEST(RigidFit, ReturnsTheMotionAtTheOrigin) {
  const std::vector<Vec3> p = square(60.0, {30.0, -200.0, 15.0});
  RigidFit fit;
  ASSERT_TRUE(fit_moved(p, some_motion(), fit).ok());
  EXPECT_LT((fit.motion - some_motion()).head<3>().norm(), 1e-14);
  EXPECT_LT((fit.motion - some_motion()).tail<3>().norm(), 1e-16);
  EXPECT_LT(fit.rms, 1e-15);
}

TEST(RigidFit, StandardDeviationsOfASquare) {
  constexpr double h = 60.0;
  const std::vector<Vec3> p = square(h, Vec3::Zero());
  RigidFit fit;
  ASSERT_TRUE(fit_moved(p, some_motion(), fit).ok());
  const Eigen::Matrix<double, 6, 1> sd = fit.cofactors.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(sd(i), 0.5, 1e-12);
  EXPECT_NEAR(sd(3), 1.0 / (2.0 * h), 1e-14);
  EXPECT_NEAR(sd(4), 1.0 / (2.0 * h), 1e-14);
  EXPECT_NEAR(sd(5), 1.0 / (2.0 * std::sqrt(2.0) * h), 1e-14);
}

// [I, −[r]×] Q [I, −[r]×]ᵀ at the lever of the arm: noise is amplified unless the targets span it.
TEST(RigidFit, TargetsMustSpanTheLever) {
  const Vec3 lever(-174.0, 230.0, 0.0);
  const auto sd_at_lever = [&](double h) {
    const std::vector<Vec3> p = square(h, Vec3::Zero());
    RigidFit fit;
    EXPECT_TRUE(fit_moved(p, some_motion(), fit).ok());
    Eigen::Matrix<double, 3, 6> J;
    J << Mat3::Identity(), -cross_matrix(lever);
    return Vec3((J * fit.cofactors * J.transpose()).diagonal().cwiseSqrt());
  };
  const Vec3 narrow = sd_at_lever(60.0);
  const Vec3 wide = sd_at_lever(150.0);
  EXPECT_GT(narrow.maxCoeff(), 1.7);
  EXPECT_LT(narrow.maxCoeff(), 2.8);
  EXPECT_LT(wide.maxCoeff(), 1.2);
}

TEST(RigidFit, CovarianceIsSymmetric) {
  const std::vector<Vec3> p = square(40.0, {100.0, 50.0, -20.0});
  RigidFit fit;
  ASSERT_TRUE(fit_moved(p, some_motion(), fit).ok());
  EXPECT_LT((fit.cofactors - fit.cofactors.transpose()).norm(), 1e-15 * fit.cofactors.norm());
}

TEST(RigidFit, ALineLeavesOneRotationOpen) {
  std::vector<Vec3> p;
  for (int i = 0; i < 6; ++i)
    p.push_back(Vec3(10.0, 20.0, -5.0) + 13.7 * i * Vec3(0.3, -0.7, 0.2));
  RigidFit fit;
  fit.rms = 7.0;
  const Status status = fit_moved(p, some_motion(), fit);
  EXPECT_EQ(status.reason, Reason::rank_deficient);
  EXPECT_EQ(status.where.count, 5);
  EXPECT_EQ(fit.rms, 7.0);
}

}  // namespace
}  // namespace volcomp::test
