// Where a face gear stands on the turntable: the worked example of the paper
// (docs/papers/face-gear.md), and what each way to find it costs.

#include "comp/metrology/faces/face_angle.hpp"

#include <limits>

#include "comp/probe/face_relief.hpp"
#include "tests/oracle/face_gears.hpp"

namespace volcomp::test {
namespace {

// Printed with two decimals; radius and side are inferred.
FaceContact worked_example() { return {FaceFlank{}, 0.5, Vec3(20.34, 170.14, 47.0)}; }

double degrees(double angle) { return angle / kDegree; }

TEST(FaceAngle, WorkedExampleOfThePaper) {
  const FaceGear gear = face_gear_of_table_3();
  double base = 0.0;
  ASSERT_TRUE(face_angle(gear, worked_example(), base).ok());
  EXPECT_NEAR(degrees(base), -81.86236, 5e-6);
  FaceAngle relieved;
  ASSERT_TRUE(relieved_face_angle(gear, worked_example(), base, 1e-12, relieved).ok());
  EXPECT_NEAR(degrees(relieved.gamma), -81.85691, 5e-6);
  EXPECT_NEAR(degrees(relieved.gamma), -81.857, 0.0017);  // printed; inputs rounded to 0.01 mm
  const Vec3 q = turned_by(-81.857 * kDegree, worked_example().centre);
  EXPECT_NEAR(distance_from_relieved_face(gear, {}, q).distance, 0.50025, 5e-6);
}

TEST(FaceAngle, OfAnyFlankIsWhereTheBallTouches) {
  const FaceGear gear = without_relief(face_gear_of_table_1());
  const FaceGridNode node = grid_of(gear, plan_face_grid(gear))[3][7];
  for (const int side : {1, -1}) {
    for (const int slot : {0, 1, 70, 141}) {
      const FaceFlank flank = flank_of(gear, side, slot);
      const FacePoint on = on_flank(node, flank);
      const Vec3 q = turned_by(0.003, on.point + 0.5 * on.normal);
      double gamma = 0.0;
      ASSERT_TRUE(face_angle(gear, {flank, 0.5, q}, gamma).ok());
      EXPECT_NEAR(std::remainder(gamma, 2.0 * kPi), -0.003, 1e-14);
    }
  }
}

// --- what it costs, to 0.1 µm

TEST(FaceAngleCost, StepsWithTheMomentArm) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceGear plain = without_relief(gear);
  for (const double off : {-1.5 * kDegree, 1.5 * kDegree}) {
    const double start = -81.857 * kDegree + off;
    FaceAngle found;
    ASSERT_TRUE(relieved_face_angle(gear, worked_example(), start, 1e-4, found).ok());
    EXPECT_EQ(found.evaluations, 4);
    ASSERT_TRUE(relieved_face_angle(gear, worked_example(), start, 1e-10, found).ok());
    EXPECT_EQ(found.evaluations, 7);
    ASSERT_TRUE(relieved_face_angle(plain, worked_example(), start, 1e-10, found).ok());
    EXPECT_EQ(found.evaluations, 2);  // one step, and the proof that it was enough
  }
}

// --- refusals

TEST(FaceAngle, UnusableContactsAreRefused) {
  const FaceGear gear = face_gear_of_table_3();
  double gamma = 7.0;
  FaceContact contact = worked_example();
  contact.centre.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(face_angle(gear, contact, gamma).reason, Reason::not_finite);
  contact = worked_example();
  contact.ball_radius = 0.0;
  EXPECT_EQ(face_angle(gear, contact, gamma).reason, Reason::bad_point);
  contact = worked_example();
  contact.centre = {10.0, 20.0, 47.0};
  EXPECT_EQ(face_angle(gear, contact, gamma).reason, Reason::inside_gear_base);
  contact.centre = {20.34, 170.14, 45.0};
  EXPECT_EQ(face_angle(gear, contact, gamma).reason, Reason::above_tip);
  EXPECT_EQ(gamma, 7.0);
  FaceAngle found;
  EXPECT_EQ(relieved_face_angle(gear, worked_example(), -1.4, 0.0, found).reason,
            Reason::bad_setting);
  EXPECT_EQ(found.evaluations, 0);
}

// --- machine and gear

TEST(FacePlacement, GoesThereAndBack) {
  const FacePlacement placement{{95.9, 113.4, 98.4}, -1.56};
  const Vec3 p(11.3, 72.4, -18.7);
  EXPECT_LT((to_gear(placement, to_machine(placement, p)) - p).norm(), 1e-13);
  const Vec3 expected =
      placement.origin + Vec3(1.0, -1.0, -1.0).cwiseProduct(turned_by(placement.angle, p));
  EXPECT_LT((to_machine(placement, p) - expected).norm(), 1e-13);
}

// Eq. 21 and 25 as printed have the determinant −1: right flanks would come out as left ones.
TEST(FacePlacement, DoesNotMirror) {
  const FacePlacement placement{Vec3::Zero(), 0.7};
  const Vec3 x = direction_to_machine(placement, Vec3::UnitX());
  const Vec3 y = direction_to_machine(placement, Vec3::UnitY());
  EXPECT_LT((x.cross(y) - direction_to_machine(placement, Vec3::UnitZ())).norm(), 1e-15);
  EXPECT_LT((direction_to_machine(placement, Vec3::UnitZ()) + Vec3::UnitZ()).norm(), 1e-15);
}

// Eq. 23 leaves the radius out: then the point that was commanded lies on the flank, not the ball.
TEST(FacePlacement, TheBallTouchesTheFlank) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  const FacePlacement placement{{300.0, -20.0, 150.0}, 0.4};
  const FaceFlank flank = flank_of(gear, -1, 5);
  const FacePoint on = face_point(gear, flank, {0.4, 0.4});
  const Vec3 target = to_machine(placement, on.point + 0.5 * on.normal);
  EXPECT_NEAR(distance_from_face(gear, flank, to_gear(placement, target)).distance, 0.5, 1e-12);
}

}  // namespace
}  // namespace volcomp::test
