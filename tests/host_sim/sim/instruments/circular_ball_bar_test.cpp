// A ball bar on a simulated machine: it finds what is wrong, within what its own errors allow, and
// closes the model of the machine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/simulated_measurement.hpp"
#include "host_sim/sim/instruments/circular_ball_bar.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::sim {
namespace {

host::MachineFile xyfz_file() { return host::read_machine_file(host::bundled_machine("xyfz")); }

constexpr double kRadius = 100.0;

SquarenessCircles place_of(const host::MachineFile& file) { return {file.squareness->at, kRadius}; }

class CircularBallBar : public testing::Test {
 protected:
  host::MachineFile file = xyfz_file();
  TrueMachine square = ideal_machine(file);
};

TEST_F(CircularBallBar, FindsSquarenessAlone) {
  square.directions = xyfz_directions({20e-6, -35e-6, 50e-6});
  const XyfzSquareness found =
      squareness_by_circles(square, place_of(file), perfect_ball_bar(), {});
  EXPECT_NEAR(found.a_xy, 20e-6, 2e-8);
  EXPECT_NEAR(found.a_xz, -35e-6, 2e-8);
  EXPECT_NEAR(found.a_yz, 50e-6, 2e-8);
}

// As ISO 230-2 has it: mean of rising less mean of falling.
TEST_F(CircularBallBar, ShowsReversal) {
  square.axis[0].reversal[0] = 4e-3;
  CirclePlan plan;
  plan.centre = file.squareness->at;
  const host::BallBarTest test = measure_circles(square, plan, perfect_ball_bar(), {});
  const CircleParameters p = host::decompose_ball_bar(test).value;
  EXPECT_NEAR(p.reversal[0], 4e-3, 1e-5);
  EXPECT_NEAR(p.reversal[1], 0.0, 1e-5);
  EXPECT_NEAR(p.squareness, 0.0, 1e-8);
}

// A second harmonic of the sensor, its sine rectangular within ± 0.5 µm, and readings that scatter
// by 0.15 µm: 2/R √(0.5²/3 + 2 · 0.15²/288) µm; set-up errors add nothing. 7 % is four standard
// deviations of the spread of 600 draws.
TEST_F(CircularBallBar, HasTheUncertaintyOfItsSensor) {
  constexpr int kDraws = 600;
  CirclePlan plan;
  plan.centre = file.squareness->at;
  plan.readings = 72;
  double squares = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const host::BallBarTest test = measure_circles(square, plan, BallBarClass{}, {1, draw, 0});
    const double a = host::decompose_ball_bar(test).value.squareness;
    squares += a * a;
  }
  const double sensor = 0.5e-3 / std::sqrt(3.0);
  const double readings = 0.15e-3 * std::sqrt(2.0 / 288.0);
  const double expected = 2.0 / kRadius * std::hypot(sensor, readings);
  EXPECT_NEAR(std::sqrt(squares / kDraws), expected, 0.07 * expected);
}

TEST_F(CircularBallBar, DependsOnTheDrawAlone) {
  CirclePlan plan;
  plan.centre = file.squareness->at;
  const auto radial = [&](std::uint32_t draw, std::uint32_t setup) {
    return measure_circles(square, plan, BallBarClass{}, {3, draw, setup}).circle[0][1].radial;
  };
  const std::vector<double> second = radial(1, 0);
  EXPECT_NE(radial(0, 0), second);
  EXPECT_NE(radial(1, 1), second);
  EXPECT_EQ(radial(1, 0), second);
}

// Largest error that the tables leave over the travel, µm, beside its mean.
double left_um(const TrueMachine& truth, const host::MachineFile& file,
               const host::BuiltTables& tables) {
  std::vector<Vec3> left;
  Vec3 mean = Vec3::Zero();
  for (const double x : {-500.0, -250.0, 0.0}) {
    for (const double y : {-300.0, -150.0, 0.0}) {
      for (const double z : {-400.0, -200.0, 0.0}) {
        const Pose q{x, y, z};
        left.emplace_back(truth.error(q, {}, file.chain.tool_point()).position_work -
                          tables.model.first_order(q, kUnknownTravels, Beyond::stand_at_end));
        mean += left.back() / 27.0;
      }
    }
  }
  double most = 0.0;
  for (const Vec3& e : left)
    most = std::max(most, (e - mean).norm());
  return 1e3 * most;
}

// Closed in the way it was measured, circles do as well as lines; circles taken for lines leave the
// form of the axes in the tables (measured in one way, subtracted in the other).
TEST_F(CircularBallBar, ClosesTheModelInTheWayItMeasures) {
  double mixed = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TrueMachine truth = draw_slides(file, seed);
    host::MachineFile circles = file;
    circles.squareness->circle_radius = kRadius;
    const Campaign by_lines = perfect_campaign(truth, file);
    Campaign by_circles = perfect_campaign(truth, circles);
    const auto left_by = [&](const Campaign& c) {
      const auto tables =
          host::build_tables(c.machine, c.runs, host::tables_only(host::ModelKind::abbe_closed));
      return left_um(truth, file, *tables);
    };
    const double lines_um = left_by(by_lines);
    EXPECT_NEAR(left_by(by_circles), lines_um, 0.2) << seed;
    by_circles.machine.squareness->circle_radius.reset();
    mixed = std::max(mixed, left_by(by_circles) - lines_um);
  }
  EXPECT_GT(mixed, 2.0);
}

}  // namespace
}  // namespace volcomp::sim
