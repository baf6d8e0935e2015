// Where instruments are read when a plan says no place: within the travels, and so that what is
// asked can be told apart.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/planned_places.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"

namespace volcomp::host::identify {
namespace {

MeasurementPlan plan_named(const std::string& name) {
  return read_plan(bundled_plan(name), {{}, true});
}

host::identify::SetUp planned(const MeasurementPlan& plan, host::identify::SetUp s,
                              const PlaceChoice& choice) {
  add_planned_places(plan, choice, s);
  return s;
}

void expect_within_travels(const MeasurementPlan& plan, const host::identify::SetUp& s) {
  for (const Pose& q : s.q)
    for (std::size_t a = 0; a < plan.machine.axes.size(); ++a) {
      EXPECT_GE(q.at(a), plan.machine.axes[a].lo - 1e-9);
      EXPECT_LE(q.at(a), plan.machine.axes[a].hi + 1e-9);
    }
}

// The share of + among the directions of an axis with a tip.
double share_upwards(const host::identify::SetUp& s, std::size_t stylus, std::size_t axis) {
  int all = 0;
  int up = 0;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    if (s.stylus[i] != stylus) continue;
    ++all;
    up += s.d[i].at(axis) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(up) / all;
}

// Tips that took turns went in step with the directions: reversal could not be told from a tip.
TEST(PlannedPlaces, EveryTipOfATracerMeetsBothDirections) {
  const MeasurementPlan plan = plan_named("xyfz_tracer");
  for (const host::identify::SetUp& s : plan.problem.setups) {
    EXPECT_GE(s.q.size(), 160U);
    expect_within_travels(plan, s);
    for (std::size_t tip = 0; tip < 4; ++tip)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GT(share_upwards(s, tip, axis), 0.15);
        EXPECT_LT(share_upwards(s, tip, axis), 0.85);
      }
  }
}

TEST(PlannedPlaces, ACircleIsRoundItsSocketBothWays) {
  const MeasurementPlan plan = plan_named("xyfz_tracer");
  host::identify::SetUp s;
  s.kind = ObservationKind::bar;
  s.station = Vec3(0.0, 140.0, 450.0);
  s.length = 100.0;
  s.normal = Vec3::UnitZ();
  s = planned(plan, s, {});
  expect_within_travels(plan, s);
  ASSERT_EQ(s.q.size(), 2U * 73U);
  for (const Pose& q : s.q)
    EXPECT_NEAR(
        (ideal_geometry(plan.problem.machine.chain, q).in_work(plan.machine.chain.tool_point()) -
         *s.station)
            .norm(),
        100.0, 1e-9);
}

TEST(PlannedPlaces, ABodyDiagonalRunsFromCornerToCorner) {
  const MeasurementPlan plan = plan_named("xyfz_tracer");
  host::identify::SetUp s;
  s.kind = ObservationKind::diagonal;
  s.along = Vec3(5.0, 3.0, 4.0).normalized();
  s = planned(plan, s, {});
  const auto point = [&](std::size_t i) {
    return ideal_geometry(plan.problem.machine.chain, s.q[i])
        .in_work(plan.machine.chain.tool_point());
  };
  EXPECT_NEAR((point(20) - point(0)).norm(),
              std::sqrt(500.0 * 500.0 + 300.0 * 300.0 + 400.0 * 400.0), 1e-9);
  EXPECT_NEAR((point(40) - point(0)).norm(), 0.0, 1e-9);
  EXPECT_GT((point(20) - point(0)).dot(*s.along), 0.0);
}

// ISO 230-6, step diagonals: one axis at a time.
TEST(PlannedPlaces, AStepMovesOneAxisAtATime) {
  const MeasurementPlan plan = plan_named("xyfz_tracer");
  host::identify::SetUp s;
  s.kind = ObservationKind::step;
  s.along = Vec3(5.0, 3.0, 4.0).normalized();
  s = planned(plan, s, {});
  for (std::size_t i = 1; i < s.q.size(); ++i) {
    int moved = 0;
    for (std::size_t a = 0; a < 3; ++a)
      moved += std::abs(s.q[i].at(a) - s.q[i - 1].at(a)) > 1e-9 ? 1 : 0;
    EXPECT_EQ(moved, 1);
  }
}

TEST(PlannedPlaces, AnRTestStaysAtItsBall) {
  const MeasurementPlan plan = plan_named("trunnion_touch");
  host::identify::SetUp s;
  s.kind = ObservationKind::rtest;
  PlaceChoice choice;
  choice.ball = Vec3(60.0, 0.0, 150.0);
  s = planned(plan, s, choice);
  expect_within_travels(plan, s);
  EXPECT_GT(s.q.size(), 20U);
  for (const Pose& q : s.q)
    EXPECT_NEAR(
        (ideal_geometry(plan.problem.machine.chain, q).in_work(plan.machine.chain.tool_point()) -
         *choice.ball)
            .norm(),
        0.0, 1e-9);
}

// Each touch comes straight from outside to the middle of its ball, and begins clear of it.
TEST(PlannedSpheres, TouchesComeStraightToTheCentre) {
  for (const char* const name : {"xyfz_touch", "trunnion_touch", "trunnion_long"}) {
    const MeasurementPlan plan = plan_named(name);
    const MachineChain& chain = plan.problem.machine.chain;
    for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
      const host::identify::SetUp& s = plan.problem.setups[k];
      for (const TouchMove& m : touch_moves(plan, k)) {
        const Vec3 tip = plan.problem.styli[m.stylus].offset;
        const Vec3 centre = s.pose->R * plan.problem.artefacts[0].spheres[m.sphere] + s.pose->t;
        const Vec3 from = ideal_geometry(chain, m.from).in_work(tip) - centre;
        const Vec3 beyond = ideal_geometry(chain, m.beyond).in_work(tip) - centre;
        EXPECT_NEAR(from.norm(), 13.0 + kClearance_mm, 1e-9);
        EXPECT_NEAR(beyond.norm(), 13.0 - kOvertravel_mm, 1e-9);
        EXPECT_NEAR(from.normalized().dot(beyond.normalized()), 1.0, 1e-12);
        for (std::size_t a = 0; a < plan.machine.axes.size(); ++a) {
          EXPECT_GE(m.from.at(a), plan.machine.axes[a].lo);
          EXPECT_LE(m.from.at(a), plan.machine.axes[a].hi);
        }
      }
    }
  }
}

}  // namespace
}  // namespace volcomp::host::identify
