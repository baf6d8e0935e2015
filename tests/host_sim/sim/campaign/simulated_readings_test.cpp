// A plan carried out on simulated machines: on one without errors every reading is what geometry
// says, and on one with errors every touch is at its ball.

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/observation_table.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::sim {
namespace {

using namespace host::identify;

MeasurementPlan small_plan() {
  return read_plan(std::filesystem::path(VOLCOMP_TEST_DATA) / "plan_small.toml", {{}, true});
}

// Nothing unknown, nothing warm, nothing that scatters.
ShopFloor nothing_unknown() {
  ShopFloor floor;
  floor.perfect = true;
  floor.stylus_mm = floor.pose_mm = floor.pose_rad = floor.station_mm = floor.dead_length_mm =
      floor.mirror_rad = 0.0;
  return floor;
}

SetUp instrument(ObservationKind kind, const MeasurementPlan& plan) {
  host::identify::SetUp s;
  s.name = "instrument";
  s.kind = kind;
  const std::size_t axes = plan.machine.axes.size();
  for (int i = 0; i < 4; ++i) {
    Pose q{};
    for (std::size_t a = 0; a < axes; ++a)
      q.at(a) = plan.machine.axes[a].lo + (0.2 + 0.15 * i + 0.1 * static_cast<double>(a)) *
                                              (plan.machine.axes[a].hi - plan.machine.axes[a].lo);
    s.q.push_back(q);
    s.d.push_back({});
  }
  return s;
}

// Readings of one instrument on the machine of the plan without errors.
std::vector<double> read_on_ideal(MeasurementPlan plan, SetUp s, ShopFloor floor) {
  s.sigma.assign(s.q.size() * s.components(), 1e-3);
  plan.problem.setups = {s};
  plan.touch_sigma = {0.0};
  const PlanTruth truth = draw_plan_truth(plan.problem, ideal_machine(plan.machine), floor);
  read_instrument(plan, truth, 0, s);
  return s.y;
}

Vec3 ideal_point(const MeasurementPlan& plan, const Pose& q) {
  return ideal_geometry(plan.problem.machine.chain, q).in_work(plan.problem.styli[0].offset);
}

TEST(SimulatedReadings, ATracerReadsDistances) {
  const MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::tracer, plan);
  s.station = Vec3(-400.0, -100.0, 250.0);
  const std::vector<double> y = read_on_ideal(plan, s, nothing_unknown());
  for (std::size_t i = 0; i < y.size(); ++i)
    EXPECT_NEAR(y[i], (ideal_point(plan, s.q[i]) - *s.station).norm(), 1e-9);
}

// On the bed a station sees the tool alone: of these axes Z, whatever X and Y do wrong.
TEST(SimulatedReadings, AStationOnTheBedSeesTheToolAlone) {
  MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::tracer, plan);
  s.station = Vec3(-400.0, -100.0, 250.0);
  s.sigma.assign(s.q.size(), 1e-3);
  for (Pose& q : s.q)
    q.at(plan.machine.axis_index('Z')) = -100.0;
  for (const bool in_bed : {true, false}) {
    s.in_bed = in_bed;
    plan.problem.setups = {s};
    plan.touch_sigma = {0.0};
    const PlanTruth truth =
        draw_plan_truth(plan.problem, draw_machine(plan.machine, 3), nothing_unknown());
    read_instrument(plan, truth, 0, s);
    double largest = 0.0;
    for (const double reading : s.y)
      largest = std::max(largest, std::abs(reading - s.y.front()));
    if (in_bed)
      EXPECT_LT(largest, 1e-9);
    else
      EXPECT_GT(largest, 1.0);
  }
}

TEST(SimulatedReadings, ADiagonalReadsTheWayAlongItsBeam) {
  const MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::diagonal, plan);
  s.along = Vec3(2.0, -1.0, 2.0) / 3.0;
  const std::vector<double> y = read_on_ideal(plan, s, nothing_unknown());
  for (std::size_t i = 1; i < y.size(); ++i)
    EXPECT_NEAR(y[i] - y[0], s.along->dot(ideal_point(plan, s.q[i]) - ideal_point(plan, s.q[0])),
                1e-9);
}

// A mirror across the beam reads the same; one that is tilted by an angle reads more by what the
// machine moves across times its tangent.
TEST(SimulatedReadings, ATiltedMirrorReadsAcross) {
  const MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::step, plan);
  s.along = Vec3::UnitX();
  s.beam = Vec3::Zero();
  constexpr double kTilt = 1e-3;
  s.mirror = Vec3(std::cos(kTilt), std::sin(kTilt), 0.0);
  const std::vector<double> y = read_on_ideal(plan, s, nothing_unknown());
  for (std::size_t i = 1; i < y.size(); ++i) {
    const Vec3 way = ideal_point(plan, s.q[i]) - ideal_point(plan, s.q[0]);
    EXPECT_NEAR(y[i] - y[0], way.x() + std::tan(kTilt) * way.y(), 1e-9);
  }
}

TEST(SimulatedReadings, ABarOfItsLengthReadsNothing) {
  const MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::bar, plan);
  s.q.resize(1);
  s.d.resize(1);
  const Vec3 tip = ideal_point(plan, s.q[0]);
  s.station = tip - Vec3(0.0, 100.0, 0.0);
  s.length = 100.0;
  s.length_prior = kFree;
  EXPECT_NEAR(read_on_ideal(plan, s, nothing_unknown()).at(0), 0.0, 1e-9);
}

// A ball that is found where the tool stands first, and a machine without errors that goes by a
// known way: the ball is that way behind.
TEST(SimulatedReadings, AnRTestReadsWhereTheBallIs) {
  const MeasurementPlan plan = small_plan();
  const host::identify::SetUp s = instrument(ObservationKind::rtest, plan);
  const std::vector<double> y = read_on_ideal(plan, s, nothing_unknown());
  const ChainGeometry g = ideal_geometry(plan.problem.machine.chain, s.q[0]);
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const Vec3 behind = ideal_point(plan, s.q[0]) - ideal_point(plan, s.q[i]);
    const Vec3 wanted = g.tool_in_work().transpose() * behind;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(y[3 * i + k], wanted(static_cast<Eigen::Index>(k)), 1e-9);
  }
}

// Noise is of the size stated, and the same for the same seed.
TEST(SimulatedReadings, ReadingsScatterByWhatThePlanStates) {
  const MeasurementPlan plan = small_plan();
  host::identify::SetUp s = instrument(ObservationKind::diagonal, plan);
  s.along = Vec3::UnitX();
  const std::vector<Pose> places = s.q;
  while (s.q.size() < 4000) {
    s.q.push_back(places[s.q.size() % places.size()]);
    s.d.push_back({});
  }
  ShopFloor floor = nothing_unknown();
  const std::vector<double> exact = read_on_ideal(plan, s, floor);
  floor.perfect = false;
  floor.growth_K = 0.0;
  const std::vector<double> read = read_on_ideal(plan, s, floor);
  double squares = 0.0;
  for (std::size_t i = 0; i < read.size(); ++i)
    squares += (read[i] - exact[i]) * (read[i] - exact[i]);
  // 1e-3 mm; the spread of a standard deviation of 4000 is 1.1 %.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(read.size())), 1e-3, 0.05e-3);
  EXPECT_EQ(read, read_on_ideal(plan, s, floor));
}

TEST(SimulatedReadings, EveryTouchIsAtItsBall) {
  const MeasurementPlan plan = small_plan();
  ShopFloor floor;
  floor.perfect = true;
  const TrueMachine machine = draw_machine(plan.machine, 7);
  const PlanTruth truth = draw_plan_truth(plan.problem, machine, floor);
  const std::vector<LatchedTouch> touches = touch_all(plan, truth);
  ASSERT_EQ(touches.size() % 5, 0U);
  ASSERT_GT(touches.size(), 200U);
  for (const LatchedTouch& t : touches) {
    const TrueSetUp& s = truth.setup[t.setup];
    const Vec3 centre = s.pose.R * truth.sphere[0][t.sphere] + s.pose.t;
    EXPECT_NEAR((true_point(s.machine, t.q, t.d, truth.tip[t.stylus]) - centre).norm(),
                10.0 + truth.tip_radius[t.stylus], 1e-8);
  }
}

// What is written is what is read, to the rounding of the table.
TEST(SimulatedReadings, TablesHoldTheTouches) {
  const MeasurementPlan plan = small_plan();
  const PlanTruth truth = draw_plan_truth(plan.problem, draw_machine(plan.machine, 7), {});
  const std::vector<LatchedTouch> touches = touch_all(plan, truth);
  std::istringstream text(touches_csv(plan, touches));
  const ObservationTable table =
      read_observation_table(text, "touches.csv", plan.machine, ObservationKind::centre);
  ASSERT_EQ(table.rows.size(), touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(table.rows[i].setup, plan.problem.setups[touches[i].setup].name);
    EXPECT_EQ(table.rows[i].sphere, touches[i].sphere);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(table.rows[i].q.at(a), touches[i].q.at(a), 0.51e-6);
      EXPECT_EQ(table.rows[i].d.at(a), touches[i].d.at(a));
    }
  }
}

}  // namespace
}  // namespace volcomp::sim
