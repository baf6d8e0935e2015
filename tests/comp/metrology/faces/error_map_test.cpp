// Error maps: figures of the paper's own maps, zeroing, gaps, the polynomial through a map.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include "comp/metrology/faces/error_map.hpp"
#include "comp/metrology/faces/face_gear_grade.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/face_gear.hpp"
#include "tests/oracle/face_gear_tables.hpp"
#include "tests/oracle/map_polynomial.hpp"

namespace volcomp::test {
namespace {

using reference::PaperMaps;

constexpr double kPrinted = 1e-9;  // the tables print tenths of a micron

// --- statements of the paper about Tables 5 to 8

TEST(PaperMaps, AreCompleteAndZeroAtTheCentre) {
  const PaperMaps maps;
  for (const auto* kind : {&maps.on_machine, &maps.measuring_centre}) {
    for (const ErrorMap& map : *kind) {
      EXPECT_EQ(map.missing(), 0U);
      EXPECT_NEAR(map.at(kCentreRow, kCentreColumn), 0.0, 0.0);
    }
  }
}

TEST(PaperMaps, LargestValuesAreThoseOfTheText) {
  const PaperMaps maps;
  EXPECT_NEAR(statistics_of(maps.on_machine[0]).largest, 8.9, kPrinted);
  EXPECT_NEAR(statistics_of(maps.on_machine[1]).largest, 8.7, kPrinted);
  EXPECT_NEAR(statistics_of(maps.measuring_centre[0]).largest, 4.7, kPrinted);
  EXPECT_NEAR(statistics_of(maps.measuring_centre[1]).largest, 6.0, kPrinted);
  EXPECT_NEAR(statistics_of(maps.on_machine[1]).low, -8.7, kPrinted);  // the right ones are low
  EXPECT_NEAR(statistics_of(maps.measuring_centre[1]).low, -6.0, kPrinted);
}

// The paper's 5.8 µm, its "6 µm" and its grade 5: rows 2 to 6 of the right flank's column 8.
TEST(PaperMaps, TheProfileDeviationIsTheRangeOfTheCentreColumnWithoutItsEnds) {
  const PaperMaps maps;
  ProfileDeviation left;
  ProfileDeviation right;
  ASSERT_TRUE(profile_deviation(maps.on_machine[0], kProfileRows, left).ok());
  ASSERT_TRUE(profile_deviation(maps.on_machine[1], kProfileRows, right).ok());
  EXPECT_NEAR(right.value, 5.8, kPrinted);
  EXPECT_EQ(right.column, kCentreColumn);
  EXPECT_LT(left.value, right.value);
  EXPECT_EQ(face_gear_grade(right.value), 5);
}

TEST(PaperMaps, WithAllRowsTheGearIsWorseThanGradeFive) {
  const PaperMaps maps;
  EXPECT_NEAR(statistics_of(maps.on_machine[1], kAllRows, {7, 7}).range(), 8.0, kPrinted);
  double worst = 0.0;
  for (const ErrorMap& map : maps.on_machine) {
    ProfileDeviation all;
    ASSERT_TRUE(profile_deviation(map, kAllRows, all).ok());
    worst = std::max(worst, all.value);
  }
  EXPECT_NEAR(worst, 9.6, kPrinted);
  EXPECT_EQ(face_gear_grade(worst), std::nullopt);
}

TEST(FaceGearGrade, KnowsTwoLimitsAndNoMore) {
  EXPECT_EQ(face_gear_grade(0.0), 4);
  EXPECT_EQ(face_gear_grade(4.0), 4);
  EXPECT_EQ(face_gear_grade(4.001), 5);
  EXPECT_EQ(face_gear_grade(-6.0), 5);
  EXPECT_EQ(face_gear_grade(6.001), std::nullopt);
}

// --- zeroing

// Ball centres over the paper's map, seen from a frame turned by ψ: λ changes by −side·C·ψ
// everywhere, so zeroing at the centre takes the turn away.
TEST(Zeroing, AtTheCentreUndoesATurnAboutTheGearAxis) {
  const reference::FaceGear gear;
  const ErrorMap truth = PaperMaps().measuring_centre[0];
  const auto grid = reference::table_3_grid(gear);
  const double minute = kPi / (180.0 * 60.0);
  const Eigen::AngleAxisd turn(minute, Vec3::UnitZ());
  constexpr double kBall = 0.5;
  ErrorMap map;
  double moved = 0.0;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column) {
      const SurfacePoint& nominal = grid[grid_index(row, column)];
      const double off = kBall + 1e-3 * truth.at(row, column);
      const Vec3 centre = turn * (nominal.point + off * nominal.normal);
      map.set(row, column, 1e3 * (reference::distance(gear, centre, 1, 0) - kBall));
      moved = std::max(moved, std::abs(map.at(row, column) - truth.at(row, column)));
    }
  }
  EXPECT_NEAR(moved, 45.0, 0.5);
  double removed = 0.0;
  ASSERT_TRUE(zero_at_centre(map, removed).ok());
  EXPECT_NEAR(removed, -1e3 * gear.arm() * minute, 1e-6);
  for (std::size_t i = 0; i < kGridCells; ++i)
    EXPECT_NEAR(map.cells()[i], truth.cells()[i], 1e-6);  // µm
}

// One point carries its noise into all others: 0.5·√2·√(104/105) against 0.5.
TEST(Zeroing, AtOnePointSpreadsItsNoiseAndByTheMeanDoesNot) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.5);
  double at_centre = 0.0;
  double by_mean = 0.0;
  constexpr int kMaps = 2000;
  for (int k = 0; k < kMaps; ++k) {
    ErrorMap map;
    for (std::size_t i = 0; i < kGridCells; ++i)
      map.set(i / kGridColumns, i % kGridColumns, noise(random));
    ErrorMap other = map;
    double removed = 0.0;
    ASSERT_TRUE(zero_at_centre(map, removed).ok());
    ASSERT_TRUE(zero_by_mean(other, removed).ok());
    EXPECT_NEAR(statistics_of(other).mean, 0.0, 1e-12);
    at_centre += statistics_of(map).rms / kMaps;
    by_mean += statistics_of(other).rms / kMaps;
  }
  EXPECT_NEAR(at_centre, 0.67, 0.02);
  EXPECT_NEAR(by_mean, 0.50, 0.01);
}

// --- gaps

ErrorMap with_gap(std::size_t row, std::size_t column) {
  ErrorMap map = PaperMaps().on_machine[1];
  map.set(row, column, kNan);
  return map;
}

TEST(MapWithGaps, WithoutItsCentreIsNotZeroedAndStaysAsItWas) {
  ErrorMap map = with_gap(kCentreRow, kCentreColumn);
  double removed = 3.0;
  const Status s = zero_at_centre(map, removed);
  EXPECT_EQ(s.reason, Reason::centre_missing);
  EXPECT_EQ(s.where.index, 52);
  EXPECT_EQ(removed, 3.0);
  EXPECT_NEAR(map.at(0, 14), -8.7, 0.0);
  EXPECT_TRUE(zero_by_mean(map, removed).ok());
}

TEST(MapWithGaps, HasNoProfileDeviationWhereItIsJudged) {
  ErrorMap map = with_gap(2, 5);
  map.set(4, 1, kNan);
  ProfileDeviation kept{1.0, 3};
  const Status s = profile_deviation(map, kProfileRows, kept);
  EXPECT_EQ(s.reason, Reason::incomplete);
  EXPECT_EQ(s.where.count, 2);
  EXPECT_EQ(s.where.index, 35);
  EXPECT_EQ(kept.value, 1.0);
  EXPECT_TRUE(profile_deviation(with_gap(0, 5), kProfileRows, kept).ok());
}

TEST(MapWithGaps, StatisticsAreOfWhatIsThere) {
  const ErrorMap map = with_gap(0, 14);
  EXPECT_EQ(map.missing(), 1U);
  const CellStatistics s = statistics_of(map);
  EXPECT_EQ(s.count, 104U);
  EXPECT_NEAR(s.low, -6.4, kPrinted);
  EXPECT_EQ(statistics_of(ErrorMap()).count, 0U);
  ErrorMap nothing;
  double removed = 0.0;
  EXPECT_EQ(zero_by_mean(nothing, removed).reason, Reason::too_few_points);
}

TEST(BadMap, IsRefusedByNumberOfCellsAndByInfinity) {
  std::vector<double> cells(kGridCells, 0.0);
  ErrorMap map;
  cells[17] = std::numeric_limits<double>::infinity();
  const Status s = ErrorMap::from(cells, map);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 17);
  cells.pop_back();
  EXPECT_EQ(ErrorMap::from(cells, map).reason, Reason::length_mismatch);
  ProfileDeviation d;
  EXPECT_EQ(profile_deviation(map, {3, 2}, d).reason, Reason::bad_setting);
  EXPECT_EQ(profile_deviation(map, {0, 7}, d).reason, Reason::bad_setting);
}

// --- polynomial

TEST(MapPolynomial, ReturnsThePolynomialAMapWasMadeOf) {
  const auto value = [](double x, double y) {
    return 0.5 - 2.0 * x + 3.0 * y + 1.5 * x * x - 0.7 * x * y + 0.2 * y * y * y;
  };
  ErrorMap map;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column)
      map.set(
          row, column,
          value(scaled_row(static_cast<double>(row)), scaled_column(static_cast<double>(column))));
  }
  map.set(3, 3, kNan);
  MapPolynomial fit;
  ASSERT_TRUE(fit_map(map, 3, fit).ok());
  EXPECT_NEAR(fit.rms, 0.0, 1e-12);
  EXPECT_NEAR(fit.coefficient[1], -2.0, 1e-12);
  EXPECT_NEAR(fit.coefficient[4], -0.7, 1e-12);
  EXPECT_NEAR(fit.at(0.3, -0.8), value(0.3, -0.8), 1e-12);
  EXPECT_NEAR(scaled_row(0.0), -1.0, 0.0);
  EXPECT_NEAR(scaled_column(14.0), 1.0, 0.0);
}

TEST(MapPolynomial, LeavesLessTheHigherItsDegree) {
  const ErrorMap map = PaperMaps().on_machine[0];
  double before = statistics_of(map).rms;
  for (int degree = 0; degree <= kMaxMapDegree; ++degree) {
    MapPolynomial fit;
    ASSERT_TRUE(fit_map(map, degree, fit).ok());
    EXPECT_LT(fit.rms, before);
    before = fit.rms;
  }
}

TEST(MapPolynomial, TooFewCellsOrCellsInARowDoNotDetermineIt) {
  ErrorMap row;
  for (std::size_t column = 0; column < kGridColumns; ++column)
    row.set(2, column, 1.0);
  MapPolynomial fit;
  EXPECT_TRUE(fit_map(row, 0, fit).ok());
  const Status s = fit_map(row, 1, fit);
  EXPECT_EQ(s.reason, Reason::surface_not_determined);
  EXPECT_EQ(s.where.count, 15);
  EXPECT_EQ(fit_map(ErrorMap(), 0, fit).reason, Reason::surface_not_determined);
  EXPECT_EQ(fit_map(row, 5, fit).reason, Reason::bad_setting);
  EXPECT_EQ(fit_map(row, -1, fit).reason, Reason::bad_setting);
}

}  // namespace
}  // namespace volcomp::test
