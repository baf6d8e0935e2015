// Readers of touches of an artefact and of points of a gear: units, columns in any order, and one
// sentence for what cannot be used. The commands' own tests (tests/system) have more of them.

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/measure/gear_points_csv.hpp"
#include "host_sim/host/measure/touch_csv.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

TouchFile touches(const std::string& text) {
  std::istringstream stream(text);
  return read_touches(stream, "t.csv");
}

GearPointsFile gear_points(const std::string& text) {
  std::istringstream stream(text);
  return read_gear_points(stream, "g.csv");
}

std::string touch_refusal(const std::string& text) {
  return sim::complaint_of([&] { return touches(text); });
}

std::string gear_refusal(const std::string& text) {
  return sim::complaint_of([&] { return gear_points(text); });
}

TEST(TouchCsv, ColumnsUnitsAndDirections) {
  const TouchFile file = touches("# probe 3\nAZ,AX,AY,Z [nm],X [um],Y [mm]\n\n-2,0,0,5e6,1500,3\n");
  ASSERT_EQ(file.touches.size(), 1U);
  EXPECT_TRUE(file.has_normals);
  EXPECT_LT((file.touches[0].centre - Vec3(1.5, 3.0, 5.0)).norm(), 1e-12);
  EXPECT_LT((file.touches[0].normal - Vec3(0, 0, 1)).norm(), 1e-12) << "against the approach";
  EXPECT_EQ(file.touches[0].line, 4U);
  EXPECT_FALSE(touches("X [mm],Y [mm],Z [mm]\n1,2,3\n").has_normals);
}

TEST(TouchCsv, RefusalsNameTheLine) {
  const std::string head = "X [mm],Y [mm],Z [mm]\n";
  EXPECT_EQ(touch_refusal(""), "t.csv: the file is empty");
  EXPECT_EQ(touch_refusal(head), "t.csv: there is no touch after the header");
  EXPECT_EQ(touch_refusal("X [mm],Y [mm]\n"),
            "t.csv:1: the header lacks the column Z [mm] [missing_field]");
  EXPECT_EQ(touch_refusal("X [mm],Y [mm],Z [mm],NX\n"),
            "t.csv:1: the header lacks the column NY [missing_field]");
  EXPECT_EQ(touch_refusal("X [mm],Y [mm],Z [rad]\n"),
            "t.csv:1: column \"Z [rad]\" has a unit of the wrong kind");
  EXPECT_EQ(touch_refusal("X [mm],X [mm],Z [mm]\n"), "t.csv:1: column \"X [mm]\" occurs twice");
  EXPECT_EQ(touch_refusal(head + "1,2\n"), "t.csv:2: 2 cells instead of 3");
  EXPECT_EQ(touch_refusal(head + "1,2,inf\n"),
            "t.csv:2: Z: \"inf\" must be finite and at most 100000 mm [not_finite]");
}

TEST(GearPointsCsv, PointsOrDeviations) {
  const GearPointsFile points =
      gear_points("Y [mm],X [mm],Z [um],tooth,flank,trace\n60,1,-2000,31,right,lead\n");
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_TRUE(points.has_coordinates);
  EXPECT_LT((points.points[0].place - Vec3(1, 60, -2)).norm(), 1e-12);
  EXPECT_EQ(points.points[0].tooth, 30);
  EXPECT_EQ(points.points[0].side, FlankSide::right);
  EXPECT_EQ(points.points[0].trace, GearTraceKind::lead);
  const GearPointsFile deviations =
      gear_points("trace,flank,tooth,at [mm],deviation [um]\npitch,left,2,,1.5\n");
  EXPECT_FALSE(deviations.has_coordinates);
  EXPECT_DOUBLE_EQ(deviations.points.at(0).deviation_mm, 1.5e-3);
}

TEST(GearPointsCsv, RefusalsNameTheLine) {
  const std::string head = "trace,flank,tooth,at [mm],deviation [um]\n";
  EXPECT_EQ(gear_refusal(""), "g.csv: the file is empty");
  EXPECT_EQ(gear_refusal(head), "g.csv: there is no point after the header");
  EXPECT_EQ(gear_refusal("trace,flank,tooth\n"),
            "g.csv:1: the header lacks the column at [mm] [missing_field]");
  EXPECT_EQ(gear_refusal("trace,flank,tooth,X [mm],Z [mm]\n"),
            "g.csv:1: the header lacks the column Y [mm] [missing_field]");
  EXPECT_EQ(gear_refusal(head + "profile,left,1,,1\n"), "g.csv:2: at: \"\" is not a number");
  EXPECT_EQ(gear_refusal(head + "profile,left,1.5,1,1\n"),
            "g.csv:2: tooth \"1.5\" must be a whole number from 1 to 1000");
  EXPECT_EQ(gear_refusal(head + "profile,left,1,1,nan\n"),
            "g.csv:2: deviation: \"nan\" must be finite and less than 100 m [not_finite]");
}

}  // namespace
}  // namespace volcomp::host
