// Patches through points that are no flank, and what the paper's searches refuse.

#include <cmath>
#include <random>
#include <vector>

#include "host_sim/experiments/face_gear/patch/closest_point.hpp"
#include "host_sim/experiments/face_gear/patch/printed_face_search.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/face_gears.hpp"

namespace volcomp::face_gear {
namespace {

using test::kDegree;

// A grid whose points are given by row and column.
template <class At>
std::vector<Vec3> grid_of_points(const At& at) {
  std::vector<Vec3> points;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column)
      points.push_back(at(static_cast<double>(row), static_cast<double>(column)));
  }
  return points;
}

TEST(SplinePatchRefusal, TwoColumnsInOnePlaceHaveNoLengthBetweenThem) {
  const auto doubled = grid_of_points([](double row, double column) {
    return Vec3(row, column > 4.0 ? column - 1.0 : column, 0.0);
  });
  SplinePatch patch;
  const Status s = SplinePatch::through(doubled, Parametrisation::chord, patch);
  EXPECT_EQ(s.reason, Reason::coincident);
  EXPECT_EQ(s.where.index, 5);
  EXPECT_TRUE(SplinePatch::through(doubled, Parametrisation::uniform, patch).ok());
}

TEST(ClosestPointRefusal, APatchThatIsALineHasNoNormal) {
  const auto line =
      grid_of_points([](double row, double column) { return Vec3(row + column, 0.0, 0.0); });
  SplinePatch patch;
  ASSERT_TRUE(SplinePatch::through(line, Parametrisation::uniform, patch).ok());
  ClosestPoint c;
  EXPECT_EQ(closest_point(patch, {-5.0, 1.0, 0.0}, Vec3::UnitZ(), c).reason, Reason::zero_normal);
}

// Steps of 3 mm up and down between neighbours: what is found is a foot, or it is reported that
// there is none.
TEST(ClosestPoint, OnARoughPatchEitherSettlesOrSaysThatItDidNot) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  const auto rough = grid_of_points([&](double row, double column) {
    return Vec3(row + between(-0.3, 0.3), column + between(-0.3, 0.3), between(-3.0, 3.0));
  });
  SplinePatch patch;
  ASSERT_TRUE(SplinePatch::through(rough, Parametrisation::uniform, patch).ok());
  int unsettled = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3 q(between(-2.0, 9.0), between(-2.0, 17.0), between(-6.0, 6.0));
    ClosestPoint c;
    const Status s = closest_point(patch, q, Vec3::UnitZ(), c);
    if (!s.ok()) {
      EXPECT_EQ(s.reason, Reason::not_converged);
      EXPECT_EQ(s.where.count, 30);
      ++unsettled;
      continue;
    }
    EXPECT_LE(std::abs(c.distance), (q - c.foot).norm() + 1e-12);
    EXPECT_GE(c.u, 0.0);
    EXPECT_LE(c.u, 1.0);
  }
  EXPECT_GT(unsettled, 0);
  EXPECT_LT(unsettled, 200);
}

TEST(ClosestPointRefusal, OutwardIsADirectionAndAnAccuracyAtMostOne) {
  const auto flat =
      grid_of_points([](double row, double column) { return Vec3(row, column, 0.0); });
  SplinePatch patch;
  ASSERT_TRUE(SplinePatch::through(flat, Parametrisation::uniform, patch).ok());
  ClosestPoint c;
  EXPECT_EQ(closest_point(patch, Vec3::Zero(), {kNan, 0.0, 1.0}, c).reason, Reason::not_finite);
  SubdivisionSearch search;
  const Status s = closest_point_by_subdivision(patch, Vec3::Zero(), 10, 1.5, search);
  EXPECT_EQ(s.reason, Reason::bad_setting);
  EXPECT_STREQ(s.where.field, "accuracy");
}

TEST(PrintedFaceAngleRefusal, ABallThatIsNowhereAndABallInsideTheGear) {
  const FaceGear gear = face_gear_of_table_3();
  FaceContact contact{FaceFlank{}, 0.5, Vec3(20.34, kNan, 47.0)};
  FaceAngle found;
  const PrintedFaceSearch search{1.0 * kDegree, 2.72};
  EXPECT_EQ(printed_face_angle(gear, contact, 0.0, search, found).reason, Reason::not_finite);
  contact.centre = {10.0, 20.0, 47.0};
  EXPECT_EQ(printed_face_angle(gear, contact, 0.0, search, found).reason, Reason::inside_gear_base);
}

}  // namespace
}  // namespace volcomp::face_gear
