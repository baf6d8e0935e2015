// Errors and offsets at single positions against machines small enough to be computed by hand, and
// the tick against its model.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/tables/evaluation.hpp"
#include "host_sim/host/tables/evaluation_text.hpp"
#include "tests/complaint.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::host {
namespace {

using test::constant_tables;
using test::moving_body;

constexpr double kUm = 1e-3;  // in mm
constexpr double kUrad = 1e-6;

EvaluatedPoint evaluated_at(const MachineTables& tables, const Pose& q,
                            Travel travel = Travel::unknown) {
  TableEvaluator evaluator(tables, "tables", travel);
  return evaluator.evaluate({q}).points.at(0);
}

void expect_near(const Vec3& found, const Vec3& wanted, double tolerance) {
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(found(i), wanted(i), tolerance) << "component " << i;
}

AxisTable flat_table(const Channels& value) {
  AxisTable table;
  table.q0 = -100'000'000;
  table.pitch = 100'000'000;
  table.knots = 3;
  for (auto& column : table.value)
    column.fill(value);
  return table;
}

// X carries the work: where its slide is 1 µm ahead, the tool is 1 µm behind, and a coordinate of
// the tool against the work has to grow by it.
TEST(Evaluation, SlideUnderTheWorkMovesTheToolTheOtherWay) {
  const EvaluatedPoint p = evaluated_at(constant_tables(1000.0F), {-50.0, 0.0, 0.0});
  expect_near(p.position, {-kUm, 0, 0}, 1e-12);
  expect_near(p.orientation, Vec3::Zero(), 1e-15);
  EXPECT_NEAR(p.exact[0], kUm, 1e-12);
  EXPECT_NEAR(p.model[0], kUm, 1e-12);
  ASSERT_TRUE(p.tick);
  EXPECT_NEAR((*p.tick)[0], kUm, 1e-12);
  EXPECT_EQ((*p.tick)[1], 0.0);
  EXPECT_EQ(p.beyond, 0U);
}

TEST(Evaluation, DirectionChoosesTheTable) {
  MachineTables tables = constant_tables(1000.0F);
  for (Channels& knot : tables.axis[0].value[1])
    knot[0] = 3000.0F;
  const auto x = [&](Travel travel) {
    const EvaluatedPoint p = evaluated_at(tables, {-50.0, 0.0, 0.0}, travel);
    EXPECT_NEAR(p.exact[0], (*p.tick)[0], 1e-9);
    EXPECT_NEAR(p.exact[0], -p.position.x(), 1e-12);
    return p.exact[0];
  };
  EXPECT_NEAR(x(Travel::forward), 1.0 * kUm, 1e-9);
  EXPECT_NEAR(x(Travel::backward), 3.0 * kUm, 1e-9);
  EXPECT_NEAR(x(Travel::unknown), 2.0 * kUm, 1e-9);
}

TEST(Evaluation, BeyondItsTableAnAxisStandsAtTheEnd) {
  MachineTables tables = constant_tables(1000.0F);
  tables.axis[0].value[0][1][0] = tables.axis[0].value[1][1][0] = 5000.0F;
  const EvaluatedPoint end = evaluated_at(tables, {0.0, -20.0, -100.0});
  const EvaluatedPoint beyond = evaluated_at(tables, {70.0, -20.0, -130.0});
  EXPECT_NEAR(end.exact[0], 5.0 * kUm, 1e-9);
  EXPECT_EQ(end.beyond, 0U);
  EXPECT_EQ(beyond.beyond, 0b101U);
  EXPECT_EQ(beyond.exact, end.exact);
  EXPECT_EQ(*beyond.tick, *end.tick);
}

// A pitch of 10 µrad about Y, 200 mm above the tool: the tool is 2 µm behind, and turned by as
// much. (0, b, 0) × (0, 0, −l) = (−b l, 0, 0).
TEST(Evaluation, AngleActsByTheLeverOfTheTool) {
  MachineDescription d;
  d.body_count = 3;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X');
  d.body[2] = moving_body(2, JointKind::prismatic, Axis::z, 1, 1, 'Z');
  d.work_body = 1;
  d.tool_body = 3;
  d.tool_point = {0.0, 0.0, -200.0};
  d.correcting = {0, 1};
  d.correcting_count = 2;
  MachineTables tables;
  tables.machine = d;
  tables.axis[0] = flat_table({});
  tables.axis[1] = flat_table({0, 0, 0, 0, 10e-6F, 0});
  const EvaluatedPoint p = evaluated_at(tables, {30.0, -40.0});
  expect_near(p.position, {-2.0 * kUm, 0, 0}, 2e-8);  // b² l / 2 is 1e-8
  expect_near(p.orientation, {0, 10.0 * kUrad, 0}, 1e-12);
  EXPECT_NEAR(p.exact[0], 2.0 * kUm, 2e-8);
  EXPECT_NEAR((*p.tick)[0], 2.0 * kUm, 1e-6);
}

// A table that is 4 µm off along its own X: at 90° of a table that turns the work backwards, base
// sees it along −Y, and the tool along +Y.
TEST(Evaluation, ErrorTurnsWithTheTableItBelongsTo) {
  MachineDescription d;
  d.body_count = 5;
  d.body[1] = moving_body(1, JointKind::rotary, Axis::z, -1, 3, 'C');
  d.body[2] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X');
  d.body[3] = moving_body(3, JointKind::prismatic, Axis::y, 1, 1, 'Y');
  d.body[4] = moving_body(4, JointKind::prismatic, Axis::z, 1, 2, 'Z');
  d.work_body = 2;
  d.tool_body = 5;
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  MachineTables tables;
  tables.machine = d;
  for (std::size_t a = 0; a < 3; ++a)
    tables.axis[a] = flat_table({});
  tables.axis[3] = flat_table({4000.0F});
  tables.axis[3].q0 = 0;
  tables.axis[3].pitch = kUnitsPerTurn / 3;
  tables.axis[3].periodic = true;
  const EvaluatedPoint p = evaluated_at(tables, {10.0, 20.0, 30.0, 0.5 * kPi});
  expect_near(p.position, {0, 4.0 * kUm, 0}, 1e-9);
  EXPECT_NEAR(p.exact[1], -4.0 * kUm, 1e-9);
  EXPECT_NEAR((*p.tick)[1], -4.0 * kUm, 1e-6);
  const EvaluatedPoint turned = evaluated_at(tables, {10.0, 20.0, 30.0, 6.5 * kPi});
  EXPECT_EQ(turned.beyond, 0U) << "a whole turn has no end";
  EXPECT_NEAR((*turned.tick)[1], (*p.tick)[1], 1e-6);
}

TEST(Evaluation, TickStaysWithinANanometreOfItsModelAllOverTheTravel) {
  test::Random random(7);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = test::xyfz_tables(5e3, 20e-6, random);
  for (const Travel travel : {Travel::forward, Travel::backward, Travel::unknown}) {
    TableEvaluator evaluator(tables, "tables", travel);
    ASSERT_TRUE(evaluator.within_1nm().value_or(false));
    const Evaluation evaluation = evaluator.evaluate(evaluator.grid(8));
    EXPECT_EQ(evaluation.points.size(), 512U);
    EXPECT_GT(evaluation.tick_from_model.nm, 0.0);
    EXPECT_LT(evaluation.tick_from_model.nm, 1.0);
    EXPECT_EQ(evaluation.tick_from_model.nrad, 0.0);
  }
}

TEST(Evaluation, GridGoesFromEndToEnd) {
  const TableEvaluator evaluator(constant_tables(0.0F), "tables", Travel::unknown);
  const std::vector<Pose> grid = evaluator.grid(3);
  ASSERT_EQ(grid.size(), 27U);
  EXPECT_EQ(grid.front(), (Pose{-100.0, -100.0, -100.0}));
  EXPECT_EQ(grid.at(1), (Pose{-100.0, -100.0, -50.0}));
  EXPECT_EQ(grid.back(), (Pose{}));
  EXPECT_THAT(sim::complaint_of([&] { return evaluator.grid(47); }),
              testing::HasSubstr("more than 100000 points"));
}

TEST(Evaluation, TablesThatNoNodeTakesAreRefused) {
  const MachineTables tables = constant_tables(2e7F);
  EXPECT_THAT(sim::complaint_of(
                  [&] { return TableEvaluator(tables, "big.vct", Travel::unknown).travel(); }),
              testing::HasSubstr("big.vct: "));
}

TEST(Evaluation, TextSaysWhichTablesAndWhichDirection) {
  const MachineTables tables = constant_tables(1000.0F);
  TableEvaluator evaluator(tables, "tables", Travel::backward);
  const Evaluation evaluation = evaluator.evaluate({{70.0, 0.0, 0.0}});
  const TableSource source{{"a.vct"}, 0x1234ABCDU};
  const nlohmann::json j = evaluation_json(evaluator, evaluation, source);
  EXPECT_THAT(evaluation_text(evaluator, j),
              testing::AllOf(testing::HasSubstr("a.vct, CRC-32 1234ABCD"),
                             testing::HasSubstr("X down, Y down, Z down"),
                             testing::HasSubstr("X beyond the table")));
  EXPECT_THAT(evaluation_csv(evaluator, j),
              testing::EndsWith("\n70,0,0,-1.000000,0.000000,0.000000,0.000000,0.000000,0.000000,"
                                "1.000000,1.000000,1.000000,0.000000,0.000000,0.000000,"
                                "0.000000,0.000000,0.000000,X\n"));
  EXPECT_EQ(j.at("crc32"), "1234ABCD");
  EXPECT_EQ(j.at("points").at(0).at("beyond_table"), nlohmann::json({"X"}));
}

}  // namespace
}  // namespace volcomp::host
