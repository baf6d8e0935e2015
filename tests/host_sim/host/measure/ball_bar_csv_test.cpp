// Files of a ball bar: units, order, turns, and what is refused with which line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_csv.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

constexpr double kStep = kPi / 180.0;
const std::string kBarFacts = "# plane XY\n# radius_mm 100\n# feed_mm_min 1000\n";
const std::string kBarHeader = "angle [deg],radial [um],direction\n";

BallBarTest parse_bar(const std::string& text) {
  std::istringstream stream(text);
  return read_ball_bar(stream, "bar.csv");
}
std::string bar_refusal(const std::string& text) {
  return sim::complaint_of([&] { return parse_bar(text); });
}

// A reading every `step` degrees of `count`, from `start` on.
std::string bar_rows(const std::string& direction, int count = 72, double step = 5.0,
                     double start = 0.0) {
  const double sense = direction == "ccw" ? 1.0 : -1.0;
  std::string text;
  for (int i = 0; i < count; ++i)
    text += fmt::format("{:g},{:g},{}\n", start + sense * step * i, 0.1 * (i % 7), direction);
  return text;
}

TEST(BallBarCsv, ReadsBothDirectionsWithTheirFacts) {
  const BallBarTest t = parse_bar(kBarFacts + "# centre_mm 1 -2 3.5\n# calibrated yes\n# a note\n" +
                                  "# temperature_C 21.5\n# cyclic_mm 10 0\n" + kBarHeader +
                                  bar_rows("ccw") + bar_rows("cw", 72, 5.0, 355.0));
  EXPECT_EQ(*t.plane, "XY");
  EXPECT_DOUBLE_EQ(*t.radius, 100.0);
  EXPECT_DOUBLE_EQ(*t.feed, 1000.0);
  EXPECT_DOUBLE_EQ((*t.centre)(1), -2.0);
  EXPECT_TRUE(t.calibrated);
  EXPECT_DOUBLE_EQ(*t.temperature, 21.5);
  EXPECT_DOUBLE_EQ(t.cyclic[0], 10.0);
  ASSERT_EQ(t.circle[0].size(), 1U);
  ASSERT_EQ(t.circle[1].size(), 1U);
  EXPECT_TRUE(t.circle[0][0].full());
  EXPECT_NEAR(t.circle[1][0].theta[0], 355.0 * kStep, 1e-12);
  EXPECT_NEAR(t.circle[0][0].radial[6], 0.6e-3, 1e-15);
}

TEST(BallBarCsv, TakesUnitsAndColumnsInAnyOrder) {
  std::string text = kBarFacts + "direction,radial [nm],angle [rad]\n";
  for (int i = 0; i < 72; ++i)
    text += fmt::format("ccw,{},{:.12f}\n", 250 + i, 5.0 * kStep * i);
  const BallBarTest t = parse_bar(text);
  EXPECT_NEAR(t.circle[0][0].radial[1], 251e-6, 1e-15);
  EXPECT_NEAR(t.circle[0][0].theta[71], 355.0 * kStep, 1e-11);
}

// 350, 355, 0, 5 …: a wrap is no step back; what is read beyond a turn is left out and counted.
TEST(BallBarCsv, GoesOnBeyondAFullTurn) {
  std::string text = kBarFacts + kBarHeader;
  for (int i = 0; i < 76; ++i)
    text += fmt::format("{},{},ccw\n", (350 + 5 * i) % 360, i);
  const BallBarTest t = parse_bar(text);
  ASSERT_EQ(t.circle[0][0].theta.size(), 72U);
  EXPECT_EQ(t.overshoot, 3U);  // the fourth closes the circle
  EXPECT_NEAR(t.circle[0][0].theta[71] - t.circle[0][0].theta[0], 355.0 * kStep, 1e-9);
}

TEST(BallBarCsv, ReadsSeveralCirclesByRun) {
  const BallBarTest t = parse_bar(kBarFacts + kBarHeader + "# run 1\n" + bar_rows("ccw") +
                                  bar_rows("cw") + "# run 2\n" + bar_rows("ccw") + bar_rows("cw"));
  ASSERT_EQ(t.circle[0].size(), 2U);
  ASSERT_EQ(t.circle[1].size(), 2U);
  EXPECT_EQ(t.circle[1][1].run, 2);
  EXPECT_EQ(t.overshoot, 0U);
}

TEST(BallBarCsv, ReadsReadingsByNumber) {
  std::string text =
      kBarFacts + "# direction cw\n# start_deg 90\n# end_deg -270\nindex,radial [um]\n";
  for (int i = 0; i <= 72; ++i)
    text += fmt::format("{},{}\n", i, i);
  const BallBarTest t = parse_bar(text);
  ASSERT_EQ(t.circle[1].size(), 1U);
  ASSERT_EQ(t.circle[1][0].theta.size(), 72U);  // the last one is the first again
  EXPECT_NEAR(t.circle[1][0].theta[1], 85.0 * kStep, 1e-12);
}

// Nothing is stretched where the step is known; what is not the next number is named.
TEST(BallBarCsv, ReadsReadingsByNumberAndStep) {
  const std::string begin =
      kBarFacts + "# direction ccw\n# start_deg 0\n# step_deg 5\nindex,radial [um]\n";
  std::string text = begin;
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{},0.1\n", i);
  EXPECT_NEAR(parse_bar(text).circle[0][0].theta[39], 195.0 * kStep, 1e-12);
  EXPECT_THAT(bar_refusal(begin + "0,1\n2,1\n"), HasSubstr("bar.csv:9: index is 2, the next one"));
  EXPECT_THAT(bar_refusal(begin + "0,1\n0.5,1\n"), HasSubstr("index is 0.5"));
  EXPECT_THAT(bar_refusal(kBarFacts + "# direction ccw\n# start_deg 360\n# end_deg 0\n" +
                          "index,radial [um]\n0,1\n1,1\n"),
              HasSubstr("goes the other way"));
  EXPECT_THAT(bar_refusal("# step_deg 0\n"), HasSubstr("is positive"));
}

// Another plane in the middle of a file would turn the sign of what was read before.
TEST(BallBarCsv, RefusesFactsAfterReadings) {
  const std::string begin = kBarFacts + kBarHeader + bar_rows("ccw");
  for (const char* fact : {"plane YZ", "radius_mm 50", "feed_mm_min 10", "cyclic_mm 1 0"})
    EXPECT_THAT(bar_refusal(begin + "# " + fact + "\n"),
                HasSubstr("must stand before the readings"));
  EXPECT_THAT(bar_refusal(begin + "# run 2\n" + bar_rows("ccw")), HasSubstr("accepted"));
}

TEST(BallBarCsv, RefusesSettingsThatCannotBe) {
  for (const char* wave : {"-1 0", "1e-320 0", "101 0", "0 1e9"})
    EXPECT_THAT(
        bar_refusal(kBarFacts + "# cyclic_mm " + wave + "\n" + kBarHeader + bar_rows("ccw")),
        HasSubstr("'cyclic_mm'"))
        << wave;
  for (const char* feed : {"-5", "0", "1e-300", "1e9"})
    EXPECT_THAT(bar_refusal(std::string("# plane XY\n# radius_mm 100\n# feed_mm_min ") + feed +
                            "\n" + kBarHeader + bar_rows("ccw")),
                HasSubstr("'feed_mm_min'"))
        << feed;
  EXPECT_THAT(bar_refusal(kBarFacts + kBarHeader), HasSubstr("no reading after the header"));
}

TEST(BallBarCsv, WritesWhatItReads) {
  const std::string text = kBarFacts + "# centre_mm 1 -2 3.5\n# calibrated yes\n" + kBarHeader +
                           "# run 1\n" + bar_rows("ccw") + "# run 2\n" + bar_rows("ccw");
  const BallBarTest once = parse_bar(text);
  const std::string written = ball_bar_csv(once);
  EXPECT_EQ(ball_bar_csv(parse_bar(written)), written);
}

TEST(BallBarCsv, RefusesWithTheLine) {
  EXPECT_THAT(bar_refusal(""), HasSubstr("bar.csv: the file is empty"));
  EXPECT_THAT(bar_refusal("1,2,ccw\n"), HasSubstr("bar.csv:1: the first line"));
  EXPECT_THAT(bar_refusal("# radius_mm 100\n" + kBarHeader + bar_rows("ccw")),
              HasSubstr("'plane': A mandatory field is absent"));
  EXPECT_THAT(bar_refusal("# plane UV\n# radius_mm 100\n" + kBarHeader + bar_rows("ccw")),
              HasSubstr("[unknown_plane]"));
  EXPECT_THAT(bar_refusal("# plane XY\n# radius_mm 0.1\n" + kBarHeader + bar_rows("ccw")),
              HasSubstr("'radius_mm'"));
  EXPECT_THAT(
      bar_refusal("# plane XY\n# radius_mm 100\n" + kBarHeader + bar_rows("ccw") + bar_rows("cw")),
      HasSubstr("'feed_mm_min'"));
  EXPECT_THAT(bar_refusal("# plane XY\n# radius_mm nan\n"), HasSubstr("bar.csv:2: radius_mm"));
  EXPECT_THAT(bar_refusal("# plane\n"), HasSubstr("bar.csv:1: \"# plane\" needs 1 value"));
  EXPECT_THAT(bar_refusal("# run 1.5\n"), HasSubstr("whole number"));
  EXPECT_THAT(bar_refusal(kBarFacts + "angle [mm],radial [um],direction\n"),
              HasSubstr("wrong kind"));
  EXPECT_THAT(bar_refusal(kBarFacts + "angle [deg],direction\n"),
              HasSubstr("must name the columns"));
  EXPECT_THAT(bar_refusal(kBarFacts + "angle [deg],radial [um]\n"), HasSubstr("\"# direction\""));
  EXPECT_THAT(bar_refusal(kBarFacts + "# direction cw\nindex,radial [um]\n"),
              HasSubstr("start_deg"));
  EXPECT_THAT(bar_refusal(kBarFacts + kBarHeader + "0,1\n"),
              HasSubstr("bar.csv:5: 2 cells instead of 3"));
  EXPECT_THAT(bar_refusal(kBarFacts + kBarHeader + "0,1,left\n"), HasSubstr("must be ccw or cw"));
  EXPECT_THAT(bar_refusal(kBarFacts + kBarHeader + "0,inf,ccw\n"), HasSubstr("[not_finite]"));
}

// The line is that of the reading: the header is line 4, the first reading line 5.
TEST(BallBarCsv, NamesTheReadingThatCannotBe) {
  const std::string begin = kBarFacts + kBarHeader;
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 10) + "50,100001,ccw\n"),
              HasSubstr("bar.csv:15: direction ccw"));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 10) + "50,100001,ccw\n"),
              HasSubstr("unit_suspected"));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 40) + "40,1,ccw\n"),
              HasSubstr("positions_not_monotone"));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 30, 12.0)), HasSubstr("too_few_points"));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 60) + "310,1,ccw\n"), HasSubstr("bar.csv:65: "));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 60) + "310,1,ccw\n"), HasSubstr("[gap]"));
  EXPECT_THAT(bar_refusal(begin + bar_rows("ccw", 36)), HasSubstr("[arc_too_short]"));
  std::string far;
  for (int i = 0; i < 72; ++i)
    far += fmt::format("{},{},cw\n", -5 * i, 1500.0 * std::cos(5.0 * kStep * i));
  EXPECT_THAT(bar_refusal(begin + far), HasSubstr("[off_centre]"));
  // Labelled clockwise, runs the other way.
  std::string wrong;
  for (int i = 0; i < 72; ++i)
    wrong += fmt::format("{},0.1,cw\n", 5 * i);
  EXPECT_THAT(bar_refusal(begin + wrong), HasSubstr("bar.csv:6: direction cw"));
}

}  // namespace
}  // namespace volcomp::host
