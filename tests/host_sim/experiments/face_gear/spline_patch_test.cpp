// The patch through a flank, against the paper's Table 3 and the closed form of the gear behind it.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include "host_sim/experiments/face_gear/patch/spline_patch.hpp"
#include "tests/oracle/face_gear.hpp"
#include "tests/oracle/face_gear_tables.hpp"

namespace volcomp::face_gear {
namespace {

using reference::FaceGear;

constexpr double kMicron = 1e-3;

std::array<Vec3, kGridCells> grid_of(const FaceGear& gear) {
  return reference::points_of(reference::table_3_grid(gear));
}

SplinePatch patch_of(const FaceGear& gear, Parametrisation by = Parametrisation::uniform) {
  const auto grid = grid_of(gear);
  SplinePatch patch;
  EXPECT_TRUE(SplinePatch::through(grid, by, patch).ok());
  return patch;
}

// What Table 3 prints: data points of rows 1 to 5 of column 1 and rows 3 to 7 of column 15, but
// control points of rows 1 to 5 of both.
struct Printed {
  Vec3 data;
  Vec3 control;
  std::size_t data_row;
  std::size_t control_row;
  std::size_t column;
};

std::vector<Printed> table_3() {
  std::vector<Printed> rows;
  for (const auto& r : reference::numbers_of_table("table3_mm.csv")) {
    const bool last = rows.size() >= 5;
    const std::size_t row = rows.size() % 5;
    rows.push_back({{r[0], r[1], r[2]},
                    {r[3], r[4], r[5]},
                    last ? row + 2 : row,
                    row,
                    last ? kGridColumns - 1 : 0});
  }
  return rows;
}

// Largest difference of a printed coordinate of a control point from that of the patch, mm.
double off_the_print(Parametrisation by) {
  const SplinePatch patch = patch_of(reference::gear_of_table_3(), by);
  double largest = 0.0;
  for (const Printed& p : table_3())
    largest = std::max(largest,
                       (patch.control(p.control_row, p.column) - p.control).cwiseAbs().maxCoeff());
  return largest;
}

TEST(PaperTable3, TheDecodedGearIsTheOneThatWasPrinted) {
  const auto grid = grid_of(reference::gear_of_table_3());
  for (const Printed& p : table_3())
    EXPECT_LT((grid[grid_index(p.data_row, p.column)] - p.data).norm(), 1.1 * kMicron);
}

TEST(SplinePatch, UniformParametersGiveThePrintedControlPoints) {
  EXPECT_LT(off_the_print(Parametrisation::uniform), 1.0 * kMicron);
}

TEST(SplinePatch, OtherParametersDoNot) {
  EXPECT_NEAR(off_the_print(Parametrisation::chord), 237.0 * kMicron, 0.5 * kMicron);
  EXPECT_NEAR(off_the_print(Parametrisation::centripetal), 125.0 * kMicron, 0.5 * kMicron);
}

TEST(SplinePatch, KnotsAreTheOnesOfTheSpecification) {
  const std::array<double, 11> u{0, 0, 0, 0, 1.0 / 3, 0.5, 2.0 / 3, 1, 1, 1, 1};
  const SplinePatch patch = patch_of(FaceGear{});
  for (std::size_t k = 0; k < u.size(); ++k)
    EXPECT_NEAR(patch.profile().knots()[k], u[k], 1e-15) << k;
  for (std::size_t k = 4; k < 15; ++k)
    EXPECT_NEAR(patch.width().knots()[k], static_cast<double>(k - 2) / 14.0, 1e-15) << k;
}

TEST(SplinePatch, PassesThroughEveryNode) {
  for (const auto by :
       {Parametrisation::uniform, Parametrisation::chord, Parametrisation::centripetal}) {
    const auto grid = grid_of(reference::gear_of_table_3());
    const SplinePatch patch = patch_of(reference::gear_of_table_3(), by);
    for (std::size_t i = 0; i < kGridCells; ++i) {
      const double u = patch.profile().parameters()[i / kGridColumns];
      const double v = patch.width().parameters()[i % kGridColumns];
      EXPECT_LT((patch.at(u, v).point - grid[i]).norm(), 1e-12);
    }
  }
}

TEST(SplinePatch, DerivativesAreThoseOfItsPoints) {
  const SplinePatch patch = patch_of(reference::gear_of_table_3());
  constexpr double kStep = 1e-5;
  for (const double u : {0.11, 0.42, 0.6, 0.93}) {
    for (const double v : {0.02, 0.31, 0.55, 0.98}) {
      const PatchPoint p = patch.at(u, v);
      const PatchPoint up = patch.at(u + kStep, v);
      const PatchPoint down = patch.at(u - kStep, v);
      const PatchPoint on = patch.at(u, v + kStep);
      const PatchPoint back = patch.at(u, v - kStep);
      EXPECT_LT((p.du - (up.point - down.point) / (2.0 * kStep)).norm(), 1e-7);
      EXPECT_LT((p.dv - (on.point - back.point) / (2.0 * kStep)).norm(), 1e-7);
      EXPECT_LT((p.duu - (up.du - down.du) / (2.0 * kStep)).norm(), 1e-6);
      EXPECT_LT((p.duv - (on.du - back.du) / (2.0 * kStep)).norm(), 1e-6);
      EXPECT_LT((p.dvv - (on.dv - back.dv) / (2.0 * kStep)).norm(), 1e-6);
    }
  }
}

// Distance from the base flank, over a fine raster of places on the patch through the nodes of
// the base flank.
TEST(SplinePatch, BetweenItsNodesTheBaseFlankIsWithinAnEighthOfAMicron) {
  const FaceGear gear;
  const SplinePatch patch = patch_of(gear);
  double largest = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 140; ++j) {
      const double off = reference::distance(gear, patch.at(i / 60.0, j / 140.0).point, 1, 0);
      largest = std::max(largest, std::abs(off));
      squares += off * off;
      ++count;
    }
  }
  EXPECT_LT(largest, 0.13 * kMicron);
  EXPECT_LT(std::sqrt(squares / count), 0.016 * kMicron);
}

// The relief begins with a jump of the curvature, which no patch can follow: a promise of 3e-5 mm
// holds in the nodes and nowhere else.
TEST(SplinePatch, BetweenItsNodesTheRelievedFlankIsWithinAMicronAndAQuarter) {
  const FaceGear gear = reference::gear_of_table_3();
  const SplinePatch patch = patch_of(gear);
  double largest = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 140; ++j) {
      const Vec3 p = patch.at(i / 60.0, j / 140.0).point;
      // The foot on the base flank, from there the depth of the relief.
      const double lambda = reference::distance(gear, p, 1, 0);
      double z = p.z();
      for (int k = 0; k < 20; ++k)  // p = base − depth · n: one unknown height
        z = p.z() -
            lambda * reference::flank_point(FaceGear{}, reference::parameters_at(gear, p.x(), z))
                         .normal.z();
      const double in = std::max(0.0, (48.4 - z) / 2.4);
      const double off = lambda + 0.060 * in * in;
      largest = std::max(largest, std::abs(off));
      squares += off * off;
      ++count;
    }
  }
  EXPECT_LT(largest, 1.25 * kMicron);
  EXPECT_GT(largest, 0.5 * kMicron);
  EXPECT_LT(std::sqrt(squares / count), 0.3 * kMicron);
}

// --- refusals

TEST(BadPatch, WantsAllPointsOfTheGrid) {
  const std::vector<Vec3> few(kGridCells - 1, Vec3::Zero());
  SplinePatch patch;
  const Status s = SplinePatch::through(few, Parametrisation::uniform, patch);
  EXPECT_EQ(s.reason, Reason::length_mismatch);
  EXPECT_EQ(s.where.count, 104);
}

TEST(BadPatch, NamesThePointThatIsNoNumber) {
  auto grid = grid_of(FaceGear{});
  grid[33].y() = std::nan("");
  SplinePatch kept = patch_of(FaceGear{});
  const Vec3 before = kept.control(2, 3);
  const Status s = SplinePatch::through(grid, Parametrisation::uniform, kept);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 33);
  EXPECT_EQ(kept.control(2, 3), before);
}

TEST(BadPatch, ALineWithoutLengthHasNoChordParameters) {
  auto grid = grid_of(FaceGear{});
  for (std::size_t column = 0; column < kGridColumns; ++column)
    grid[grid_index(2, column)] = grid[grid_index(2, 0)];
  SplinePatch patch;
  EXPECT_EQ(SplinePatch::through(grid, Parametrisation::chord, patch).reason, Reason::coincident);
  const std::vector<Vec3> one_place(kGridCells, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(SplinePatch::through(one_place, Parametrisation::centripetal, patch).reason,
            Reason::coincident);
}

}  // namespace
}  // namespace volcomp::face_gear
