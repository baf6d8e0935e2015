// The four rotation models against products of elementary rotations and power series in long
// double.

#include <gtest/gtest.h>

#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

constexpr RotationModel kModels[] = {RotationModel::rxryrz, RotationModel::exponential,
                                     RotationModel::second_order, RotationModel::linear};

// The oracle itself subtracts the identity.
constexpr double kOracle = 4.0 * kRealEpsilon;

Mat3 expected_minus_identity(RotationModel model, const Vec3& angles) {
  return (error_rotation(model, angles) - Real33::Identity()).cast<double>();
}

// "Accurate to round-off of its own largest entry": 8 ulp of that entry, whatever the angle.
TEST(RotationModels, MatchTheirDefinitionFromPicoradiansToARadian) {
  Random random;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::pow(10.0, random.uniform(-12.0, 0.0));
    const Vec3 angles = random.vector(size);
    for (const RotationModel model : kModels) {
      const Mat3 want = expected_minus_identity(model, angles);
      const Mat3 got = rotation_minus_identity(model, angles);
      const double allowed = 8.0 * 2.3e-16 * want.cwiseAbs().maxCoeff() + kOracle;
      ASSERT_LE((got - want).cwiseAbs().maxCoeff(), allowed)
          << "model " << static_cast<int>(model) << ", angles " << angles.x() << ' ' << angles.y()
          << ' ' << angles.z();
    }
  }
}

// The small-angle branch of the exponential must join the other one without a step.
TEST(RotationModels, ExponentialIsSmoothWhereItsSeriesTakesOver) {
  const Vec3 direction = Vec3(1.0, -2.0, 3.0).normalized();
  for (const double t : {0.0, 0.99e-8, 1.01e-8, 1e-7}) {
    const Vec3 angles = t * direction;
    const Mat3 want = expected_minus_identity(RotationModel::exponential, angles);
    const Mat3 got = rotation_minus_identity(RotationModel::exponential, angles);
    EXPECT_LE((got - want).cwiseAbs().maxCoeff(), 1e-15 * t + kOracle) << t;
  }
}

TEST(RotationModels, RigidModelsAreRotations) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 angles = random.vector(3.0);
    for (const RotationModel model : {RotationModel::rxryrz, RotationModel::exponential}) {
      const Mat3 R = Mat3::Identity() + rotation_minus_identity(model, angles);
      EXPECT_LE((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff(), 4e-15);
      EXPECT_NEAR(R.determinant(), 1.0, 4e-15);
    }
  }
}

// The matrix of docs/papers/xyfz.md, Table 2, has the determinant 1 + |e|².
TEST(RotationModels, LinearModelIsNoRotation) {
  const Vec3 angles(3e-3, -4e-3, 12e-3);
  const Mat3 R = Mat3::Identity() + rotation_minus_identity(RotationModel::linear, angles);
  EXPECT_NEAR(R.determinant() - 1.0, 169e-6, 1e-15);
}

TEST(RotationModels, InverseUndoesTheRotation) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10.0, random.uniform(-9.0, -2.0));
    const Vec3 angles = random.vector(size);
    for (const RotationModel model : kModels) {
      const Mat3 forth = Mat3::Identity() + rotation_minus_identity(model, angles);
      const Mat3 back = Mat3::Identity() + inverse_minus_identity(model, angles);
      // The truncated model's transpose is its inverse up to third order.
      const double allowed =
          4e-16 + (model == RotationModel::second_order ? 4.0 * size * size * size : 0.0);
      ASSERT_LE((back * forth - Mat3::Identity()).cwiseAbs().maxCoeff(), allowed)
          << static_cast<int>(model) << ' ' << size;
    }
  }
}

// Halving the angles divides the difference by eight: third order, and not smaller than that.
TEST(RotationModels, SecondOrderDiffersFromTheProductByThirdOrderOnly) {
  const Vec3 direction(0.7, -1.1, 0.9);
  const auto difference = [&](double scale) {
    const Vec3 angles = scale * direction;
    return (rotation_minus_identity(RotationModel::second_order, angles) -
            rotation_minus_identity(RotationModel::rxryrz, angles))
        .norm();
  };
  for (const double scale : {0.04, 0.02, 0.01}) {
    EXPECT_NEAR(difference(scale) / difference(scale / 2.0), 8.0, 0.2) << scale;
  }
  // The third order is below 1e-9 mm at 100 µrad and 230 mm.
  EXPECT_LT(difference(1e-4) * 230.0, 1e-9);
}

// Baker–Campbell–Hausdorff: Rx(a) Ry(b) Rz(c) turns by ½(bc, −ac, ab) more than exp([a b c]x).
TEST(RotationModels, ProductAndExponentialDifferByHalfTheCommutators) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Vec3 e = random.vector(1e-4);
    const Vec3 arm = random.vector(600.0);
    const Vec3 extra = 0.5 * Vec3(e.y() * e.z(), -e.x() * e.z(), e.x() * e.y());
    const Vec3 got = (rotation_minus_identity(RotationModel::rxryrz, e) -
                      rotation_minus_identity(RotationModel::exponential, e)) *
                     arm;
    EXPECT_LE((got - extra.cross(arm)).norm(), 3.0 * std::pow(e.norm(), 3) * arm.norm());
    EXPECT_LE(got.norm(), 0.5 * e.squaredNorm() * arm.norm());
  }
}

// Conventions, section 3: 3 nm at 100 µrad and 600 mm.
TEST(RotationModels, ProductAndExponentialDifferByThreeNanometresAtHundredMicroradians) {
  const Vec3 e(1e-4, 1e-4, 0.0);
  const Vec3 got = (rotation_minus_identity(RotationModel::rxryrz, e) -
                    rotation_minus_identity(RotationModel::exponential, e)) *
                   Vec3(600.0, 0.0, 0.0);
  EXPECT_NEAR(got.norm(), 3.0e-6, 1e-9);
}

}  // namespace
}  // namespace volcomp::test
