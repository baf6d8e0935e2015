// What is accepted but must not pass silently: outliers, one direction, missing runs, slopes,
// jumps.

#include <gtest/gtest.h>

#include "tests/comp/metrology/tables/campaign.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

std::unique_ptr<Campaign> quiet(int up, int down) {
  auto c = std::make_unique<Campaign>(Axis::x, uniform_targets(0.0, 50.0, 6));
  for (int i = 0; i < up; ++i)
    c->add_up(no_error);
  for (int i = 0; i < down; ++i)
    c->add_down(no_error);
  return c;
}

std::unique_ptr<BuiltTable> build(Campaign& c) {
  auto built = std::make_unique<BuiltTable>();
  EXPECT_TRUE(c.build(*built).ok());
  return built;
}

TEST(TableWarning, QuietDataRaiseNone) { EXPECT_EQ(build(*quiet(5, 5))->warning_count, 0U); }

// Median 2 µm, MAD 1 µm: the limit is the floor of 10 µm. 30 µm is listed and stays in the mean.
TEST(TableWarning, OutliersAreListedAndKept) {
  auto c = quiet(5, 5);
  const std::array<double, 5> um{0.0, 1.0, 2.0, 3.0, 30.0};
  for (std::size_t r = 0; r < 5; ++r)
    c->up[r][3](2) = 1e-3 * um[r];
  const auto b = build(*c);
  ASSERT_EQ(b->outlier_count, 1U);
  EXPECT_TRUE(b->has(Warning::outlier));
  EXPECT_STREQ(b->outlier[0].direction, "up");
  EXPECT_EQ(b->outlier[0].run, 4);
  EXPECT_EQ(b->outlier[0].target, 3);
  EXPECT_EQ(b->outlier[0].channel, 2);
  EXPECT_EQ(b->outlier[0].value, 0.030);
  EXPECT_EQ(b->outlier[0].median, 0.002);
  EXPECT_NEAR(b->reversal[3](2), 7.2e-3, 1e-17);  // (0+1+2+3+30)/5, nothing dropped
}

TEST(TableWarning, OutlierLimitIsTheLargerOfFloorAndSpread) {
  auto c = quiet(5, 5);
  c->up[0][0](0) = 9.9e-3;  // below the floor
  c->up[0][0](4) = 9.9e-6;
  EXPECT_EQ(build(*c)->outlier_count, 0U);
  c->up[0][0](4) = 10.1e-6;  // angle: the floor is 10 µrad
  EXPECT_EQ(build(*c)->outlier_count, 1U);
  c = quiet(5, 5);
  const std::array<double, 5> wide{-8.0, -4.0, 0.0, 4.0, 29.0};  // MAD 4: limit 29.652 µm
  for (std::size_t r = 0; r < 5; ++r)
    c->down[r][1](0) = 1e-3 * wide[r];
  EXPECT_EQ(build(*c)->outlier_count, 0U);
  c->down[4][1](0) = 30e-3;
  EXPECT_EQ(build(*c)->outlier_count, 1U);
  EXPECT_STREQ(build(*c)->outlier[0].direction, "down");
}

TEST(TableWarning, FewerThanFourRunsHaveNoOutliers) {
  auto c = quiet(3, 3);
  c->up[1][2](0) = 0.5;
  EXPECT_EQ(build(*c)->outlier_count, 0U);
}

TEST(TableWarning, MoreOutliersThanFitAreStillCounted) {
  auto c = quiet(5, 5);
  for (Eigen::Index ch = 0; ch < 6; ++ch) {
    for (auto& value : c->up[2])
      value(ch) = 4e-3 * (ch < 3 ? 100.0 : 1.0);
    for (auto& value : c->down[2])
      value(ch) = 4e-3 * (ch < 3 ? 100.0 : 1.0);
  }
  EXPECT_EQ(build(*c)->outlier_count, 72U);  // 6 channels × 6 targets × 2 directions
}

// One direction only: both tables alike, reversal "unknown", not "0".
TEST(TableWarning, OneDirectionIsUsedForBothAndSaysSo) {
  for (const bool up : {true, false}) {
    auto c = quiet(0, 0);
    const auto reading = [](double q) { return ErrorMotion(1e-5 * q * ErrorMotion::Unit(0)); };
    if (up) c->add_up(reading);
    if (!up) c->add_down(reading);
    const auto b = build(*c);
    EXPECT_FALSE(b->reversal_known);
    EXPECT_TRUE(b->has(Warning::one_direction));
    EXPECT_FALSE(b->has(Warning::run_count_differs));
    for (std::size_t t = 0; t < 6; ++t) {
      EXPECT_NEAR(b->table.forward[t](0), 5e-4 * static_cast<double>(t), 1e-18);
      EXPECT_EQ(b->table.forward[t], b->table.backward[t]);
    }
  }
}

TEST(TableWarning, MissingRunIsAcceptedWithTheRunsThereAre) {
  const auto b = build(*quiet(5, 4));
  EXPECT_TRUE(b->reversal_known);
  EXPECT_TRUE(b->has(Warning::run_count_differs));
  EXPECT_EQ(b->warning_count, 1U);
}

TEST(TableWarning, StraightnessSlopeBeyond200Microradians) {
  for (const double slope : {190e-6, 210e-6, -210e-6}) {
    auto c = quiet(0, 0);
    const auto reading = [&](double q) { return ErrorMotion(slope * q * ErrorMotion::Unit(1)); };
    c->add_up(reading);
    c->add_down(reading);
    EXPECT_EQ(build(*c)->has(Warning::steep_slope), std::abs(slope) > 200e-6);
  }
  auto c = quiet(0, 0);  // the channel along the axis is positioning, not straightness
  const auto reading = [](double q) { return ErrorMotion(3e-4 * q * ErrorMotion::Unit(0)); };
  c->add_up(reading);
  c->add_down(reading);
  EXPECT_FALSE(build(*c)->has(Warning::steep_slope));
}

TEST(TableWarning, JumpBetweenNeighbours) {
  struct Jump {
    Eigen::Index channel;
    double size;
    bool warns;
  };
  for (const Jump& j : {Jump{0, 0.019, false}, Jump{0, -0.021, true}, Jump{3, 99e-6, false},
                        Jump{3, 101e-6, true}}) {
    auto c = quiet(1, 1);
    for (auto* runs : {&c->up, &c->down}) {
      for (std::size_t t = 3; t < 6; ++t)
        (*runs)[0][t](j.channel) = j.size;
    }
    EXPECT_EQ(build(*c)->has(Warning::knot_jump), j.warns) << j.channel << ' ' << j.size;
  }
}

TEST(TableWarning, EveryWarningHasItsOwnName) {
  std::vector<std::string> names;
  for (int w = 0; w <= static_cast<int>(Warning::knot_jump); ++w)
    names.emplace_back(code(static_cast<Warning>(w)));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_FALSE(names.front().empty());
}

}  // namespace
}  // namespace volcomp::test
