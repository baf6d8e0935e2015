// The nearest point of a patch: found by Newton, and by the paper's subdivision for comparison.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include "host_sim/experiments/face_gear/patch/closest_point.hpp"
#include "tests/oracle/face_gear.hpp"

namespace volcomp::face_gear {
namespace {

const Vec3 kOutward = -Vec3::UnitY();  // side +1: the slot is at smaller y

const SplinePatch& patch() {
  static const SplinePatch made = [] {
    SplinePatch p;
    const auto grid = reference::points_of(reference::table_3_grid(reference::gear_of_table_3()));
    EXPECT_TRUE(SplinePatch::through(grid, Parametrisation::uniform, p).ok());
    return p;
  }();
  return made;
}

struct Known {
  double u, v, distance;
  Vec3 q;
};

// Points off the patch by a known distance along its normal.
std::vector<Known> known_points(int count) {
  std::mt19937 random(20240617);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  std::vector<Known> points;
  for (int k = 0; k < count; ++k) {
    Known p{between(0.01, 0.99), between(0.01, 0.99), between(-0.5, 1.5), {}};
    const PatchPoint at = patch().at(p.u, p.v);
    p.q = at.point + p.distance * normal_of(at, kOutward);
    points.push_back(p);
  }
  return points;
}

TEST(ClosestPoint, FindsTheFootAndTheSignInAHandfulOfIterations) {
  int most = 0;
  for (const Known& p : known_points(500)) {
    ClosestPoint c;
    ASSERT_TRUE(closest_point(patch(), p.q, kOutward, c).ok());
    EXPECT_NEAR(c.distance, p.distance, 1e-12);
    EXPECT_NEAR(c.u, p.u, 1e-9);
    EXPECT_NEAR(c.v, p.v, 1e-9);
    most = std::max(most, c.iterations);
  }
  EXPECT_LE(most, 6);
}

TEST(ClosestPoint, BeyondAnEdgeTheFootIsOnTheEdge) {
  const PatchPoint edge = patch().at(0.0, 0.4);
  ClosestPoint c;
  ASSERT_TRUE(closest_point(patch(), edge.point - 0.05 * edge.du, kOutward, c).ok());
  EXPECT_NEAR(c.u, 0.0, 0.0);
  EXPECT_NEAR(c.v, 0.4, 0.02);
  const PatchPoint corner = patch().at(1.0, 1.0);
  ASSERT_TRUE(
      closest_point(patch(), corner.point + 0.1 * (corner.du + corner.dv), kOutward, c).ok());
  EXPECT_NEAR(c.u, 1.0, 0.0);
  EXPECT_NEAR(c.v, 1.0, 0.0);
}

TEST(ClosestPoint, TheOtherSideOfTheSamePatchTurnsTheSign) {
  const Known p = known_points(1).front();
  ClosestPoint c;
  ASSERT_TRUE(closest_point(patch(), p.q, -kOutward, c).ok());
  EXPECT_NEAR(c.distance, -p.distance, 1e-12);
}

TEST(ClosestPoint, OfNoPlaceIsRefused) {
  ClosestPoint kept;
  kept.distance = 7.0;
  const Vec3 nowhere(std::nan(""), 0.0, 0.0);
  EXPECT_EQ(closest_point(patch(), nowhere, kOutward, kept).reason, Reason::not_finite);
  EXPECT_EQ(kept.distance, 7.0);
}

// --- the paper's subdivision

TEST(Subdivision, TakesTenLevelsOfTenByTenCellsAnd1210Evaluations) {
  SubdivisionSearch s;
  ASSERT_TRUE(closest_point_by_subdivision(patch(), known_points(1).front().q, 10, 1e-7, s).ok());
  EXPECT_EQ(s.levels, 10);
  EXPECT_EQ(s.evaluations, 1210);
}

TEST(Subdivision, Takes23LevelsOfFourByFourCellsAnd575Evaluations) {
  SubdivisionSearch s;
  ASSERT_TRUE(closest_point_by_subdivision(patch(), known_points(1).front().q, 4, 1e-7, s).ok());
  EXPECT_EQ(s.levels, 23);
  EXPECT_EQ(s.evaluations, 575);
}

TEST(Subdivision, FindsWhatNewtonFindsButNoSign) {
  for (const Known& p : known_points(72)) {
    SubdivisionSearch s;
    ASSERT_TRUE(closest_point_by_subdivision(patch(), p.q, 10, 1e-7, s).ok());
    EXPECT_NEAR(s.distance, std::abs(p.distance), 3e-6);
    EXPECT_LT((s.foot - patch().at(p.u, p.v).point).norm(), 3e-6);
    EXPECT_GE(s.distance, 0.0);
  }
}

// Largest distance it finds in the nodes of columns 1 and 15, or in all: the truth is none.
double residue_in_nodes(int cells, bool ends_only) {
  const auto grid = reference::points_of(reference::table_3_grid(reference::gear_of_table_3()));
  double largest = 0.0;
  for (std::size_t i = 0; i < kGridCells; ++i) {
    const bool end = i % kGridColumns == 0 || i % kGridColumns == kGridColumns - 1;
    if (ends_only && !end) continue;
    SubdivisionSearch s;
    EXPECT_TRUE(closest_point_by_subdivision(patch(), grid[i], cells, 3e-6, s).ok());
    largest = std::max(largest, s.distance);
  }
  return largest;
}

// The "3e-5 mm" of the paper's Table 4, which compares nodes with themselves, is this.
TEST(Subdivision, InThePrintedNodesItReturnsItsOwnStep) {
  EXPECT_LT(residue_in_nodes(10, true), 3e-5);
  EXPECT_GT(residue_in_nodes(10, true), 1e-6);
}

// Lines of u and v are not square to each other: the cells around the nearest corner need not hold
// the nearest point.
TEST(Subdivision, MayLoseTheNearestPointAndNewtonDoesNot) {
  EXPECT_NEAR(residue_in_nodes(10, false), 1.35e-4, 0.1e-4);
  EXPECT_NEAR(residue_in_nodes(4, false), 0.020, 0.001);
  for (const Vec3& node :
       reference::points_of(reference::table_3_grid(reference::gear_of_table_3()))) {
    ClosestPoint c;
    ASSERT_TRUE(closest_point(patch(), node, kOutward, c).ok());
    EXPECT_NEAR(c.distance, 0.0, 1e-12);
  }
}

TEST(Subdivision, FewerThanFourCellsAreRefused) {
  SubdivisionSearch s;
  const Vec3 q = known_points(1).front().q;
  for (const int cells : {-1, 0, 2, 3, 101}) {
    const Status status = closest_point_by_subdivision(patch(), q, cells, 1e-7, s);
    EXPECT_EQ(status.reason, Reason::bad_setting) << cells;
    EXPECT_STREQ(status.where.field, "cells");
  }
  EXPECT_EQ(closest_point_by_subdivision(patch(), q, 10, 0.0, s).reason, Reason::bad_setting);
  EXPECT_EQ(closest_point_by_subdivision(patch(), Vec3(0, std::nan(""), 0), 10, 1e-7, s).reason,
            Reason::not_finite);
}

}  // namespace
}  // namespace volcomp::face_gear
