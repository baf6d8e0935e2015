// Runs that are not enough for an interval, in the order in which they are refused.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "host_sim/host/measure/intervals/run_check.hpp"

namespace volcomp::host {
namespace {

struct RunsToCheck {
  std::vector<double> positions{0, 100, 200};
  std::vector<std::vector<double>> up{{0.1, 0.4, -0.2}, {0.3, 0.2, 0.0}};
  std::vector<std::vector<double>> down{{0.2, 0.1, -0.1}, {0.0, 0.5, 0.3}};

  [[nodiscard]] Status check() const { return check_runs(positions, up, down); }
};

TEST(RunCheck, TheFirstThatAppliesIsSaid) {
  RunsToCheck r;
  EXPECT_TRUE(r.check().ok());
  r.up = {{1, 2, 3}, {1, 2, 3}};
  r.down = {{3, 4, 5}, {3, 4, 5}};
  EXPECT_EQ(r.check().reason, Reason::no_spread);
  r.up[1] = {2, 3, 4};  // one constant for a whole run, which is in no figure of means
  r.down[1] = {4, 5, 6};
  EXPECT_EQ(r.check().reason, Reason::no_spread);
  r.positions = {200, 100, 100};
  EXPECT_EQ(r.check().reason, Reason::positions_not_monotone);
  EXPECT_EQ(r.check().where.index, 1);
  r.down.push_back({3, 4, 5});
  EXPECT_EQ(r.check().reason, Reason::run_count_differs);
  r.down[2][1] = std::nan("");
  EXPECT_EQ(r.check().reason, Reason::not_finite);
  EXPECT_STREQ(r.check().where.direction, "down");
  EXPECT_EQ(r.check().where.run, 2);
  EXPECT_EQ(r.check().where.target, 1);
  r.positions[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(r.check().reason, Reason::not_finite);
  EXPECT_STREQ(r.check().where.field, "positions");
  r.down[1].pop_back();
  EXPECT_EQ(r.check().reason, Reason::run_length);
  EXPECT_STREQ(r.check().where.direction, "down");
  EXPECT_EQ(r.check().where.run, 1);
  r.up.pop_back();
  EXPECT_EQ(r.check().reason, Reason::too_few_runs);
  EXPECT_STREQ(r.check().where.direction, "up");
  EXPECT_EQ(r.check().where.count, 1);
  r.down.clear();
  EXPECT_EQ(r.check().reason, Reason::missing_field);
  EXPECT_STREQ(r.check().where.field, "down");
  r.up.clear();
  EXPECT_STREQ(r.check().where.field, "up");
  r.positions.clear();
  EXPECT_STREQ(r.check().where.field, "positions");
}

TEST(RunCheck, OneTargetIsTooFew) {
  const Status status = check_runs({0}, {{1}, {2}}, {{1}, {3}});
  EXPECT_EQ(status.reason, Reason::too_few_points);
  EXPECT_EQ(status.where.count, 1);
}

}  // namespace
}  // namespace volcomp::host
