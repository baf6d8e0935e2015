// The paper's two measurements of one gear (docs/papers/face-gear.md): its statements about them,
// and how much of the difference is a frame.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include "comp/metrology/faces/map_comparison.hpp"
#include "tests/oracle/face_gear.hpp"
#include "tests/oracle/face_gear_tables.hpp"

namespace volcomp::test {
namespace {

using Grid = std::array<SurfacePoint, kGridCells>;

constexpr double kPrinted = 1e-9;

MapDifference difference_of(std::size_t flank) {
  const reference::PaperMaps maps;
  MapDifference d;
  EXPECT_TRUE(compare_maps(maps.on_machine[flank], maps.measuring_centre[flank], d).ok());
  return d;
}

// Left is side +1, by our choice: the paper does not state it.
struct BothFlanks {
  std::array<MapDifference, 2> difference{difference_of(0), difference_of(1)};
  std::array<Grid, 2> nominal{reference::table_3_grid(reference::FaceGear{}, 1),
                              reference::table_3_grid(reference::FaceGear{}, -1)};

  [[nodiscard]] FrameShare share(const FrameMotions& freedom) const {
    const std::array<ComparedFlank, 2> flanks{
        {{&difference[0].difference, nominal[0]}, {&difference[1].difference, nominal[1]}}};
    FrameShare share;
    EXPECT_TRUE(frame_share(flanks, freedom, share).ok());
    return share;
  }
};

// --- statements of the paper, by rows and columns of the tables

TEST(PaperDifferences, OfTheLeftFlank) {
  const MapDifference d = difference_of(0);
  EXPECT_NEAR(d.row[1].largest, 3.0, kPrinted);
  EXPECT_NEAR(d.row[4].largest, 4.6, kPrinted);  // printed 4.5: column 3, 8.3 − 3.7
  EXPECT_EQ(d.row[4].column, 2U);
  EXPECT_NEAR(d.column[4].largest, 4.6, kPrinted);
  EXPECT_NEAR(d.column[9].largest, 2.4, kPrinted);
}

TEST(PaperDifferences, OfTheRightFlank) {
  const MapDifference d = difference_of(1);
  EXPECT_NEAR(d.row[1].largest, 2.8, kPrinted);
  EXPECT_NEAR(d.row[4].largest, 4.5, kPrinted);
  EXPECT_NEAR(d.column[4].largest, 3.0, kPrinted);
  EXPECT_NEAR(d.column[9].largest, 2.2, kPrinted);
}

TEST(PaperDifferences, TheLargestIsFiveMicronsAtTheLeftFlanksLastRow) {
  const MapDifference left = difference_of(0);
  EXPECT_NEAR(left.overall.largest, 5.0, kPrinted);
  EXPECT_EQ(left.overall.row, 6U);
  EXPECT_EQ(left.overall.column, 3U);
  EXPECT_LT(difference_of(1).overall.largest, 5.0 + kPrinted);
}

// --- how much of it is the frame

TEST(FrameShare, AShiftAndTheZeroingExplainTwoThirds) {
  const FrameShare s = BothFlanks().share(kShiftInXz);
  EXPECT_NEAR(s.rms_before, 2.14, 0.005);
  EXPECT_NEAR(s.rms_after, 1.25, 0.005);
  EXPECT_NEAR(s.explained, 0.66, 0.005);
  EXPECT_NEAR(s.shift.x(), -41.3, 0.05);
  EXPECT_NEAR(s.shift.z(), 4.1, 0.05);
  EXPECT_EQ(s.rank, 4);
}

TEST(FrameShare, AllSixMotionsExplainLittleMore) {
  const FrameShare s = BothFlanks().share(kWholeFrame);
  EXPECT_NEAR(s.rms_after, 1.22, 0.005);
  EXPECT_NEAR(s.explained, 0.68, 0.005);
}

TEST(FrameShare, ATurnAboutTheGearAxisExplainsNextToNothing) {
  EXPECT_NEAR(BothFlanks().share(kTurnAboutAxis).explained, 0.01, 0.005);
}

// A turn about the axis of a flank without relief is a constant over it: one of two unknowns.
TEST(FrameShare, ATurnAndAConstantOfOneFlankAreTheSame) {
  const Grid grid = reference::table_3_grid(reference::FaceGear{});
  const MapDifference d = difference_of(0);
  const std::array<ComparedFlank, 1> flank{{{&d.difference, grid}}};
  FrameMotions freedom = kTurnAboutAxis;
  freedom.constants = true;
  FrameShare s;
  ASSERT_TRUE(frame_share(flank, freedom, s).ok());
  EXPECT_EQ(s.rank, 1);
  EXPECT_NEAR(statistics_of(s.rest[0]).mean, 0.0, 1e-12);
  EXPECT_EQ(s.rest[1].missing(), kGridCells);
}

// What was put in comes out, in sign and size.
TEST(FrameShare, FindsTheFrameItWasGiven) {
  BothFlanks both;
  const Vec3 shift(3.0, -2.0, 5.0);    // µm
  const Vec3 turn(0.02, 0.01, -0.03);  // µm per mm
  for (std::size_t f = 0; f < 2; ++f) {
    for (std::size_t i = 0; i < kGridCells; ++i) {
      const SurfacePoint& p = both.nominal[f][i];
      both.difference[f].difference.set(i / kGridColumns, i % kGridColumns,
                                        p.normal.dot(shift + turn.cross(p.point)));
    }
  }
  both.difference[1].difference.set(0, 0, std::nan(""));
  const FrameShare s = both.share(kWholeFrame);
  EXPECT_LT((s.shift - shift).norm(), 1e-6);
  EXPECT_LT((s.turn - turn).norm(), 1e-8);
  EXPECT_NEAR(s.explained, 1.0, 1e-9);
  EXPECT_EQ(s.rank, 6);
}

// --- refusals

TEST(BadComparison, OfMapsWithoutACommonCellIsRefused) {
  ErrorMap one;
  ErrorMap other;
  one.set(0, 0, 1.0);
  other.set(0, 1, 1.0);
  MapDifference d;
  EXPECT_EQ(compare_maps(one, other, d).reason, Reason::too_few_points);
}

TEST(BadComparison, WithoutFlanksPointsOrCellsIsRefused) {
  const MapDifference d = difference_of(0);
  Grid grid = reference::table_3_grid(reference::FaceGear{});
  FrameShare s;
  EXPECT_EQ(frame_share(Span<const ComparedFlank>(), kWholeFrame, s).reason,
            Reason::too_few_points);
  const std::array<ComparedFlank, 1> few{{{&d.difference, {grid.data(), 100}}}};
  EXPECT_EQ(frame_share(few, kWholeFrame, s).reason, Reason::length_mismatch);
  const std::array<ComparedFlank, 3> many{
      {{&d.difference, grid}, {&d.difference, grid}, {&d.difference, grid}}};
  EXPECT_EQ(frame_share(many, kWholeFrame, s).reason, Reason::length_mismatch);
  ErrorMap five;
  for (std::size_t column = 0; column < 5; ++column)
    five.set(0, column, 1.0);
  const std::array<ComparedFlank, 1> sparse{{{&five, grid}}};
  const Status too_few = frame_share(sparse, kWholeFrame, s);
  EXPECT_EQ(too_few.reason, Reason::too_few_points);
  EXPECT_EQ(too_few.where.count, 5);
  grid[8].normal.x() = std::nan("");
  const std::array<ComparedFlank, 1> bad{{{&d.difference, grid}}};
  EXPECT_EQ(frame_share(bad, kWholeFrame, s).reason, Reason::not_finite);
}

}  // namespace
}  // namespace volcomp::test
