// What `volcomp run face-gear --patch` computes, against the facts of docs/papers/face-gear.md,
// "The patch and the search of the paper".

#include "host_sim/experiments/face_gear/patch_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "host_sim/experiments/face_gear/patch_report.hpp"
#include "tests/oracle/face_gear.hpp"
#include "tests/oracle/face_gear_tables.hpp"

namespace volcomp::face_gear {
namespace {

const PatchComparison& table_3() {
  static const PatchComparison made = compare_patch("table3");
  return made;
}

const PatchSearch& search_named(const PatchComparison& c, const std::string& key) {
  return *std::find_if(c.search.begin(), c.search.end(),
                       [&](const PatchSearch& s) { return s.key == key; });
}

TEST(PatchComparison, ControlPointsAreThoseOfTheFileOfTable3) {
  ASSERT_EQ(table_3().control.size(), 3U);
  EXPECT_NEAR(table_3().control[0].largest_um, 1.0, 0.01);
  EXPECT_NEAR(table_3().control[1].largest_um, 237.0, 0.5);
  EXPECT_NEAR(table_3().control[2].largest_um, 125.0, 0.5);
}

// The oracle's grid and its printed points give the same difference: what the program has of
// Table 3 is what the tests have.
TEST(PatchComparison, ControlPointsDifferAsThoseOfTheOracleDo) {
  const auto grid = reference::points_of(reference::table_3_grid(reference::gear_of_table_3()));
  SplinePatch patch;
  ASSERT_TRUE(SplinePatch::through(grid, Parametrisation::uniform, patch).ok());
  double largest = 0.0;
  std::size_t line = 0;
  for (const auto& r : reference::numbers_of_table("table3_mm.csv")) {
    const Vec3 control = patch.control(line % 5, line < 5 ? 0 : kGridColumns - 1);
    largest = std::max(largest, (control - Vec3(r[3], r[4], r[5])).cwiseAbs().maxCoeff());
    ++line;
  }
  EXPECT_NEAR(table_3().control[0].largest_um, 1e3 * largest, 1e-6);
}

TEST(PatchComparison, PatchIsExactInItsNodesAndNotBetweenThem) {
  ASSERT_EQ(table_3().patch.size(), 2U);
  const PatchDistance& plain = table_3().patch[0];
  const PatchDistance& relieved = table_3().patch[1];
  EXPECT_FALSE(plain.relieved);
  EXPECT_TRUE(relieved.relieved);
  for (const PatchDistance& d : table_3().patch) {
    EXPECT_LT(d.nodes_mm, 1e-12);
    EXPECT_EQ(d.raster_um.size(), kRasterRows * kRasterColumns);
  }
  EXPECT_NEAR(plain.largest_um, 0.1265, 0.0005);
  EXPECT_NEAR(plain.rms_um, 0.013, 0.0005);
  EXPECT_NEAR(relieved.largest_um, 1.245, 0.002);
  EXPECT_NEAR(relieved.rms_um, 0.26, 0.005);
}

// The oracle measures the same patch from a flank of its own.
TEST(PatchComparison, DistancesOfTheGeneratedFlankAreThoseOfTheOracle) {
  const reference::FaceGear gear;
  const auto grid = reference::points_of(reference::table_3_grid(gear));
  SplinePatch patch;
  ASSERT_TRUE(SplinePatch::through(grid, Parametrisation::uniform, patch).ok());
  for (std::size_t i = 0; i < kRasterRows; i += 7) {
    for (std::size_t j = 0; j < kRasterColumns; j += 9) {
      const double u = static_cast<double>(i) / static_cast<double>(kRasterRows - 1);
      const double v = static_cast<double>(j) / static_cast<double>(kRasterColumns - 1);
      const double off_um = 1e3 * reference::distance(gear, patch.at(u, v).point, 1, 0);
      EXPECT_NEAR(table_3().patch[0].raster_um[i * kRasterColumns + j], off_um, 1e-6);
    }
  }
}

TEST(PatchComparison, SubdivisionTakesWhatTheSpecificationCountsAndLosesNodes) {
  const PatchSearch& ten = search_named(table_3(), "subdivision_10");
  EXPECT_EQ(ten.levels, 10U);
  EXPECT_EQ(ten.points, 1210);
  EXPECT_NEAR(ten.nodes_mm, 1.35e-4, 0.1e-4);
  const PatchSearch& four = search_named(table_3(), "subdivision_4");
  EXPECT_EQ(four.levels, 23U);
  EXPECT_EQ(four.points, 575);
  EXPECT_NEAR(four.nodes_mm, 0.020, 0.001);
  for (const PatchSearch* s : {&ten, &four}) {
    EXPECT_FALSE(s->wrong_signs.has_value());
    EXPECT_EQ(s->unsettled, 0U);
  }
}

TEST(PatchComparison, SubdivisionConvergesByTwoCellsALevel) {
  for (const auto& [key, cells] : {std::pair{"subdivision_10", 10.0}, {"subdivision_4", 4.0}}) {
    const PatchSearch& s = search_named(table_3(), key);
    ASSERT_EQ(s.course.size(), s.levels);
    for (std::size_t k = 0; k < s.course.size(); ++k) {
      EXPECT_NEAR(*s.course[k].step * cells, std::pow(2.0 / cells, static_cast<double>(k)), 1e-9);
      EXPECT_LE(s.course[k].largest_error_mm, s.course[k > 0 ? k - 1 : 0].largest_error_mm);
    }
    EXPECT_DOUBLE_EQ(s.course.back().largest_error_mm, s.largest_error_mm);
  }
}

TEST(PatchComparison, NewtonSettlesInSixStepsAndKeepsTheSign) {
  const PatchSearch& newton = search_named(table_3(), "newton");
  EXPECT_EQ(newton.levels, 6U);
  EXPECT_EQ(newton.points, 112);
  EXPECT_LT(newton.largest_error_mm, 1e-12);
  EXPECT_LT(newton.nodes_mm, 1e-12);
  EXPECT_EQ(newton.wrong_signs, 0);
  EXPECT_EQ(newton.unsettled, 0U);
  EXPECT_FALSE(newton.course.front().step.has_value());
  EXPECT_EQ(newton.course.front().points, 105);
}

TEST(PatchComparison, AngleAsPrintedNeverEndsAndTheClosedFormIsOneDistance) {
  const std::vector<AngleSearch>& angle = table_3().angle;
  ASSERT_EQ(angle.size(), 8U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(angle[i].printed);
    EXPECT_FALSE(angle[i].ends);
    EXPECT_EQ(angle[i].distances, 60000);
    EXPECT_GT(std::abs(angle[i].rest_um), 1.0);
  }
  EXPECT_FALSE(angle[3].ends);
  EXPECT_EQ(angle[4].distances, 27260);
  EXPECT_NEAR(angle[5].distances, 3704, 2);
  EXPECT_EQ(angle[6].distances, 1);
  EXPECT_LT(std::abs(angle[6].rest_um), 1e-8);
  EXPECT_EQ(angle[7].distances, 4);
  EXPECT_LT(std::abs(angle[7].rest_um), 0.1);
}

TEST(PatchComparison, AllThatThePageSaysOfTable3Holds) {
  EXPECT_TRUE(patch_verdict(table_3()).ok) << patch_verdict(table_3()).text;
  EXPECT_EQ(patch_promises(table_3()).size(), 19U);
}

TEST(PatchComparison, AFigureBeyondItsLimitIsNamedInTheVerdict) {
  PatchComparison worse = table_3();
  worse.patch[1].largest_um = 1.3;
  worse.angle[0].ends = true;
  const host::Verdict verdict = patch_verdict(worse);
  EXPECT_FALSE(verdict.ok);
  EXPECT_NE(verdict.text.find("relief: largest"), std::string::npos) << verdict.text;
  EXPECT_NE(verdict.text.find("as printed that end"), std::string::npos) << verdict.text;
}

// No control points are printed of this gear, and it has no relief. At its inner end, where rows
// are unevenly far apart, Newton without damping goes round in circles.
TEST(PatchComparison, Table1HasNoPrintAndPlacesWhereNewtonIsLost) {
  const PatchComparison c = compare_patch("table1");
  EXPECT_TRUE(c.control.empty());
  ASSERT_EQ(c.patch.size(), 1U);
  EXPECT_NEAR(c.patch[0].largest_um, 0.886, 0.002);
  EXPECT_EQ(search_named(c, "newton").unsettled, 7U);
  EXPECT_EQ(search_named(c, "closed").unsettled, 0U);
  EXPECT_EQ(c.angle.size(), 7U);
  EXPECT_EQ(patch_promises(c).size(), 9U);
  EXPECT_TRUE(patch_verdict(c).ok) << patch_verdict(c).text;
}

TEST(PatchComparison, ReportHasAMapOfEachFlankAndTheCourseOfTheSearches) {
  const nlohmann::json document = patch_document(table_3(), {});
  int maps = 0;
  int courses = 0;
  for (const nlohmann::json& section : document["sections"]) {
    maps += section["type"] == "heatmap" ? 1 : 0;
    courses += section["type"] == "lines" ? 1 : 0;
  }
  EXPECT_EQ(maps, 2);
  EXPECT_EQ(courses, 1);
}

}  // namespace
}  // namespace volcomp::face_gear
