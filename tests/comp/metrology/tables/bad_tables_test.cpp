// Error tables of the grinder's axes that must not be used, and what a position beyond a table
// does.

#include <cmath>
#include <limits>
#include <memory>

#include "comp/metrology/tables/error_table.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

std::unique_ptr<ErrorTable> good_table() {
  auto table = std::make_unique<ErrorTable>();
  table->q0 = -30.0;
  table->pitch = 10.0;
  table->knots = 7;
  for (std::size_t i = 0; i < table->knots; ++i)
    table->forward[i].setConstant(1e-5 * static_cast<double>(i));
  table->backward = table->forward;
  return table;
}

TEST(GrinderTableRefusal, NamesAxisKnotAndChannel) {
  const auto table = good_table();
  ASSERT_TRUE(check_table(*table, 'Z', 64).ok());
  table->backward[3](4) = std::numeric_limits<double>::quiet_NaN();
  const Status nan = check_table(*table, 'Z', 64);
  EXPECT_EQ(nan.reason, Reason::not_finite);
  EXPECT_EQ(nan.where.axis, 'Z');
  EXPECT_EQ(nan.where.index, 3);
  EXPECT_EQ(nan.where.channel, 4);
  table->knots = 1;
  EXPECT_EQ(check_table(*table, 'Z', 64).reason, Reason::too_few_knots);
  table->knots = 7;
  table->pitch = -10.0;
  EXPECT_EQ(check_table(*table, 'Z', 64).reason, Reason::pitch_not_positive);
}

TEST(GrinderTable, HoldsItsEndsAndWrapsAroundATurn) {
  const auto z = good_table();
  const auto c = good_table();
  c->q0 = 0.0;
  c->pitch = kPi / 3.0;
  c->forward[6] = c->backward[6] = c->forward[0];
  VolumetricModel model;
  model.chain = grinder_chain();
  model.table[kGrinderZ] = z.get();
  model.table[kGrinderC] = c.get();
  const auto at = [&](double stroke, double turn) {
    return model.errors(grinder_pose(44.0, stroke, turn, 0.26), kUnknownTravels);
  };
  EXPECT_EQ(at(500.0, 0.0)[kGrinderZ], at(30.0, 0.0)[kGrinderZ]);
  EXPECT_EQ(at(-500.0, 0.0)[kGrinderZ], at(-30.0, 0.0)[kGrinderZ]);
  const double inside = at(0.0, 1.3)[kGrinderC](5);
  EXPECT_NEAR(at(0.0, 1.3 + 200.0 * kPi)[kGrinderC](5), inside, 1e-15);
  EXPECT_NEAR(at(0.0, 1.3 - 2.0 * kPi)[kGrinderC](5), inside, 1e-15);
}

}  // namespace
}  // namespace volcomp::test
