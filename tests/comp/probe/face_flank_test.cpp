// Flanks of face gears: what their generation promises (docs/papers/face-gear.md, "What we do").

#include "tests/oracle/face_gears.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

// A parameter pair on the flank.
FaceParameters some_parameters(const FaceGear& gear, Random& random) {
  const double beta = random.in(gear.undercut_beta, 0.6);
  return {random.in(0.05, std::min(gear.theta_tip, 0.95 * undercut_roll(gear, beta))), beta};
}

template <class Check>
void for_some_flanks(const FaceGear& gear, Check&& check) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 200; ++i) {
    const int side = random.in(0.0, 1.0) < 0.5 ? 1 : -1;
    const int slot = static_cast<int>(random.in(0.0, gear.teeth));
    check(flank_of(gear, side, slot), static_cast<double>(side), some_parameters(gear, random));
  }
}

TEST(FaceFlankSurface, EveryNormalHasTheSameMomentArm) {
  for (const FaceGear& gear : {face_gear_of_table_1(), face_gear_of_table_3()}) {
    for_some_flanks(gear, [&](const FaceFlank& flank, double side, const FaceParameters& at) {
      const FacePoint p = face_point(gear, flank, at);
      EXPECT_NEAR(p.point.cross(p.normal).z(), -side * gear.arm, 1e-12);
      EXPECT_NEAR(p.normal.norm(), 1.0, 1e-15);
    });
  }
}

TEST(FaceFlankSurface, AParallelSurfaceIsTheFlankTurned) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  for_some_flanks(gear, [&](const FaceFlank& flank, double side, const FaceParameters& at) {
    const double offset = 1.25;
    const FacePoint p = face_point(gear, flank, at);
    const Vec3 turned = turned_by(side * offset / gear.arm, p.point + offset * p.normal);
    EXPECT_NEAR(distance_from_face(gear, flank, turned).distance, 0.0, 1e-12);
  });
}

TEST(FaceFlankSurface, MatchesTheFormulaOfTheMeshing) {
  const FaceGear gear = face_gear_of_table_1();
  for_some_flanks(gear, [&](const FaceFlank&, double, const FaceParameters& at) {
    const Vec3 wanted = generated_point(gear, at.theta, at.beta);
    EXPECT_LT((face_point(gear, {}, at).point - wanted).norm(), 3e-13);
  });
}

TEST(FaceFlankSurface, OtherFlanksAreMirroredAndTurned) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceParameters at{0.4, 0.4};
  const FacePoint plus = face_point(gear, flank_of(gear, 1, 0), at);
  const FacePoint minus = face_point(gear, flank_of(gear, -1, 0), at);
  EXPECT_GT(plus.point.y(), 0.0);
  EXPECT_LT(plus.normal.y(), 0.0);
  EXPECT_EQ(minus.point.y(), -plus.point.y());
  EXPECT_EQ(minus.normal.y(), -plus.normal.y());
  const FacePoint seventh = face_point(gear, flank_of(gear, 1, 7), at);
  EXPECT_LT((seventh.point - turned_by(7.0 * 2.0 * kPi / 86.0, plus.point)).norm(), 1e-12);
}

TEST(FaceFlankSurface, DerivativesAreThoseOfDifferences) {
  constexpr double kStep = 1e-5;
  const FaceGear gear = face_gear_of_table_3();
  for_some_flanks(gear, [&](const FaceFlank& flank, double, const FaceParameters& at) {
    const auto difference = [&](double theta, double beta, Vec3 FacePoint::*what) {
      const FacePoint after = face_point(gear, flank, {at.theta + theta, at.beta + beta});
      const FacePoint before = face_point(gear, flank, {at.theta - theta, at.beta - beta});
      return Vec3((after.*what - before.*what) / (2.0 * kStep));
    };
    const FacePartials d = face_partials(gear, flank, at);
    EXPECT_LT((d.point_theta - difference(kStep, 0.0, &FacePoint::point)).norm(), 1e-7);
    EXPECT_LT((d.point_beta - difference(0.0, kStep, &FacePoint::point)).norm(), 1e-7);
    EXPECT_LT((d.normal_theta - difference(kStep, 0.0, &FacePoint::normal)).norm(), 1e-9);
    EXPECT_LT((d.normal_beta - difference(0.0, kStep, &FacePoint::normal)).norm(), 1e-9);
  });
}

// Where the tangents line up the surface folds back.
TEST(FaceFlankSurface, IsRegularUpToTheUndercut) {
  const FaceGear gear = face_gear_of_table_3();
  const auto area = [&](const FaceParameters& at) {
    const FacePartials d = face_partials(gear, {}, at);
    return d.point_theta.cross(d.point_beta).dot(face_point(gear, {}, at).normal);
  };
  for (double beta = 0.05; beta < 0.7; beta += 0.05) {
    const double fold = undercut_roll(gear, beta);
    EXPECT_NEAR(area({fold, beta}), 0.0, 1e-9);
    EXPECT_LT(area({0.999 * fold, beta}), 0.0);
    EXPECT_GT(area({1.001 * fold, beta}), 0.0);
  }
}

// --- tip relief

TEST(FaceRelief, SetsTheFlankBackTowardsTheTip) {
  const FaceGear gear = face_gear_of_table_3();
  EXPECT_EQ(relief_at(gear.relief, 48.4).depth, 0.0);
  EXPECT_NEAR(relief_at(gear.relief, 46.0).depth, 0.060, 1e-15);
  const ReliefAt at = relief_at(gear.relief, 47.2);
  EXPECT_NEAR(at.depth, 0.015, 1e-15);
  EXPECT_NEAR(at.slope, (relief_at(gear.relief, 47.201).depth - 0.015) / 0.001, 2e-5);
  EXPECT_NEAR(at.change, 2.0 * 0.060 / (2.4 * 2.4), 1e-15);
}

TEST(FaceRelief, ItsNormalsAreSquareToTheSurface) {
  constexpr double kStep = 1e-6;
  const FaceGear gear = face_gear_of_table_3();
  const FaceFlank flank = flank_of(gear, -1, 11);
  for (double theta = 0.22; theta < 0.4; theta += 0.03) {
    for (double beta = 0.3; beta < 0.5; beta += 0.05) {
      const auto point = [&](double t, double b) {
        return relieved_face_point(gear, flank, {theta + t, beta + b}).point;
      };
      const FacePoint at = relieved_face_point(gear, flank, {theta, beta});
      EXPECT_NEAR(at.normal.dot(point(kStep, 0.0) - point(-kStep, 0.0)) / kStep, 0.0, 1e-6);
      EXPECT_NEAR(at.normal.dot(point(0.0, kStep) - point(0.0, -kStep)) / kStep, 0.0, 1e-6);
      EXPECT_GT(at.normal.dot(face_point(gear, flank, {theta, beta}).normal), 0.99);
    }
  }
}

TEST(FaceRelief, SecondDerivativesAreThoseOfDifferences) {
  constexpr double kStep = 1e-5;
  const FaceGear gear = face_gear_of_table_3();
  const FaceParameters at{0.27, 0.41};
  const auto tangent = [&](double t, double b, Vec3 ReliefTangents::*what) {
    const FaceParameters there{at.theta + t, at.beta + b};
    const FaceTriad triad(gear, there);
    return triad.to_gear(relief_tangents(gear, triad, there).*what);
  };
  const auto difference = [&](double t, double b, Vec3 ReliefTangents::*what) {
    return Vec3((tangent(t, b, what) - tangent(-t, -b, what)) / (2.0 * kStep));
  };
  using T = ReliefTangents;
  EXPECT_LT((tangent(0, 0, &T::theta) - difference(kStep, 0, &T::point)).norm(), 1e-7);
  EXPECT_LT((tangent(0, 0, &T::beta) - difference(0, kStep, &T::point)).norm(), 1e-7);
  EXPECT_LT((tangent(0, 0, &T::theta_theta) - difference(kStep, 0, &T::theta)).norm(), 1e-7);
  EXPECT_LT((tangent(0, 0, &T::theta_beta) - difference(0, kStep, &T::theta)).norm(), 1e-7);
  EXPECT_LT((tangent(0, 0, &T::theta_beta) - difference(kStep, 0, &T::beta)).norm(), 1e-7);
  EXPECT_LT((tangent(0, 0, &T::beta_beta) - difference(0, kStep, &T::beta)).norm(), 1e-7);
}

}  // namespace
}  // namespace volcomp::test
