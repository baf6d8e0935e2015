// Before and after: figures worked out by hand, and when a difference means something.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "host_sim/host/measure/verification.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::host {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

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
  EXPECT_NEAR(figure(r, "PPP", "M").before.um, 11.0, 1e-9);
  EXPECT_NEAR(figure(r, "PPP", "A").before.um, 14.0 + 2.0 * std::sqrt(2.0), 1e-9);
  const FigureInterval& E = figure(r, "PPP", "E").before.interval.value();
  EXPECT_TRUE(0.0 < E.low && E.low < 14.0 && 14.0 < E.high) << E.low << " … " << E.high;
  EXPECT_TRUE(r.ok);
  // Two copies say nothing about spread.
  EXPECT_FALSE(figure(r, "PPP", "E").after.interval);
  EXPECT_THAT(r.remarks, Contains(AllOf(HasSubstr("PPP after: no interval"),
                                        HasSubstr(sentence(Reason::no_spread)))));
  EXPECT_THAT(r.verdict, HasSubstr("better, without statistics"));
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
  EXPECT_THAT(r.remarks, testing::ElementsAre(HasSubstr("one direction only"),
                                              HasSubstr("n = 2: no ISO 230-2 test")));
  for (const FigureComparison& f : r.figures) {
    EXPECT_NE(f.name, "B");
    EXPECT_NE(f.name, "M");
    EXPECT_FALSE(f.before.interval || f.after.interval);
  }
  EXPECT_EQ(figure(r, "face diagonals", "E_d").before.um, 5.0);
}

TEST(Verification, TextAndTablesHoldEveryFigure) {
  const VerificationInput in =
      input(runs("PPP", {{0, 30}}, {{0, 30}}), runs("PPP", {{0, 1}}, {{0, 1}}));
  const VerificationResult r = verify(in);
  const std::string text = verification_text(in, r);
  EXPECT_THAT(text, HasSubstr("30.00  -"));
  EXPECT_THAT(text, HasSubstr("left out of the uncertainty: device"));
  EXPECT_THAT(text, HasSubstr(sentence(Reason::too_few_runs)));
  EXPECT_THAT(text, HasSubstr("better, without statistics"));
  EXPECT_THAT(verification_csv(r), HasSubstr("PPP,E,30.0000,1.0000,96.667,better,,,,,,,,\n"));
  const nlohmann::json j = verification_json(in, r);
  EXPECT_EQ(j["figures"].size(), r.figures.size());
  EXPECT_EQ(j["figures"][1]["before"]["um"], 30.0);
  for (const char* name : {"corrected_um", "low_um", "high_um", "upper95_um"})
    EXPECT_TRUE(j["figures"][0]["before"].at(name).is_null()) << name;
  EXPECT_EQ(j["left_out"].size(), 6U);
  EXPECT_TRUE(j["stated"].empty());
}

// --- intervals, of simulated campaigns

constexpr double kSigma = 0.7;  // um, of a reading

// Five runs each way at `targets` places 50 mm apart.
DiagonalRuns campaign(const std::string& name, const std::function<double(std::size_t, bool)>& mean,
                      std::uint64_t seed, double sigma = kSigma, std::size_t targets = 8,
                      int count = 5) {
  sim::Random random(seed);
  DiagonalRuns d{name, {}, {}};
  for (std::size_t t = 0; t < targets; ++t)
    d.targets.push_back({50.0 * static_cast<double>(t), t + 2});
  for (const bool up : {true, false}) {
    for (int run = 0; run < count; ++run) {
      d.runs.push_back({run + 1, up, 2, {}});
      for (std::size_t t = 0; t < targets; ++t)
        d.runs.back().deviation_mm.push_back(1e-3 * (mean(t, up) + random.normal(sigma)));
    }
  }
  return d;
}

double nothing(std::size_t /*target*/, bool /*up*/) { return 0.0; }
double one_peak(std::size_t target, bool up) {
  if (target != 3) return 0.0;
  return up ? 10.0 : 8.0;
}

VerificationInput measured(const DiagonalRuns& before, const DiagonalRuns& after) {
  VerificationInput in{{"before.csv", {before}}, {"after.csv", {after}}, {}, {}, {}, {}, {}};
  in.draws = 415;
  return in;
}

struct Coverage {
  double E = 0.0;
  double B = 0.0;
};

// Share of campaigns whose intervals hold the true figures.
Coverage coverage(const std::function<double(std::size_t, bool)>& mean, double true_E,
                  double true_B) {
  constexpr std::uint64_t kPairs = 100;
  constexpr double kShare = 1.0 / (2.0 * kPairs);
  const auto held = [](const Figure& f, double truth) {
    return f.interval->low <= truth && truth <= f.interval->high ? kShare : 0.0;
  };
  Coverage c;
  for (std::uint64_t k = 0; k < kPairs; ++k) {
    const VerificationResult r =
        verify(measured(campaign("PPP", mean, 2 * k + 1), campaign("PPP", mean, 2 * k + 2)));
    for (Figure FigureComparison::*when : {&FigureComparison::before, &FigureComparison::after}) {
      c.E += held(figure(r, "PPP", "E").*when, true_E);
      c.B += held(figure(r, "PPP", "B").*when, true_B);
    }
  }
  return c;
}

// The sanitizers see the same code with fewer campaigns below.
#ifndef __SANITIZE_ADDRESS__
// 96 to 97.5 of 100 campaigns are promised; two standard deviations of 200 are 0.03. Plus and minus
// twice the standard deviation of a difference of means holds 8 (E) and 58 (B) of 100 here.
TEST(Verification, IntervalsHoldTheTruthWhereNothingIsLeft) {
  const Coverage c = coverage(nothing, 0.0, 0.0);
  EXPECT_GT(c.E, 0.93);
  EXPECT_GT(c.B, 0.93);
}
TEST(Verification, IntervalsHoldTheTruthOfOneExtreme) {
  const Coverage c = coverage(one_peak, 10.0, 2.0);
  EXPECT_TRUE(0.915 < c.E && c.E < 0.995) << c.E;
  EXPECT_TRUE(0.915 < c.B && c.B < 0.995) << c.B;
}
#endif

// The reversal of one target that stands alone has the scatter of a difference of two means of
// five; 4 % below and 1 % above are 1.75 and 2.33 standard deviations.
TEST(Verification, IntervalOfALoneExtremeIsWhatRepetitionShows) {
  const auto peak = [](std::size_t t, bool up) { return t == 3 && up ? 20.0 : 0.0; };
  constexpr int kTimes = 60;
  double sum = 0.0;
  double squares = 0.0;
  double width = 0.0;
  for (std::uint64_t k = 0; k < kTimes; ++k) {
    const VerificationResult r =
        verify(measured(campaign("PPP", peak, 3000 + k), campaign("PPP", peak, 4000 + k)));
    for (const Figure& f : {figure(r, "PPP", "B").before, figure(r, "PPP", "B").after}) {
      sum += f.um;
      squares += f.um * f.um;
      width += f.interval->high - f.interval->low;
    }
  }
  constexpr double kAll = 2.0 * kTimes;
  const double deviation = std::sqrt((squares - sum * sum / kAll) / (kAll - 1.0));
  EXPECT_NEAR(deviation, kSigma * std::sqrt(2.0 / 5.0), 0.1);  // 0.443
  EXPECT_NEAR(width / kAll, (1.75 + 2.33) * kSigma * std::sqrt(2.0 / 5.0), 0.2);
}

TEST(Verification, IntervalsDoNotDependOnWhereTheDiagonalBegins) {
  const DiagonalRuns d = campaign("PPP", one_peak, 5);
  DiagonalRuns shifted = d;
  for (DiagonalRun& run : shifted.runs)
    for (double& mm : run.deviation_mm)
      mm += 0.25;
  for (DiagonalTarget& t : shifted.targets)
    t.distance_mm += 1000.0;
  const VerificationResult r = verify(measured(d, d));
  const VerificationResult s = verify(measured(shifted, shifted));
  for (std::size_t i = 0; i < r.figures.size(); ++i) {
    const FigureInterval& a = *r.figures[i].before.interval;
    const FigureInterval& b = *s.figures[i].before.interval;
    EXPECT_NEAR(a.low, b.low, 1e-6) << r.figures[i].name;
    EXPECT_NEAR(a.high, b.high, 1e-6) << r.figures[i].name;
  }
}

TEST(Verification, MoreScatterAndWhatIsStatedWidenTheInterval) {
  const auto width = [](const VerificationInput& in) {
    const VerificationResult r = verify(in);
    const FigureInterval& i = *figure(r, "PPP", "E").before.interval;
    return i.high - i.low;
  };
  const DiagonalRuns calm = campaign("PPP", one_peak, 6);
  VerificationInput in = measured(calm, calm);
  const double narrow = width(in);
  EXPECT_GT(width(measured(campaign("PPP", one_peak, 6, 2.0 * kSigma), calm)), 1.5 * narrow);
  in.uncertainty.device_um_per_m = 20.0;  // 7 um at the end
  EXPECT_GT(width(in), 2.0 * narrow);
  ASSERT_EQ(verify(in).stated.size(), 1U);
}

TEST(Verification, UpperBoundDecidesAboutALimit) {
  VerificationInput in = measured(campaign("PPP", one_peak, 7), campaign("PPP", nothing, 8));
  in.before.diagonals.push_back(campaign("PNP", one_peak, 9));
  in.after.diagonals.push_back(campaign("PNP", nothing, 10));
  const VerificationResult free = verify(in);
  EXPECT_TRUE(free.ok);
  EXPECT_THAT(free.verdict, Not(HasSubstr("without statistics")));
  const Figure& all = figure(free, "body diagonals", "E_d").after;
  double bound = 0.0;
  for (const char* name : {"PPP", "PNP"})
    bound = std::max(bound, figure(free, name, "E").after.interval->upper95);
  EXPECT_EQ(all.interval->upper95, bound);
  EXPECT_LT(all.um, bound);
  in.limit_um = bound + 1e-6;
  EXPECT_TRUE(verify(in).ok);
  in.limit_um = bound - 1e-6;
  EXPECT_FALSE(verify(in).ok);
  EXPECT_THAT(verify(in).verdict, HasSubstr("for certain, upper bound"));
}

TEST(Verification, IntervalsThatTouchShowNoDifference) {
  const auto peak = [](double um) {
    return [um](std::size_t t, bool) { return t == 3 ? um : 0.0; };
  };
  const VerificationResult near =
      verify(measured(campaign("PPP", peak(10.0), 11), campaign("PPP", peak(9.5), 12)));
  EXPECT_EQ(figure(near, "PPP", "E").change, Change::not_significant);
  const VerificationResult far =
      verify(measured(campaign("PPP", peak(6.0), 11), campaign("PPP", peak(10.0), 12)));
  EXPECT_EQ(figure(far, "PPP", "E").change, Change::worse);
  EXPECT_FALSE(far.ok);
}

TEST(Verification, SameSeedSameIntervals) {
  VerificationInput in = measured(campaign("PPP", one_peak, 13), campaign("PPP", nothing, 14));
  const nlohmann::json once = verification_json(in, verify(in));
  EXPECT_EQ(once, verification_json(in, verify(in)));
  EXPECT_EQ(once["draws"], 415);
  EXPECT_EQ(once["seed"], 1);
  in.seed = 2;
  EXPECT_NE(once["figures"], verification_json(in, verify(in))["figures"]);
}

TEST(Verification, RunsThatDifferAreSaid) {
  const DiagonalRuns calm = campaign("PPP", nothing, 15);
  DiagonalRuns drifting = calm;
  sim::Random random(16);
  for (std::size_t run = 0; run < 5; ++run) {
    const double shift_mm = 1e-3 * random.normal(10.0 * kSigma);
    for (const std::size_t i : {run, run + 5})
      for (double& mm : drifting.runs[i].deviation_mm)
        mm += shift_mm;
  }
  EXPECT_THAT(verify(measured(calm, calm)).remarks, testing::IsEmpty());
  EXPECT_THAT(verify(measured(drifting, calm)).remarks,
              testing::ElementsAre(
                  HasSubstr("PPP before: runs differ: interval may cover less than 95 %")));
}

TEST(Verification, WhatIsNoTestOfTheStandardIsSaid) {
  const DiagonalRuns two = campaign("PPP", nothing, 17, kSigma, 8, 2);
  EXPECT_THAT(verify(measured(two, two)).remarks, Contains("n = 2: no ISO 230-2 test"));
  const DiagonalRuns few = campaign("PPP", nothing, 18, kSigma, 4, 5);
  EXPECT_THAT(verify(measured(few, few)).remarks,
              Contains(HasSubstr("not a test after ISO 230-2")));
}

// Of a figure that noise alone may have made: there is an interval, but not "0".
TEST(Verification, NothingBeyondTheNoiseIsCalledSo) {
  for (std::uint64_t seed = 20; seed < 60; ++seed) {
    const VerificationInput in =
        measured(campaign("PPP", one_peak, 19), campaign("PPP", nothing, seed));
    const VerificationResult r = verify(in);
    if (figure(r, "PPP", "E").after.interval->corrected > 0.0) continue;
    EXPECT_EQ(figure(r, "PPP", "E").after.interval->low, 0.0);
    EXPECT_THAT(verification_text(in, r), HasSubstr("below the noise  0.00 … "));
    return;
  }
  FAIL() << "none of 40 campaigns";
}

VolumeFile volume(std::size_t places, double um, std::uint64_t seed) {
  sim::Random random(seed);
  VolumeFile file{"volume.csv", {}};
  for (std::size_t i = 0; i < places; ++i) {
    VolumePoint p;
    p.at_mm = Vec3(50.0 * static_cast<double>(i % 10), 50.0 * static_cast<double>(i / 10 % 10),
                   50.0 * static_cast<double>(i / 100));
    for (double& e : p.error_mm)
      e = 1e-3 * random.normal(0.2);
    // A swing no rigid motion takes out, alone at one place.
    if (i == 5) p.error_mm.x() += 1e-3 * um;
    file.points.push_back(p);
  }
  return file;
}

TEST(Verification, VolumeHasAnIntervalWhereItsUncertaintyIsStated) {
  const DiagonalRuns d = campaign("PPP", one_peak, 21);
  VerificationInput in = measured(d, campaign("PPP", nothing, 22));
  in.volume_before = volume(200, 20.0, 23);
  in.volume_after = volume(200, 0.0, 24);
  EXPECT_THAT(verify(in).remarks, Contains(HasSubstr("uncertainty not stated (volume_um)")));
  EXPECT_FALSE(figure(verify(in), "volume", "max").after.interval);
  in.uncertainty.volume_um = 0.4;
  const VerificationResult r = verify(in);
  const FigureComparison& most = figure(r, "volume", "max");
  // One place stands out: its error, with what alignment takes of it, ± about two times 0.2 um.
  EXPECT_NEAR(most.before.interval->low, most.before.um - 0.35, 0.1);
  EXPECT_NEAR(most.before.interval->high, most.before.um + 0.47, 0.1);
  EXPECT_EQ(most.after.interval->low, 0.0);
  EXPECT_EQ(most.change, Change::better);
  EXPECT_FALSE(figure(r, "volume", "rms").before.interval);
}

// Noise alone makes the largest of 6000 errors of 0.2 um 1 um or so; that is the widest interval.
TEST(Verification, VolumeOfVeryManyPlacesHasTheWidestInterval) {
  const DiagonalRuns d = campaign("PPP", one_peak, 25);
  VerificationInput in = measured(d, campaign("PPP", nothing, 26));
  in.volume_before = volume(6000, 20.0, 27);
  in.volume_after = volume(6000, 0.0, 28);
  in.uncertainty.volume_um = 0.4;
  const VerificationResult r = verify(in);
  EXPECT_THAT(r.remarks, Contains(HasSubstr("too many for draws")));
  const Figure& after = figure(r, "volume", "max").after;
  EXPECT_NEAR(after.um, 0.9, 0.2);
  EXPECT_NEAR(after.interval->low, std::max(0.0, after.um - (after.interval->high - after.um)),
              1e-9);
  EXPECT_NEAR(after.interval->high - after.um, 1.0, 0.1);
}

}  // namespace
}  // namespace volcomp::host
