// Uncertainty of what tables predict whose squareness is closed by circles of a ball bar: each draw
// closes on the same circles as the build does. Slopes that circles and lines take out of a cubic:
// docs/ball-bar.md.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host_sim/host/measure/whole_way/whole_way.hpp"
#include "tests/host_sim/host/measure/drawn_deviation.hpp"

namespace volcomp::host {
namespace {

constexpr double kRadius = 100.0;  // of the circles, mm
constexpr std::size_t kDrawsOfCircles = 500;

enum class Closed { by_circles, by_lines };

MachineFile slides(Closed closed) {
  MachineFile file = read_machine_file(bundled_machine("xyfz"));
  if (closed == Closed::by_circles) file.squareness->circle_radius = kRadius;
  return file;
}

// One run of each axis; X, every 10 mm, is `straightness(u)` off in Y at u from the middle of its
// lines and circles, the others are right.
template <class Straightness>
std::vector<RunsFile> runs_with(const MachineFile& machine, const Straightness& straightness) {
  std::vector<RunsFile> files;
  for (AxisFile axis : machine.axes) {
    if (axis.letter == 'X') axis.targets = 51;
    RunsFile file;
    file.name = fmt::format("runs_{}.csv", axis.letter);
    file.letter = axis.letter;
    file.positions = axis.all_targets();
    RunValues values;
    for (const double q : file.positions) {
      values.emplace_back(ErrorMotion::Zero());
      if (axis.letter == 'X') values.back()(1) = straightness(q - machine.squareness->at.x());
    }
    file.up.push_back(values);
    file.down.push_back(values);
    files.push_back(std::move(file));
  }
  return files;
}

template <class Straightness>
std::array<DrawnNumber, 3> error_of(Closed closed, const Straightness& straightness,
                                    const CampaignStatement& stated) {
  const MachineFile machine = slides(closed);
  return uncertainty_of_task(machine, runs_with(machine, straightness), stated,
                             point_task("-400,-100,-300", machine), with_draws(kDrawsOfCircles),
                             no_progress)
      .places.front()
      .error;
}

// Paper, eq. 10: C = (Z a_xz, X a_xy − Z a_yz, 0), whatever the three are measured by.
TEST(CircleWay, WhatTheBarReadIsUncertain) {
  CampaignStatement stated;
  stated.squareness_urad = 3.0;
  const auto straight = [](double /*u*/) { return 0.0; };
  const auto error = error_of(Closed::by_circles, straight, stated);
  expect_deviation(error[0], 3e-6 * 300.0, kDrawsOfCircles);
  expect_deviation(error[1], 3e-6 * 500.0, kDrawsOfCircles);
}

// c u³, whose gain is uncertain: a circle of radius R takes c R²/2 for slope, seven points over ± ℓ
// take 7/9 c ℓ². That is what the closure turns the axis by, in each draw.
TEST(CircleWay, EveryDrawClosesOnTheSameCircles) {
  constexpr double kCubic = 3.2e-10;  // 5 µm at the ends
  CampaignStatement stated;
  stated.straightness_gain_percent = 1.0;
  const auto cubic = [](double u) { return kCubic * u * u * u; };
  const double x = -400.0;
  const double u = x + 250.0;
  const auto deviation = [&](double slope) {
    return 0.01 * kCubic * std::abs(u * u * u - 250.0 * 250.0 * 250.0 - slope * x);
  };
  const double half = 150.0;
  expect_deviation(error_of(Closed::by_circles, cubic, stated)[1],
                   deviation(kRadius * kRadius / 2.0), kDrawsOfCircles, 0.01);
  expect_deviation(error_of(Closed::by_lines, cubic, stated)[1], deviation(7.0 / 9.0 * half * half),
                   kDrawsOfCircles, 0.01);
}

// A bow about the middle looks like squareness to neither.
TEST(CircleWay, AgreesWithLinesWithoutOddStraightness) {
  CampaignStatement stated;
  stated.straightness_gain_percent = 1.0;
  stated.scale_um_per_m = 0.25;
  stated.squareness_urad = 3.0;
  const auto bow = [](double u) { return 8e-8 * u * u; };  // 5 µm at the ends
  const auto circles = error_of(Closed::by_circles, bow, stated);
  const auto lines = error_of(Closed::by_lines, bow, stated);
  for (std::size_t c = 0; c < circles.size(); ++c) {
    EXPECT_NEAR(circles.at(c).nominal, lines.at(c).nominal, 1e-8);
    EXPECT_NEAR(*circles.at(c).first_order, *lines.at(c).first_order, 1e-8);
    EXPECT_NEAR(circles.at(c).deviation, lines.at(c).deviation, 1e-8);
  }
  EXPECT_GT(std::abs(circles[1].nominal), 1e-3);
}

}  // namespace
}  // namespace volcomp::host
