// Distances from flanks of face gears, against minimisers and against what turning does
// (docs/papers/face-gear.md, "What we do"), and the points that have none.

#include <limits>

#include "comp/probe/face_relief.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/face_gears.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

// Least distance of q from the surface around a parameter pair.
template <class Surface>
double searched_distance(const Vec3& q, const FaceParameters& about, Surface&& surface) {
  constexpr double kAround = 0.05;
  return least(
      [&](double beta) {
        return least([&](double theta) { return (q - surface(theta, beta)).norm(); },
                     about.theta - kAround, about.theta + kAround);
      },
      about.beta - kAround, about.beta + kAround);
}

TEST(FaceDistance, IsTheLeastDistance) {
  for (const FaceGear& gear : {face_gear_of_table_1(), small_face_gear()}) {
    const FaceGrid grid = grid_of(gear, plan_face_grid(gear));
    for (const double offset : {0.05, 0.5, 1.5}) {
      for (std::size_t column = 0; column < kGridColumns; column += 7) {
        const FaceGridNode& node = grid[3][column];
        const Vec3 q = node.point + offset * (node.normal + Vec3(0.02, 0.02, -0.03));
        const double searched = searched_distance(q, node.at, [&](double theta, double beta) {
          return generated_point(gear, theta, beta);
        });
        EXPECT_NEAR(distance_from_face(gear, {}, q).distance, searched, 1e-9);
      }
    }
  }
}

TEST(FaceDistance, GivesBackFootNormalAndOffset) {
  Random random;
  SCOPED_TRACE(random.trace());
  const FaceGear gear = without_relief(face_gear_of_table_3());
  const FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  int most_steps = 0;
  for (const auto& row : grid) {
    for (const FaceGridNode& node : row) {
      const FaceFlank flank = flank_of(gear, random.in(0.0, 1.0) < 0.5 ? 1 : -1,
                                       static_cast<int>(random.in(0.0, 86.0)));
      const FacePoint on = on_flank(node, flank);
      const double offset = random.in(-2.0, 3.0);
      const FaceFoot foot = distance_from_face(gear, flank, on.point + offset * on.normal);
      EXPECT_NEAR(foot.distance, offset, 2e-13);
      EXPECT_NEAR(foot.theta, node.at.theta, 1e-13);
      EXPECT_NEAR(foot.beta, node.at.beta, 1e-13);
      EXPECT_LT((foot.point - on.point).norm(), 1e-12);
      EXPECT_LT((foot.normal - on.normal).norm(), 1e-14);
      EXPECT_EQ(foot.reason, Reason::ok);
      const FaceFoot near = distance_from_face(gear, flank, on.point + 0.5 * on.normal);
      most_steps = std::max(most_steps, near.steps);
    }
  }
  EXPECT_LE(most_steps, 4);
}

TEST(FaceDistance, BothFlanksOfASlotFromOneSection) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceFlank flank = flank_of(gear, -1, 64);
  const FaceFlank opposite = flank_of(gear, 1, 64);
  const Vec3 q(-8.468505710290918, -169.06451932983782, 51.163944362709834);
  const FaceFeet feet = distances_in_slot(gear, flank, q);
  EXPECT_EQ(feet.here.distance, distance_from_face(gear, flank, q).distance);
  EXPECT_EQ(feet.opposite.distance, distance_from_face(gear, opposite, q).distance);
  EXPECT_EQ(feet.opposite.point, distance_from_face(gear, opposite, q).point);
  const Vec3 nowhere(10.0, 0.0, 50.0);
  EXPECT_EQ(distances_in_slot(gear, flank, nowhere).here.reason, Reason::inside_gear_base);
  EXPECT_EQ(distances_in_slot(gear, flank, nowhere).opposite.reason, Reason::inside_gear_base);
}

// Equation 30 of the paper projects on the normal of the nominal point: beside it by τ it errs by
// τ² over twice the radius of curvature, where the distance itself does not care.
TEST(FaceDistance, NeedsNoNominalPoint) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  const FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  const auto largest_error = [&](double beside) {
    double largest = 0.0;
    for (std::size_t row = 0; row < kGridRows; ++row) {
      const FaceGridNode& node = grid[row][7];
      const FacePartials d = face_partials(gear, {}, node.at);
      // Across the teeth, on a point of the flank that much to the side of the nominal one.
      const double step = beside / d.point_theta.norm();
      const Vec3 p = face_point(gear, {}, {node.at.theta + step, node.at.beta}).point;
      const Vec3 q = p + 0.5 * face_point(gear, {}, {node.at.theta + step, node.at.beta}).normal;
      EXPECT_NEAR(distance_from_face(gear, {}, q).distance, 0.5, 1e-12);
      largest = std::max(largest, std::abs((q - node.point).dot(node.normal) - 0.5));
    }
    return largest;
  };
  EXPECT_GT(largest_error(0.5), 1e-4);
  EXPECT_LT(largest_error(0.1), 2.2e-4);
  EXPECT_NEAR(largest_error(0.1) / largest_error(0.04), 6.25, 0.2);
  EXPECT_NEAR(largest_error(0.5) / largest_error(0.1), 25.0, 2.0);
}

// --- with tip relief

TEST(FaceReliefDistance, IsTheLeastDistance) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < kGridColumns; column += 7) {
      const FaceGridNode& node = grid[row][column];
      const Vec3 q = node.point + 0.5 * (node.normal + Vec3(0.02, 0.02, -0.03));
      const double searched = searched_distance(q, node.at, [&](double theta, double beta) {
        const Vec3 p = generated_point(gear, theta, beta);
        const double turn = gear.ratio * (theta - gear.theta0 - beta);
        const Vec3 n = -turned_by(-turn, {0.0, std::cos(beta), std::sin(beta)});
        const double along = std::max(0.0, (48.4 - p.z()) / 2.4);
        return Vec3(p - 0.060 * along * along * n);
      });
      EXPECT_NEAR(distance_from_relieved_face(gear, {}, q).distance, searched, 1e-9);
    }
  }
}

TEST(FaceReliefDistance, ExactInAFewSteps) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceFlank flank = flank_of(gear, -1, 30);
  for (const auto& row : grid_of(gear, face_grid_of_table_3())) {
    for (const FaceGridNode& node : row) {
      for (const double offset : {-0.2, 0.0, 0.3, 1.5}) {
        const FacePoint on = on_flank(node, flank);
        const FaceFoot foot =
            distance_from_relieved_face(gear, flank, on.point + offset * on.normal);
        EXPECT_NEAR(foot.distance, offset, 1e-12);
        EXPECT_NEAR(foot.theta, node.at.theta, 1e-11);
        EXPECT_NEAR(foot.beta, node.at.beta, 1e-11);
        EXPECT_LT((foot.normal - on.normal).norm(), 1e-11);
        EXPECT_LE(foot.steps, 7);
      }
    }
  }
}

TEST(FaceReliefDistance, ClosedFormIsGoodToThreeNanometres) {
  const FaceGear gear = face_gear_of_table_3();
  FaceGridPlan plan = face_grid_of_table_3();
  plan.tip_depths[0] = gear.z_tip + 0.001;
  double without_last_term = 0.0;
  for (const auto& row : grid_of(gear, plan)) {
    for (const FaceGridNode& node : row) {
      for (double offset = 0.25; offset <= 1.5; offset += 0.25) {
        const FaceFoot foot = distance_from_face(gear, {}, node.point + offset * node.normal);
        EXPECT_NEAR(relieved_distance(gear, foot), offset, 3e-6);
        const double two_terms = foot.distance + relief_at(gear.relief, foot.point.z()).depth;
        without_last_term = std::max(without_last_term, std::abs(two_terms - offset));
      }
    }
  }
  EXPECT_NEAR(without_last_term, 1.5e-3, 3e-4);
}

TEST(FaceReliefDistance, WithoutReliefItIsTheOther) {
  const FaceGear gear = face_gear_of_table_1();
  const Vec3 q = grid_of(gear, plan_face_grid(gear))[0][3].point;
  const FaceFoot foot = distance_from_face(gear, {}, q);
  EXPECT_EQ(distance_from_relieved_face(gear, {}, q).distance, foot.distance);
  EXPECT_EQ(relieved_distance(gear, foot), foot.distance);
}

// --- points without a distance, or without a flank at their foot

Reason reason_at(const Vec3& q) {
  const FaceGear gear = face_gear_of_table_3();
  return distance_from_face(gear, {}, q).reason;
}

TEST(FaceFootReason, NotFinite) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(reason_at({kNan, 1.0, 50.0}), Reason::not_finite);
  EXPECT_EQ(reason_at({170.0, -kInf, 50.0}), Reason::not_finite);
  EXPECT_EQ(reason_at({170.0, 4.0, kInf}), Reason::not_finite);
  const FaceGear gear = face_gear_of_table_3();
  EXPECT_TRUE(std::isnan(distance_from_face(gear, {}, {kNan, 1.0, 50.0}).distance));
}

TEST(FaceFootReason, InsideTheBaseRadius) {
  EXPECT_EQ(reason_at({150.0, 2.0, 50.0}), Reason::inside_gear_base);
  EXPECT_EQ(reason_at({155.962, 0.0, 48.0}), Reason::inside_gear_base);
  EXPECT_EQ(reason_at({0.0, 0.0, 0.0}), Reason::inside_gear_base);
}

TEST(FaceFootReason, NoRegularFlank) {
  EXPECT_EQ(reason_at({160.2, 3.0, 58.0}), Reason::no_regular_flank);
  EXPECT_EQ(reason_at({1e6, 0.0, 50.0}), Reason::no_regular_flank);
  EXPECT_EQ(reason_at({1e300, 1e300, 50.0}), Reason::no_regular_flank);
  EXPECT_EQ(reason_at({170.0, 0.0, 1e300}), Reason::no_regular_flank);
}

// Feet off the flank are found by going there along the surface.
TEST(FaceFootReason, OffTheFlankOnEverySide) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  const auto at = [&](double theta, double beta) {
    const FacePoint p = face_point(gear, {}, {theta, beta});
    return distance_from_face(gear, {}, p.point + 0.1 * p.normal);
  };
  EXPECT_EQ(at(0.4, 0.42).reason, Reason::ok);
  EXPECT_EQ(at(-0.02, 0.42).reason, Reason::below_involute);
  EXPECT_EQ(at(gear.theta_tip + 0.01, 0.42).reason, Reason::in_fillet);
  EXPECT_EQ(at(0.15, 0.42).reason, Reason::above_tip);
  EXPECT_NEAR(at(0.15, 0.42).distance, 0.1, 1e-12);
}

// A point on the flank below the fold, turned into the slot until its foot is beyond.
TEST(FaceFootReason, Undercut) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  for (const double beta : {0.8 * gear.undercut_beta, 0.4}) {
    const double fold = undercut_roll(gear, beta);
    const Vec3 p = face_point(gear, {}, {0.98 * fold, beta}).point;
    const double offset = 0.04 * fold * gear.r_bs;
    const FaceFoot foot = distance_from_face(gear, {}, turned_by(-offset / gear.arm, p));
    EXPECT_EQ(foot.reason, Reason::undercut);
    EXPECT_NEAR(foot.distance, offset, 1e-11);
  }
}

TEST(FaceFootReason, UnusableFeatures) {
  const FaceGear gear = face_gear_of_table_3();
  FaceFlank flank{-1.0, 0.5, 0.5};
  EXPECT_EQ(choose_flank(gear, 0, 0, flank).reason, Reason::bad_point);
  EXPECT_STREQ(choose_flank(gear, 2, 0, flank).where.field, "side");
  EXPECT_STREQ(choose_flank(gear, 1, -1, flank).where.field, "slot");
  EXPECT_STREQ(choose_flank(gear, 1, 86, flank).where.field, "slot");
  EXPECT_EQ(flank.cosine, 0.5);
}

}  // namespace
}  // namespace volcomp::test
