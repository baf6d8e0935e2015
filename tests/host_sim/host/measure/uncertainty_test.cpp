// Expanded uncertainties against values worked out by hand, and against what repetition shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host_sim/host/measure/uncertainty.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

// A metre, five runs in both directions, nothing scattered.
constexpr Repetition kMetre{1000.0, 5, true, 0.0};

double U(const UncertaintyStatement& s, FigureKind figure, const Repetition& r = kMetre) {
  return expanded_um(contributions(s, r, figure)).value();
}

TEST(Uncertainty, DeviceStretchesTheLength) {
  UncertaintyStatement s;
  s.device_um_per_m = 0.5;
  EXPECT_NEAR(U(s, FigureKind::systematic), 0.5, 1e-12);
  EXPECT_NEAR(U(s, FigureKind::systematic, {2500.0, 5, true, 0.0}), 1.25, 1e-12);
  // The same place in both directions: nothing of it is left.
  EXPECT_NEAR(U(s, FigureKind::reversal), 0.0, 1e-12);
}

// 2 mm beside a metre: the beam is 2 um too long at most, anything between 0 and that.
TEST(Uncertainty, AlignmentIsACosine) {
  UncertaintyStatement s;
  s.misalignment_mm = 2.0;
  EXPECT_NEAR(U(s, FigureKind::systematic), 2.0 / std::sqrt(3.0), 1e-9);
}

// 11 um/m per K, known to half a kelvin: 5.5 um/m at most, either way.
TEST(Uncertainty, TemperatureIsCoefficientTimesLimitsTimesLength) {
  UncertaintyStatement s;
  s.expansion_um_per_m_K = 11.0;
  s.temperature_K = 0.5;
  EXPECT_NEAR(U(s, FigureKind::largest), 2.0 * 5.5 / std::sqrt(3.0), 1e-9);
  UncertaintyStatement coefficient;
  coefficient.expansion_limits_um_per_m_K = 1.0;
  coefficient.from_20_K = 3.0;
  EXPECT_NEAR(U(coefficient, FigureKind::systematic), 2.0 * 3.0 / std::sqrt(3.0), 1e-9);
}

// Anything within 3 um, two means of five readings compared.
TEST(Uncertainty, DriftActsOnMeansOfReadings) {
  UncertaintyStatement s;
  s.eve_um = 3.0;
  const double single = 3.0 / std::sqrt(12.0);
  EXPECT_NEAR(U(s, FigureKind::reversal), 2.0 * single * std::sqrt(2.0 / 5.0), 1e-9);
  EXPECT_NEAR(U(s, FigureKind::largest), 2.0 * single * std::sqrt(2.0 / 10.0), 1e-9);
}

TEST(Uncertainty, ContributionsAddAsSquares) {
  UncertaintyStatement s;
  s.device_um_per_m = 3.0;
  s.misalignment_mm = std::sqrt(8.0 * std::sqrt(3.0));  // m^2 / (2 sqrt(3)) um = 4 um
  EXPECT_NEAR(U(s, FigureKind::systematic), 5.0, 1e-9);
}

// The reversal of a target whose readings scatter by 1 um: repeated, it scatters as stated.
TEST(Uncertainty, RepeatabilityIsWhatRepetitionShows) {
  constexpr int kRuns = 5;
  constexpr int kTimes = 20'000;
  sim::Random random(7);
  double squares = 0.0;
  for (int i = 0; i < kTimes; ++i) {
    double difference = 0.0;
    for (int run = 0; run < kRuns; ++run)
      difference += (random.normal(1.0) - random.normal(1.0)) / kRuns;
    squares += difference * difference;
  }
  const double stated = U({}, FigureKind::reversal, {1000.0, kRuns, true, 1.0});
  EXPECT_NEAR(2.0 * std::sqrt(squares / kTimes), stated, 0.02 * stated);
}

TEST(Uncertainty, WhatIsNotStatedIsNamedAndNotGuessed) {
  EXPECT_FALSE(expanded_um(contributions({}, {1000.0, 1, true, 0.0}, FigureKind::systematic)));
  EXPECT_EQ(left_out({}, false).size(), 6U);
  UncertaintyStatement s;
  s.device_um_per_m = 0.5;
  s.eve_um = 1.0;
  const std::vector<std::string> list = left_out(s, true);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_THAT(list[0], HasSubstr("misalignment_mm"));
  EXPECT_THAT(list[1], HasSubstr("temperature_K"));
  EXPECT_THAT(list[2], HasSubstr("from_20_K"));
}

std::string refusal(const std::string& text) {
  return sim::complaint_of([&] { require_complete(parse_uncertainty(text, "u.toml")); });
}

TEST(Uncertainty, FileIsReadAndRefusedWithTheLine) {
  EXPECT_EQ(parse_uncertainty("[uncertainty]\neve_um = 1.5\n", "u.toml").eve_um.value(), 1.5);
  EXPECT_THAT(refusal("[uncertainty]\neve = 1.5\n"), HasSubstr("u.toml:2: unknown field 'eve'"));
  EXPECT_THAT(refusal("[uncertainty]\neve_um = -1\n"), HasSubstr("u.toml:2: 'eve_um' must not be"));
  EXPECT_THAT(refusal("[uncertainty]\neve_um = nan\n"), HasSubstr("must be a finite number"));
  EXPECT_THAT(refusal("eve_um = 1\n"), HasSubstr("unknown field 'eve_um' in the file"));
  EXPECT_THAT(refusal("[uncertainty\n"), HasSubstr("u.toml:1: not valid TOML"));
  EXPECT_THAT(refusal("[uncertainty]\ntemperature_K = 1\n"),
              HasSubstr("temperature_K needs expansion_um_per_m_K"));
}

}  // namespace
}  // namespace volcomp::host
