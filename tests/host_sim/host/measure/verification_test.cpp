// Before and after: figures worked out by hand, and when a difference means something.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "host_sim/host/measure/verification.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

DiagonalsFile diagonals_of(const std::string& readings, const std::string& name) {
  std::istringstream stream("diagonal,target [mm],run,direction,deviation [um]\n" + readings);
  return read_diagonals(stream, name);
}

VerificationInput input(const std::string& before, const std::string& after) {
  return {diagonals_of(before, "before.csv"), diagonals_of(after, "after.csv"), {}, {}, {}, {}, {}};
}

const FigureComparison& figure(const VerificationResult& r, const std::string& where,
                               const std::string& name) {
  return *std::find_if(r.figures.begin(), r.figures.end(), [&](const FigureComparison& f) {
    return f.where == where && f.name == name;
  });
}

// Two targets 500 mm apart; each run is a pair of readings.
std::string runs(const std::string& diagonal, const std::vector<std::array<double, 2>>& up,
                 const std::vector<std::array<double, 2>>& down) {
  std::ostringstream text;
  const auto write = [&](const auto& list, const char* direction) {
    for (std::size_t r = 0; r < list.size(); ++r) {
      text << diagonal << ",0," << r + 1 << ',' << direction << ',' << list[r][0] << '\n';
      text << diagonal << ",500," << r + 1 << ',' << direction << ',' << list[r][1] << '\n';
    }
  };
  write(up, "up");
  write(down, "down");
  return text.str();
}

// Means up 0 and 10, down 2 and 14: E = 14 - 0, B = 4, mean of both 1 and 12. Both runs of a target
// differ by 2 up and by nothing down: s = sqrt(2) there, R = 2 sqrt(2) + 0 + 4 or 4 sqrt(2).
TEST(Verification, FiguresOfOneDiagonalByHand) {
  const std::string before = runs("PPP", {{-1, 9}, {1, 11}}, {{2, 14}, {2, 14}});
  const std::string after = runs("PPP", {{0, 1}, {0, 1}}, {{0, 1}, {0, 1}});
  const VerificationResult r = verify(input(before, after));
  EXPECT_NEAR(figure(r, "PPP", "largest").before.um, 11.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "E").before.um, 14.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "B").before.um, 4.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "R").before.um, 2.0 * std::sqrt(2.0) + 4.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "E").after.um, 1.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "E").reduction_percent(), 100.0 * 13.0 / 14.0, 1e-9);
  EXPECT_NEAR(figure(r, "body diagonals", "E_d").before.um, 14.0, 1e-9);
  // Pooled: variances 2, 2, 0, 0; a difference of two means of two readings.
  EXPECT_NEAR(figure(r, "PPP", "E").before.U_um.value(), 2.0 * 1.0 * std::sqrt(2.0 / 2.0), 1e-9);
  EXPECT_TRUE(r.ok);
}

TEST(Verification, LargestOfAllBodyDiagonalsDecides) {
  const VerificationResult r =
      verify(input(runs("PPP", {{0, 3}}, {{0, 3}}) + runs("PNP", {{0, -40}}, {{0, -40}}),
                   runs("PPP", {{0, 2}}, {{0, 2}}) + runs("PNP", {{0, -1}}, {{0, -1}})));
  const FigureComparison& all = figure(r, "body diagonals", "E_d");
  EXPECT_NEAR(all.before.um, 40.0, 1e-9);
  EXPECT_NEAR(all.after.um, 2.0, 1e-9);  // of another diagonal
  EXPECT_TRUE(all.decides);
  EXPECT_TRUE(r.ok);
}

TEST(Verification, DifferenceWithinTheUncertaintyIsNone) {
  VerificationInput in = input(runs("PPP", {{0, 10}}, {{0, 10}}), runs("PPP", {{0, 7}}, {{0, 7}}));
  in.uncertainty.device_um_per_m = 4.0;  // 2 um over 500 mm, so 2.83 um between both
  EXPECT_TRUE(verify(in).ok);
  in.uncertainty.device_um_per_m = 4.4;  // 3.11 um
  const VerificationResult r = verify(in);
  EXPECT_FALSE(r.ok);
  EXPECT_EQ(figure(r, "PPP", "E").change, Change::not_significant);
  EXPECT_THAT(r.verdict, HasSubstr("no significant difference"));
}

TEST(Verification, OneDiagonalThatGotWorseFails) {
  const VerificationResult r =
      verify(input(runs("PPP", {{0, 30}}, {{0, 30}}) + runs("PNP", {{0, 2}}, {{0, 2}}),
                   runs("PPP", {{0, 1}}, {{0, 1}}) + runs("PNP", {{0, 20}}, {{0, 20}})));
  EXPECT_FALSE(r.ok);
  EXPECT_THAT(r.verdict, HasSubstr("PNP is significantly worse"));
}

TEST(Verification, LimitHoldsWithTheUncertaintyAdded) {
  VerificationInput in = input(runs("PPP", {{0, 4}}, {{0, 4}}), runs("PPP", {{0, 4}}, {{0, 4}}));
  in.uncertainty.device_um_per_m = 2.0;  // 1 um
  in.limit_um = 5.0;
  EXPECT_TRUE(verify(in).ok);
  in.limit_um = 4.9;
  EXPECT_FALSE(verify(in).ok);
  EXPECT_THAT(verify(in).verdict, HasSubstr("not within 4.9 µm for certain"));
  in.limit_um = 3.0;
  EXPECT_THAT(verify(in).verdict, HasSubstr("more than 3 µm"));
}

TEST(Verification, OneDirectionHasNoReversal) {
  const VerificationResult r =
      verify(input(runs("XY+", {{0, 5}, {0, 5}}, {}), runs("XY+", {{0, 1}, {0, 1}}, {})));
  ASSERT_EQ(r.remarks.size(), 1U);
  EXPECT_THAT(r.remarks[0], HasSubstr("one direction only"));
  for (const FigureComparison& f : r.figures)
    EXPECT_NE(f.name, "B");
  EXPECT_EQ(figure(r, "face diagonals", "E_d").before.um, 5.0);
}

TEST(Verification, TextAndTablesHoldEveryFigure) {
  const VerificationInput in =
      input(runs("PPP", {{0, 30}}, {{0, 30}}), runs("PPP", {{0, 1}}, {{0, 1}}));
  const VerificationResult r = verify(in);
  const std::string text = verification_text(in, r);
  EXPECT_THAT(text, HasSubstr("30.00  ± ?"));
  EXPECT_THAT(text, HasSubstr("left out of the uncertainty: device"));
  EXPECT_THAT(verification_csv(r), HasSubstr("PPP,E,30.0000,,1.0000,,96.667,better\n"));
  const nlohmann::json j = verification_json(in, r);
  EXPECT_EQ(j["figures"].size(), r.figures.size());
  EXPECT_TRUE(j["figures"][0]["before"]["U_um"].is_null());
  EXPECT_EQ(j["left_out"].size(), 6U);
}

}  // namespace
}  // namespace volcomp::host
