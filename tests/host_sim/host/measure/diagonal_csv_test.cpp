// Files of diagonals and of the volume: units, order, and what is refused with which line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/map_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

constexpr const char* kHeader = "diagonal,target [mm],run,direction,deviation [um]\n";

DiagonalsFile parse(const std::string& text, const std::string& name = "d.csv") {
  std::istringstream stream(text);
  return read_diagonals(stream, name);
}

VolumeFile parse_volume(const std::string& text, const std::string& name = "v.csv") {
  std::istringstream stream(text);
  return read_volume(stream, name);
}

std::string refusal_of(const std::string& text) {
  return sim::complaint_of([&] { return parse(text); });
}

TEST(DiagonalCsv, TakesColumnsInAnyOrderAndUnit) {
  const DiagonalsFile f = parse(
      "direction,deviation [nm],run,target [um],diagonal\n# a comment\n"
      "down,2500,1,100000,PNP\ndown,-500,1,0,PNP\n");
  ASSERT_EQ(f.diagonals.size(), 1U);
  const DiagonalRuns& d = f.diagonals[0];
  EXPECT_EQ(d.name, "PNP");
  ASSERT_EQ(d.targets.size(), 2U);
  EXPECT_DOUBLE_EQ(d.targets[0].distance_mm, 0.0);
  EXPECT_DOUBLE_EQ(d.targets[1].distance_mm, 100.0);
  EXPECT_EQ(d.targets[1].line, 3U);
  ASSERT_EQ(d.runs.size(), 1U);
  EXPECT_FALSE(d.runs[0].up);
  EXPECT_DOUBLE_EQ(d.runs[0].deviation_mm[0], -0.5e-3);
  EXPECT_DOUBLE_EQ(d.runs[0].deviation_mm[1], 2.5e-3);
}

TEST(DiagonalCsv, WritesWhatItReads) {
  const std::string text = std::string(kHeader) +
                           "PPP,0.0000,1,up,0.0000\nPPP,10.0000,1,up,1.2500\n"
                           "XY-,0.0000,1,down,3.0000\nXY-,5.0000,1,down,-1.0000\n";
  EXPECT_EQ(diagonals_csv(parse(text)), text);
}

// As for runs: what a spreadsheet saves where the comma is the decimal point.
TEST(DiagonalCsv, AnotherSeparatorIsNamedInEveryReader) {
  const std::string semicolons =
      ":1: the header is separated by semicolons; columns must be separated by commas";
  EXPECT_EQ(refusal_of("diagonal;target [mm];run;direction;deviation [um]\n"),
            "d.csv" + semicolons);
  EXPECT_EQ(sim::complaint_of(
                [] { return parse_volume("X [mm];Y [mm];Z [mm];DX [um];DY [um];DZ [um]\n"); }),
            "v.csv" + semicolons);
  EXPECT_EQ(sim::complaint_of([] {
              std::istringstream stream("row;c1;c2\n");
              return read_map(stream, "m.csv");
            }),
            "m.csv" + semicolons);
  EXPECT_THAT(refusal_of("diagonal\ttarget [mm]\trun\n"), HasSubstr("separated by tabs"));
}

TEST(DiagonalCsv, RefusesWithTheLine) {
  const std::string h = kHeader;
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "d.csv: the file is empty"},
      {h, "d.csv: there is no reading after the header"},
      {"diagonal,target [mm],run,direction\n", "d.csv:1: the header lacks the column deviation"},
      {"diagonal,target,run,direction,deviation [um]\n",
       "d.csv:1: column \"target\" needs its unit"},
      {"diagonal,target [deg],run,direction,deviation [um]\n", "unit of the wrong kind"},
      {"diagonal,target [inch],run,direction,deviation [um]\n", "unknown unit \"inch\""},
      {"diagonal,diagonal,run,direction,deviation [um]\n", "occurs twice"},
      {"diagonal,target [mm],run,direction,error [um]\n", "unknown column \"error [um]\""},
      {h + "PPP,0,1,up\n", "d.csv:2: 4 cells instead of 5"},
      {h + "PXP,0,1,up,0\n", "d.csv:2: diagonal \"PXP\" is none of"},
      {h + "PPP,0,0,up,0\n", "d.csv:2: 'run' must be a whole number"},
      {h + "PPP,0,1,left,0\n", "d.csv:2: direction is \"left\""},
      {h + "PPP,0,1,up,nan\n", "d.csv:2: deviation [um] is \"nan\", must be finite"},
      {h + "PPP,0,1,up,1,5\n", "6 cells instead of 5"},
      {h + "PPP,2e9,1,up,1\n", "more than a kilometre"},
      {h + "PPP,0,1,up,0\nPPP,0,1,up,0\n", "d.csv:3: diagonal PPP: run 1 up has target 0 mm twice"},
      {h + "PPP,0,1,up,0\n", "d.csv:2: diagonal PPP has one target only"},
      {h + "PPP,0,1,up,0\nPPP,1,1,up,0\nPPP,0,2,up,0\n",
       "d.csv:4: diagonal PPP: run 2 up has 1 of 2 targets"}};
  for (const auto& [text, wanted] : cases)
    EXPECT_THAT(refusal_of(text), HasSubstr(wanted)) << text;
}

TEST(DiagonalCsv, NamesWhatOnlyOneOfTwoFilesHas) {
  const std::string h = kHeader;
  const std::string two = h + "PPP,0,1,up,0\nPPP,9,1,up,0\n";
  const auto compare = [&](const std::string& before, const std::string& after) {
    return sim::complaint_of(
        [&] { require_same_points(parse(before, "b.csv"), parse(after, "a.csv")); });
  };
  EXPECT_EQ(compare(two, two), "accepted");
  EXPECT_THAT(compare(two + "NPP,0,1,up,0\nNPP,9,1,up,0\n", two),
              HasSubstr("a.csv: lacks diagonal NPP of b.csv:4"));
  EXPECT_THAT(compare(two, h + "PPP,0,1,up,0\nPPP,8,1,up,0\n"),
              HasSubstr("a.csv: lacks diagonal PPP target 9 mm of b.csv:3"));
  EXPECT_THAT(compare(two, two + "PPP,0,1,down,0\nPPP,9,1,down,0\n"),
              HasSubstr("b.csv: lacks diagonal PPP run 1 down of a.csv:4"));
}

TEST(VolumeCsv, ReadsPlacesAndRefusesWithTheLine) {
  const std::string h = "X [mm],Y [mm],Z [mm],DX [um],DY [um],DZ [um]\n";
  const std::string four = h + "0,0,0,1,2,3\n1,0,0,0,0,0\n0,1,0,0,0,0\n0,0,1,0,0,0\n";
  const VolumeFile f = parse_volume(four);
  ASSERT_EQ(f.points.size(), 4U);
  EXPECT_DOUBLE_EQ(f.points[0].error_mm(2), 3e-3);
  const auto refused = [](const std::string& text) {
    return sim::complaint_of([&] { return parse_volume(text); });
  };
  EXPECT_THAT(refused(h + "0,0,0,1,2,3\n"), HasSubstr("1 places, at least 4"));
  EXPECT_THAT(refused(four + "0,0,1,0,0,0\n"), HasSubstr("v.csv:6: the same place as in line 5"));
  EXPECT_THAT(refused(four + "0,0,inf,0,0,0\n"), HasSubstr("v.csv:6: Z: \"inf\" must be finite"));
  EXPECT_THAT(refused("X [mm],Y [mm],Z [mm],DX [um],DY [um]\n"), HasSubstr("lacks the column DZ"));
  const VolumeFile other = parse_volume(h + "0,0,0,1,2,3\n2,0,0,0,0,0\n0,1,0,0,0,0\n0,0,1,0,0,0\n");
  EXPECT_THAT(sim::complaint_of([&] { require_same_places(f, other); }),
              HasSubstr("lacks the place 1 0 0 mm of v.csv:3"));
}

// A rigid motion of the work is not an error of the machine.
TEST(VolumeFigures, RigidMotionIsAlignedAway) {
  std::vector<VolumePoint> points;
  const Vec3 shift(0.02, -0.01, 0.005);
  const Vec3 turn(1e-5, -2e-5, 3e-5);
  for (const double x : {0.0, 500.0}) {
    for (const double y : {-300.0, 0.0, 100.0}) {
      for (const double z : {-400.0, 7.0})
        points.push_back({Vec3(x, y, z), shift + turn.cross(Vec3(x, y, z)), 0});
    }
  }
  EXPECT_GT(volume_figures(points).max_um, 20.0);
  EXPECT_LT(aligned_volume_figures(points).max_um, 1e-6);
}

}  // namespace
}  // namespace volcomp::host
