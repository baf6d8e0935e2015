// The command that makes the machine stand where it is wanted: q + E(q) = p.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/metrology/tables/compensated_command.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

Mat3 random_matrix(Random& random, double largest) {
  Mat3 m;
  for (Eigen::Index c = 0; c < 3; ++c)
    m.col(c) = random.vector(largest);
  return m;
}

template <class ErrorAt>
double residual(const ErrorAt& error_at, const Vec3& p, int evaluations) {
  const Vec3 q = compensated_command(error_at, p, evaluations);
  return (q + error_at(q) - p).norm();
}

// For an affine field the residual after n evaluations is (−J)^n E(p), exactly.
TEST(CompensatedCommand, ResidualOfAnAffineFieldIsAPowerOfTheJacobian) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Mat3 J = random_matrix(random, 0.05);
    const Vec3 offset = random.vector(0.1);
    const auto field = [&](const Vec3& q) -> Vec3 { return offset + J * q; };
    const Vec3 p = random.vector(10.0);
    Vec3 want = field(p);
    for (int n = 0; n < 5; ++n) {
      const Vec3 q = compensated_command(field, p, n);
      ASSERT_LE((q + field(q) - p - want).norm(), 1e-14) << n;
      want = -(J * want).eval();
    }
  }
}

// One evaluation leaves at most ‖J‖‖E‖, two ‖J‖²‖E‖. Field of a machine tool: ±20 µm waves, ‖J‖ ≈
// 4e-4.
TEST(CompensatedCommand, OneAndTwoEvaluationsStayWithinTheirBounds) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Mat3 direction = random_matrix(random, 1.0);
    const Vec3 phase = random.vector(3.0);
    constexpr double kAmplitude = 0.02;
    constexpr double kWave = 0.02;  // rad/mm
    const auto field = [&](const Vec3& q) -> Vec3 {
      const Vec3 a = kWave * q + phase;
      return kAmplitude * (direction * Vec3(std::sin(a.x()), std::sin(a.y()), std::sin(a.z())));
    };
    const double J = kAmplitude * kWave * direction.norm();  // Frobenius ≥ spectral
    const double E = kAmplitude * direction.norm() * std::sqrt(3.0);
    const Vec3 p = random.vector(500.0);
    ASSERT_LE(residual(field, p, 1), J * E);
    ASSERT_LE(residual(field, p, 2), J * J * E + 6e-13);
    ASSERT_LE(residual(field, p, 3), J * J * J * E + 6e-13);  // round-off of 500 mm
  }
}

TEST(CompensatedCommand, SubtractsTheErrorOfTheTarget) {
  const auto field = [](const Vec3&) -> Vec3 { return {0.01, -0.02, 0.03}; };
  EXPECT_LE((compensated_command(field, Vec3(1, 2, 3), 1) - Vec3(0.99, 2.02, 2.97)).norm(), 1e-15);
}

}  // namespace
}  // namespace volcomp::test
