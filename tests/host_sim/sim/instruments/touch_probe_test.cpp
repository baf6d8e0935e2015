// A touch probe on the L300G: when it trips, and what comes out of it.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/instruments/touch_probe.hpp"
#include "tests/host_sim/sim/artefacts/plane.hpp"

namespace volcomp::sim {
namespace {

using test::Plane;

constexpr double kTip = 1.4935;
constexpr double kSpeed_mm_s = 1000.0 / 60.0;
constexpr std::int64_t kPeriod_ns = 4'000'000;
constexpr double kStep_mm = kSpeed_mm_s * kPeriod_ns * 1e-9;
constexpr double kArmLevel = -39.025 * kPi / 180.0;
constexpr double kOnAxis = 168.8053;  // reading of Y with the ball at y = 0

struct TimedEdge {
  bool rising;
  std::int64_t time_ns;  // since the begin of everything
};

class Probe : public testing::Test {
 protected:
  Probe() { truth.chain = host::read_machine_file(host::bundled_machine("l300g")).chain; }

  static Stance at(double y, double B = kArmLevel) {
    Stance stance;
    stance.position = {10.0, kOnAxis + y, B, 0.0};
    return stance;
  }

  // Goes along −Y from `y` for so many periods, then back.
  static std::vector<TimedEdge> touch(TouchProbe& probe, double y, int there, int back) {
    std::vector<TimedEdge> edges;
    for (int k = 0; k < there + back; ++k) {
      const double next = y + (k < there ? -kStep_mm : kStep_mm);
      for (const ProbeEdge& edge : probe.travel(at(y), at(next), kPeriod_ns)) {
        EXPECT_LT(edge.time_ns, kPeriod_ns);
        edges.push_back({edge.rising, edge.time_ns + k * kPeriod_ns});
      }
      y = next;
    }
    return edges;
  }

  TrueMachine truth;
  Plane wall{{0.0, 60.0, 0.0}, Vec3::UnitY()};
};

// The ball of 1.4935 mm touches y = 60 mm when its centre is at 61.4935 mm.
TEST_F(Probe, TripsWhenTheBallIsThere) {
  for (const double begin : {62.0, 62.0123, 61.9}) {
    TouchProbe probe(truth, wall, {kTip, {}, 10'000, {}});
    const auto edges = touch(probe, begin, 12, 12);
    const double expected_ns = (begin - 61.4935) / kSpeed_mm_s * 1e9 + 10'000.0;
    ASSERT_EQ(edges.size(), 2U);
    EXPECT_TRUE(edges[0].rising);
    EXPECT_NEAR(static_cast<double>(edges[0].time_ns), expected_ns, 1.1);
    // Going back at the same speed, it leaves as long after the turning point as it came before.
    EXPECT_FALSE(edges[1].rising);
    EXPECT_NEAR(static_cast<double>(edges[0].time_ns + edges[1].time_ns),
                2.0 * (12.0 * kPeriod_ns + 10'000.0), 2.2);
  }
}

TEST_F(Probe, AnEdgeDelayedIntoTheNextPeriodBelongsToThatPeriod) {
  TouchProbe probe(truth, wall, {kTip, {}, 10'000, {}});
  const double begin = 61.4935 + kSpeed_mm_s * (kPeriod_ns - 4'000) * 1e-9;
  EXPECT_TRUE(probe.travel(at(begin), at(begin - kStep_mm), kPeriod_ns).empty());
  const auto edges = probe.travel(at(begin - kStep_mm), at(begin - 2.0 * kStep_mm), kPeriod_ns);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(static_cast<double>(edges[0].time_ns), 6'000.0, 1.1);
}

TEST_F(Probe, BouncesAsItIsTold) {
  TouchProbe probe(truth, wall, {kTip, {}, 10'000, {200'000, 5'000'000}});
  const auto edges = touch(probe, 62.0, 12, 0);
  ASSERT_EQ(edges.size(), 5U);
  const std::int64_t first = edges[0].time_ns;
  const std::vector<std::int64_t> after{0, 100'000, 200'000, 2'600'000, 5'000'000};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(edges[i].rising, i % 2 == 0);
    EXPECT_EQ(edges[i].time_ns - first, after[i]);
  }
}

TEST_F(Probe, InContactFromTheBeginningItHasNoRisingEdge) {
  TouchProbe probe(truth, wall, {kTip, {}, 0, {}});
  EXPECT_TRUE(touch(probe, 61.4, 3, 0).empty());
}

// With the arm level its frame is that of the machine: the wall is met along the frame's Y. The arm
// swung by θ about Y still meets it along Y, but the floor under another angle.
TEST_F(Probe, LobingFollowsTheFrameOfTheProbe) {
  Vec3 seen = Vec3::Zero();
  const auto lobing = [&seen](const Vec3& normal) {
    seen = normal;
    return 0.004 * normal.z();
  };
  TouchProbe on_wall(truth, wall, {kTip, lobing, 0, {}});
  EXPECT_NEAR(on_wall.margin_mm(at(62.0)), 62.0 - 61.4935, 1e-12);
  EXPECT_LT((seen - Vec3::UnitY()).norm(), 1e-14);

  const double theta = 0.2;
  const Plane floor({0.0, 0.0, 20.0}, Vec3::UnitZ());
  TouchProbe on_floor(truth, floor, {kTip, lobing, 0, {}});
  const double height = 173.7135 * std::sin(theta);
  EXPECT_NEAR(on_floor.margin_mm(at(62.0, kArmLevel + theta)),
              height - 20.0 - kTip - 0.004 * std::cos(theta), 1e-12);
  // In the probe's frame, turned by +θ about Y, Z of the machine is (−sin θ, 0, cos θ).
  EXPECT_LT((seen - Vec3(-std::sin(theta), 0.0, std::cos(theta))).norm(), 1e-14);
}

// EYY grows by 12 µm over 200 mm of Y: the ball stands further out by its share.
TEST_F(Probe, TouchesWithTheMachineAsItReallyIs) {
  truth.axis[1].lo = kOnAxis;
  truth.axis[1].hi = kOnAxis + 200.0;
  truth.axis[1].channel[1].linear = 0.012;
  TouchProbe probe(truth, wall, {kTip, {}, 0, {}});
  EXPECT_NEAR(probe.ball_centre(at(50.0)).y(), 50.003, 1e-12);
  EXPECT_NEAR(probe.margin_mm(at(62.0)), 62.0 + 0.00372 - 61.4935, 1e-12);
}

// Positive scatter is excess material: the probe trips that much earlier. Every touch has its own.
TEST_F(Probe, ScattersFromTouchToTouch) {
  const std::vector<double> scatter{0.0, 0.010, -0.020};
  TouchProbe::Settings settings;
  settings.radius_mm = kTip;
  settings.scatter_mm = [&](std::uint32_t number) { return scatter.at(number); };
  TouchProbe probe(truth, wall, settings);
  std::vector<double> tripped_mm;  // how far the ball had to go
  constexpr int kThere = 12;
  for (int k = 0; k < 2; ++k) {
    const auto edges = touch(probe, 62.0, kThere, kThere);
    ASSERT_EQ(edges.size(), 2U);
    tripped_mm.push_back(kSpeed_mm_s * 1e-9 *
                         static_cast<double>(edges[0].time_ns - settings.delay_ns));
  }
  EXPECT_NEAR(tripped_mm[0], 62.0 - 61.4935, 1e-6);
  EXPECT_NEAR(tripped_mm[1], 62.0 - 61.4935 - 0.010, 1e-6);
}

// Half of the hysteresis is excess where the touch before came from the same side; the first touch
// has none before it.
TEST_F(Probe, RemembersFromWhereItWasTouchedBefore) {
  TouchProbe::Settings settings;
  settings.radius_mm = kTip;
  settings.hysteresis_mm = 0.006;
  TouchProbe probe(truth, wall, settings);
  std::vector<double> tripped_mm;
  constexpr int kThere = 12;
  for (int k = 0; k < 3; ++k) {
    const auto edges = touch(probe, 62.0, kThere, kThere);
    ASSERT_EQ(edges.size(), 2U);
    tripped_mm.push_back(kSpeed_mm_s * 1e-9 *
                         static_cast<double>(edges[0].time_ns - settings.delay_ns));
  }
  EXPECT_NEAR(tripped_mm[0], 62.0 - 61.4935, 1e-6);
  EXPECT_NEAR(tripped_mm[1], 62.0 - 61.4935 - 0.003, 1e-6);
  EXPECT_NEAR(tripped_mm[2], 62.0 - 61.4935 - 0.003, 1e-6);
}

}  // namespace
}  // namespace volcomp::sim
