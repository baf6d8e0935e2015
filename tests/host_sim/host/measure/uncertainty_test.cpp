// Contributions of instrument and surroundings against values worked out by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host_sim/host/measure/uncertainty.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

// A metre, five runs in both directions.
constexpr Repetition kMetre{1000.0, 5, true};

double U(const UncertaintyStatement& s, FigureKind figure, const Repetition& r = kMetre) {
  return expanded_um(contributions(s, r, figure)).value();
}

TEST(Uncertainty, DeviceStretchesTheLength) {
  UncertaintyStatement s;
  s.device_um_per_m = 0.5;
  EXPECT_NEAR(U(s, FigureKind::systematic), 0.5, 1e-12);
  EXPECT_NEAR(U(s, FigureKind::systematic, {2500.0, 5, true}), 1.25, 1e-12);
  // The same place in both directions: nothing of it is left.
  EXPECT_TRUE(contributions(s, kMetre, FigureKind::reversal).empty());
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

// 0.5 um/m at k = 2 and 11 um/(m K) within half a kelvin, rectangular: both are one scale.
TEST(Uncertainty, WhatGrowsWithTheLengthIsOneScale) {
  UncertaintyStatement s;
  s.device_um_per_m = 0.5;
  EXPECT_NEAR(stated_errors(s, 800.0).scale, 0.25e-3, 1e-15);
  s.temperature_K = 0.5;
  s.expansion_um_per_m_K = 11.0;
  EXPECT_NEAR(stated_errors(s, 800.0).scale, 1e-3 * std::hypot(0.25, 5.5 / std::sqrt(3.0)), 1e-12);
  EXPECT_EQ(stated_errors(s, 800.0).drift, 0.0);
  s.eve_um = 0.4;
  EXPECT_EQ(stated_errors(s, 800.0).drift, 0.4);
}

// 2 mm beside a metre: anything between 0 and 2 um at the far end, whose root mean square is
// 2 um / sqrt(3); 1.96 times that is beyond the largest.
TEST(Uncertainty, CosineThatIsNotTakenOffCountsFromZero) {
  UncertaintyStatement s;
  s.misalignment_mm = 2.0;
  const double at_end = 1000.0 * stated_errors(s, 1000.0).scale;
  EXPECT_NEAR(at_end, 2.0 / std::sqrt(3.0), 1e-9);
  EXPECT_GT(1.96 * at_end, 2.0);
}

// The scatter of the machine is what is measured.
TEST(Uncertainty, WithNothingStatedNothingIsContributed) {
  for (const FigureKind kind : {FigureKind::largest, FigureKind::systematic, FigureKind::reversal,
                                FigureKind::repeatability})
    EXPECT_TRUE(contributions({}, kMetre, kind).empty());
}

TEST(Uncertainty, StatedValuesAreThoseOfWhatHasAnInterval) {
  UncertaintyStatement s;
  s.device_um_per_m = 0.5;
  s.volume_um = 1.0;
  const std::vector<StatedValue> diagonals = stated_values(s, true, false);
  ASSERT_EQ(diagonals.size(), 1U);
  EXPECT_EQ(diagonals[0].key, "device_um_per_m");
  EXPECT_EQ(diagonals[0].value, 0.5);
  const std::vector<StatedValue> volume = stated_values(s, false, true);
  ASSERT_EQ(volume.size(), 1U);
  EXPECT_EQ(volume[0].key, "volume_um");
}

TEST(Uncertainty, WhatIsNotStatedIsNamedAndNotGuessed) {
  EXPECT_FALSE(expanded_um(contributions({}, {1000.0, 1, true}, FigureKind::systematic)));
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
