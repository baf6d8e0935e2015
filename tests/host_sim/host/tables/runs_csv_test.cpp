// Run files: units, order of columns and lines, and what is refused with which line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "comp/core/units.hpp"
#include "host_sim/host/tables/runs_csv.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

RunsFile parse(const std::string& text) {
  std::istringstream stream(text);
  return read_runs(stream, "x.csv");
}

std::string refusal(const std::string& text) {
  return sim::complaint_of([&] { return parse(text); });
}

constexpr const char* kHeader =
    "target [mm],run,direction,EXX [um],EYX [um],EZX [um],EAX [urad],EBX [arcsec],ECX [mrad]\n";

TEST(RunsCsv, ConvertsEveryUnitToMmAndRad) {
  const RunsFile f = parse(std::string(kHeader) + "-10,1,up,1,2,3,4,5,6\n0,1,up,0,0,0,0,0,0\n");
  EXPECT_EQ(f.letter, 'X');
  ASSERT_EQ(f.up.size(), 1U);
  const ErrorMotion& e = f.up[0][0];
  EXPECT_DOUBLE_EQ(e(0), 1e-3);
  EXPECT_DOUBLE_EQ(e(2), 3e-3);
  EXPECT_DOUBLE_EQ(e(3), 4e-6);
  EXPECT_DOUBLE_EQ(e(4), 5.0 * kPi / 180.0 / 3600.0);
  EXPECT_DOUBLE_EQ(e(5), 6e-3);
}

TEST(RunsCsv, OrderOfColumnsAndLinesDoesNotMatter) {
  const RunsFile a = parse(
      std::string(kHeader) +
      "-10,1,up,1,2,3,4,5,6\n0,1,up,7,8,9,1,2,3\n0,1,down,1,1,1,1,1,1\n-10,1,down,2,2,2,2,2,2\n");
  const RunsFile b = parse(
      "\xEF\xBB\xBFrun,ECX [mrad],EBX [arcsec],EAX [urad],EZX [um],EYX [um],EXX "
      "[um],direction,target [mm]\r\n"
      "# measured on a "
      "Tuesday\r\n\r\n1,6,5,4,3,2,1,up,-10\r\n1,3,2,1,9,8,7,up,0\r\n1,2,2,2,2,2,2,down,-10\r\n1,1,"
      "1,1,1,1,1,down,0\r\n");
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.up, b.up);
  EXPECT_EQ(a.down, b.down);
}

TEST(RunsCsv, WhatIsWrittenReadsBackBitForBit) {
  RunsFile f;
  f.letter = 'Y';
  f.positions = {-0.1, 1.0 / 3.0};
  ErrorMotion e;
  e << 1.0 / 7.0, -2e-17, 3.5, 1e-300, -0.0, 1e-6;
  f.up = {{e, 2.0 * e}};
  f.down = {{3.0 * e, e}};
  std::stringstream stream;
  write_runs(stream, f);
  const RunsFile back = read_runs(stream, "y.csv");
  EXPECT_EQ(back.letter, 'Y');
  EXPECT_EQ(back.positions, f.positions);
  EXPECT_EQ(back.up, f.up);
  EXPECT_EQ(back.down, f.down);
}

TEST(RunsCsv, RefusalsNameTheLine) {
  using testing::HasSubstr;
  const std::string good = std::string(kHeader) + "-10,1,up,1,2,3,4,5,6\n";
  EXPECT_THAT(refusal(good + "-10,1,up,1,2,3,4,5,6\n"),
              HasSubstr("x.csv:3: run 1 up has target -10 twice"));
  EXPECT_THAT(refusal(good + "0,1,up,1,2,3,4,5\n"), HasSubstr("x.csv:3: 8 cells instead of 9"));
  EXPECT_THAT(refusal(good + "0,0,up,1,2,3,4,5,6\n"), HasSubstr("'run' must be"));
  EXPECT_THAT(refusal(good + "0,1.5,up,1,2,3,4,5,6\n"), HasSubstr("'run' must be"));
  EXPECT_THAT(refusal(good + "nan,1,up,1,2,3,4,5,6\n"), HasSubstr("not_finite"));
  EXPECT_THAT(refusal(good + "0,1,up,1,2,3,4,5,6e999\n"), HasSubstr("out of range"));
  EXPECT_THAT(refusal(good + "0,1,up,1,2,3,4,5,0x10\n"), HasSubstr("\"0x10\" is not a number"));
  EXPECT_THAT(refusal(good + "0,1,up,1,2,3,4,5,\n"), HasSubstr("is not a number"));
  EXPECT_THAT(refusal("target [mm],run,direction,EXX [um],EYX [um],EZX [um],EAX [urad],EBX "
                      "[urad],ECY [urad]\n"),
              HasSubstr("different axes"));
  EXPECT_THAT(refusal(std::string(kHeader)), HasSubstr("no reading"));
  EXPECT_THAT(refusal("# nothing\n\n"), HasSubstr("empty"));
  EXPECT_THAT(refusal(good + "0,2,up,1,2,3,4,5,6\n"), HasSubstr("[run_length]"));
}

TEST(RunsCsv, AMissingColumnIsNamedWithItsAxis) {
  const std::string before = "target [mm],run,direction,EXX [um],";
  const std::string after = "EZX [um],EAX [urad],EBX [urad],ECX [urad]\n";
  EXPECT_EQ(refusal(before + after), "x.csv:1: the header lacks the column EYX [missing_field]");
  EXPECT_EQ(refusal("target [mm],direction,EXX [um],EYX [um]," + after),
            "x.csv:1: the header lacks the column run [missing_field]");
}

// RFC 4180 has commas.
TEST(RunsCsv, AnotherSeparatorIsNamed) {
  const auto separated = [](char separator) {
    std::string header = kHeader;
    std::replace(header.begin(), header.end(), ',', separator);
    return header;
  };
  EXPECT_EQ(refusal(separated(';')),
            "x.csv:1: the header is separated by semicolons; columns must be separated by commas");
  EXPECT_EQ(refusal(separated('\t')),
            "x.csv:1: the header is separated by tabs; columns must be separated by commas");
}

TEST(RunsCsv, TargetsHaveTheUnitOfTheirAxis) {
  using testing::HasSubstr;
  const std::string rest =
      ",run,direction,EXX [um],EYX [um],EZX [um],EAX [urad],EBX [urad],ECX [urad]\n";
  std::string rotary = rest;
  for (std::size_t at = rotary.find("X ["); at != std::string::npos; at = rotary.find("X [", at))
    rotary[at] = 'C';
  EXPECT_THAT(refusal("target [deg]" + rest), HasSubstr("x.csv:1: the unit of the targets is of "
                                                        "the wrong kind for axis X"));
  EXPECT_THAT(refusal("target [mm]" + rotary), HasSubstr("wrong kind for axis C"));
  EXPECT_EQ(parse("target [deg]" + rotary + "180,1,up,0,0,0,0,0,0\n").positions.at(0), kPi);
}

TEST(RunsCsv, WhatIsNoTextOfRunsIsRefusedInOneSentence) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal(std::string("\xFF\xFEt\0a\0", 6)), HasSubstr("x.csv:1: the file is UTF-16"));
  EXPECT_THAT(refusal("target [mm],run,direction,EXX [\xB5m]\n"),
              HasSubstr("x.csv:1: the line is not UTF-8"));
  EXPECT_THAT(refusal(std::string(100000, 'x')), HasSubstr("x.csv:1: the line is longer"));
  EXPECT_THAT(refusal(std::string(100, '\0')), HasSubstr("x.csv:1: column \"????"));
  EXPECT_THAT(refusal(std::string(kHeader) + "# caf\xE9\n-10,1,\xFF,1,2,3,4,5,6\n"),
              HasSubstr("x.csv:3: the line is not UTF-8"));
}

// A million lines are refused where they become too many, not when memory ends.
TEST(RunsCsv, TooManyTargetsOrRunsAreRefusedAtTheirLine) {
  using testing::HasSubstr;
  std::string targets = kHeader;
  std::string runs = kHeader;
  for (int i = 1; i <= 1'000'000; ++i) {
    targets += std::to_string(i) + ",1,up,1,2,3,4,5,6\n";
    runs += "5," + std::to_string(i) + ",up,1,2,3,4,5,6\n";
  }
  EXPECT_THAT(refusal(targets), HasSubstr("x.csv:514: more than 512 targets"));
  EXPECT_THAT(refusal(runs), HasSubstr("x.csv:1002: more than 1000 runs"));
}

// A NaN is a reading, and the table builder is the one to refuse it, with run and target.
TEST(RunsCsv, NanReadingsReachTheBuilder) {
  const RunsFile f = parse(std::string(kHeader) + "-10,1,up,nan,2,3,4,5,6\n0,1,up,0,0,0,0,0,0\n");
  EXPECT_TRUE(std::isnan(f.up[0][0](0)));
}

}  // namespace
}  // namespace volcomp::host
