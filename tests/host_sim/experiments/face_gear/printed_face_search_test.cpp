// What the search of the paper for the angle of a face gear costs, where the closed form needs one
// distance (docs/papers/face-gear.md, eq. 27 and 28).

#include "host_sim/experiments/face_gear/patch/printed_face_search.hpp"

#include "tests/oracle/face_gears.hpp"

namespace volcomp::face_gear {
namespace {

using test::kDegree;

// Printed with two decimals; radius and side are inferred.
FaceContact worked_example() { return {FaceFlank{}, 0.5, Vec3(20.34, 170.14, 47.0)}; }

Status search(double range, bool radius_taken_off, int most, FaceAngle& found) {
  PrintedFaceSearch printed;
  printed.step = 1.0 * kDegree;
  printed.range = range;
  printed.radius_taken_off = radius_taken_off;
  printed.most_evaluations = most;
  return printed_face_angle(test::without_relief(face_gear_of_table_3()), worked_example(), 0.0,
                            printed, found);
}

// From the angle 0, to 0.1 µm.
TEST(FaceAngleCost, SearchOfThePaperWithTheRadiusTakenOff) {
  FaceAngle found;
  EXPECT_EQ(search(5.0, true, 60000, found).reason, Reason::residuals_too_large);
  ASSERT_TRUE(search(2.72, true, 60000, found).ok());
  EXPECT_EQ(found.evaluations, 27260);
  EXPECT_NEAR(found.gamma / kDegree, -81.86236, 1e-4);
  ASSERT_TRUE(search(1.0, true, 60000, found).ok());
  EXPECT_NEAR(found.evaluations, 3704, 2);
}

// At contact its step is θ_0 (r/l_max)²: it never rests.
TEST(FaceAngleCost, SearchOfThePaperAsPrintedNeverEnds) {
  for (const double range : {5.0, 2.72, 1.0}) {
    FaceAngle found;
    const Status status = search(range, false, 20000, found);
    EXPECT_EQ(status.reason, Reason::residuals_too_large) << range;
    EXPECT_EQ(status.where.count, 20000);
    EXPECT_TRUE(status.where.has_deviation);
    EXPECT_GT(std::abs(found.rest), 1e-3);
  }
}

}  // namespace
}  // namespace volcomp::face_gear
