// Circular tests of machines that are known: what the evaluation says of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_evaluation.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kRadPerDegree = kPi / 180.0;
constexpr double kR = 100.0;

// What is off at an angle, mm; sense 1 counter-clockwise, −1 clockwise.
struct Off {
  double x = 0.0;
  double y = 0.0;
};
using OffPath = std::function<Off(double theta, double sense)>;

struct CirclesPlan {
  int readings = 360;
  int circles = 1;
  double noise = 0.0;  // mm
  Off socket{};        // mm
  bool clockwise = true;
};

BallBarTest circles_of(const OffPath& machine, const CirclesPlan& plan) {
  BallBarTest test;
  test.name = "test";
  test.plane = "XY";
  test.radius = kR;
  test.feed = 1000.0;
  std::uint32_t reading = 0;
  for (int run = 0; run < plan.circles; ++run) {
    for (std::size_t d = 0; d < (plan.clockwise ? 2U : 1U); ++d) {
      const double sense = d == 0 ? 1.0 : -1.0;
      BallBarCircle circle;
      circle.run = run + 1;
      for (int i = 0; i < plan.readings; ++i) {
        const double theta = sense * 360.0 * kRadPerDegree * i / plan.readings;
        const Off e = machine(theta, sense);
        const double length = std::hypot(kR * std::cos(theta) + e.x - plan.socket.x,
                                         kR * std::sin(theta) + e.y - plan.socket.y);
        circle.theta.push_back(theta);
        circle.radial.push_back(length - kR + plan.noise * normal(1, {6, 0, 0, reading++}));
      }
      test.circle.at(d).push_back(circle);
    }
  }
  return test;
}

Off no_error(double, double) { return {}; }

// X inclined by 30 µrad towards −Y: EC0Y = +30 µrad turns Y counter-clockwise, so that a point at
// +Y stands at −X.
Off inclined(double theta, double) { return {-30e-6 * kR * std::sin(theta), 0.0}; }

TEST(BallBar, FindsSquarenessWhereverTheSocketIs) {
  for (const double socket : {0.0, 0.05, 0.5}) {
    CirclesPlan plan;
    plan.socket = {socket, -socket};
    const BallBarEvaluation e = evaluate_ball_bar(circles_of(inclined, plan), {});
    EXPECT_STREQ(e.squareness, "EC0Y");
    EXPECT_NEAR(e.decomposition.value.squareness, 30e-6, 2e-9) << socket;
    // An ellipse of ± 1.5 µm; what is off in both, 5 nm at 0.5 mm, is second order.
    EXPECT_NEAR(e.decomposition.value.centre[0], socket, 1e-5);
    EXPECT_NEAR(e.both->circular, 3e-3, 1e-5);
  }
}

// In the interval of two noisy circles is the G(b) of the noise-free one; what is printed is too
// large.
TEST(BallBar, CorrectsCircularDeviationForNoise) {
  CirclesPlan plan;
  plan.readings = 120;
  plan.circles = 3;
  plan.noise = 0.3e-3;
  BallBarSettings settings;
  settings.draws = 400;
  const BallBarEvaluation e = evaluate_ball_bar(circles_of(inclined, plan), settings);
  ASSERT_TRUE(e.intervals);
  const FigureInterval& g = e.intervals->both;
  EXPECT_GT(e.both->circular, 3e-3);
  EXPECT_LT(std::abs(g.corrected - 3e-3), e.both->circular - 3e-3);
  EXPECT_LE(g.low, 3e-3);
  EXPECT_GE(g.high, 3e-3);
  EXPECT_GE(g.upper95, g.corrected);
  EXPECT_LE(g.upper95, g.high);
  EXPECT_NEAR(g.estimate, e.both->circular, 1e-9);
}

TEST(BallBar, SaysWhyThereIsNoInterval) {
  const BallBarEvaluation once = evaluate_ball_bar(circles_of(inclined, {}), {});
  EXPECT_FALSE(once.intervals);
  EXPECT_THAT(once.remarks, Contains(HasSubstr("one circle each way")));
  CirclesPlan copied;
  copied.circles = 2;
  const BallBarEvaluation twice = evaluate_ball_bar(circles_of(inclined, copied), {});
  EXPECT_FALSE(twice.intervals);
  EXPECT_THAT(twice.remarks, Contains(HasSubstr("no_spread")));
}

// Figure and interval are of the same circles, or there is no interval.
TEST(BallBar, GivesNoIntervalOfUnequalNumbersOfCircles) {
  CirclesPlan plan;
  plan.readings = 72;
  plan.circles = 3;
  plan.noise = 0.2e-3;
  BallBarTest test = circles_of(inclined, plan);
  test.circle[1].pop_back();
  const BallBarEvaluation e = evaluate_ball_bar(test, {1, 100, 0.0});
  EXPECT_FALSE(e.intervals);
  EXPECT_THAT(e.remarks, Contains(HasSubstr("run_count_differs")));
}

// A copied circle with another length or socket is a copied circle.
TEST(BallBar, SeesCopiesThatWereShifted) {
  CirclesPlan plan;
  plan.readings = 72;
  plan.noise = 0.2e-3;
  BallBarTest test = circles_of(inclined, plan);
  for (auto& direction : test.circle) {
    direction.push_back(direction[0]);
    direction[1].run = 2;
    for (double& radial : direction[1].radial)
      radial += 1e-3;
  }
  const BallBarEvaluation e = evaluate_ball_bar(test, {1, 100, 0.0});
  EXPECT_FALSE(e.intervals);
  EXPECT_THAT(e.remarks, Contains(HasSubstr("no_spread")));
}

// One circle each way and a stated scatter of readings: an interval all the same.
TEST(BallBar, TakesAStatedScatterForSingleCircles) {
  CirclesPlan plan;
  plan.readings = 72;
  plan.noise = 0.2e-3;
  BallBarSettings settings;
  settings.draws = 200;
  settings.sigma = 0.2e-3;
  const BallBarEvaluation e = evaluate_ball_bar(circles_of(no_error, plan), settings);
  ASSERT_TRUE(e.intervals);
  EXPECT_LT(e.intervals->both.low, 0.3e-3);
  EXPECT_LT(e.intervals->both.corrected, e.both->circular);
}

TEST(BallBar, SaysWhatOneDirectionCannotTell) {
  CirclesPlan plan;
  plan.clockwise = false;
  const BallBarEvaluation e = evaluate_ball_bar(circles_of(inclined, plan), {});
  EXPECT_FALSE(e.both);
  EXPECT_NEAR(e.decomposition.value.squareness, 30e-6, 2e-9);
  EXPECT_THAT(e.remarks, Contains(HasSubstr("one direction only")));
}

// Circles that differ by more than what is left over in each: their spread is the uncertainty.
TEST(BallBar, TakesTheSpreadBetweenCirclesIfItIsLarger) {
  BallBarTest test = circles_of(inclined, {360, 1, 0.0, {}, true});
  const BallBarTest other = circles_of(
      [](double theta, double) {
        return Off{-40e-6 * kR * std::sin(theta), 0.0};
      },
      {});
  for (std::size_t d = 0; d < 2; ++d) {
    test.circle.at(d).push_back(other.circle.at(d)[0]);
    test.circle.at(d)[1].run = 2;
  }
  const BallBarEvaluation e = evaluate_ball_bar(test, {1, 100, 0.0});
  EXPECT_NEAR(e.decomposition.value.squareness, 35e-6, 5e-9);
  EXPECT_NEAR(e.u_squareness, 5e-6, 5e-8);  // two values ± 5: standard deviation of their mean
}

TEST(BallBar, RefusesCirclesReadElsewhere) {
  BallBarTest test = circles_of(no_error, {});
  BallBarCircle shifted = test.circle[0][0];
  shifted.run = 2;
  for (double& theta : shifted.theta)
    theta += 0.25 * kRadPerDegree;
  test.circle[0].push_back(shifted);
  EXPECT_THAT(sim::complaint_of([&] { return evaluate_ball_bar(test, {}); }),
              HasSubstr("circle 2 has other angles than circle 1"));
}

// Memory and time do not grow without end with the readings of a file.
TEST(BallBar, GivesNoIntervalOfTooManyReadings) {
  CirclesPlan plan;
  plan.circles = 2;
  plan.noise = 0.2e-3;
  plan.readings = 12'000;
  const BallBarEvaluation e = evaluate_ball_bar(circles_of(inclined, plan), {});
  EXPECT_FALSE(e.intervals);
  EXPECT_THAT(e.remarks, Contains(HasSubstr("more than 10000 readings")));
}

// The figures for programs are those of the evaluation, in µm and µrad.
TEST(BallBar, GivesTheSameFiguresToPrograms) {
  CirclesPlan plan;
  plan.readings = 72;
  plan.circles = 2;
  plan.noise = 0.2e-3;
  const BallBarSettings settings{7, 200, 0.0};
  const BallBarTest test = circles_of(inclined, plan);
  const BallBarEvaluation e = evaluate_ball_bar(test, settings);
  const nlohmann::json j = ball_bar_json(test, e, settings);
  EXPECT_EQ(j["squareness"], "EC0Y");
  EXPECT_NEAR(j["squareness_urad"].get<double>(), 30.0, 3.0);
  EXPECT_EQ(j["draws"], 200);
  EXPECT_EQ(j["seed"], 7);
  EXPECT_NEAR(j["intervals"]["both"]["um"].get<double>(), 1e3 * e.both->circular, 1e-6);
  EXPECT_LE(j["intervals"]["both"]["low_um"], j["intervals"]["both"]["corrected_um"]);
  EXPECT_EQ(j["figures"][2]["figure"], "G(b)_XY");
  EXPECT_THAT(ball_bar_text(test, e), HasSubstr("EC0Y"));
}

}  // namespace
}  // namespace volcomp::host
