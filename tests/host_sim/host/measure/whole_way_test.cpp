// Uncertainty of what tables predict, against standard deviations written down by hand for machines
// simple enough for that.

#include "host_sim/host/measure/whole_way/whole_way.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/whole_way/image_of_runs.hpp"
#include "host_sim/host/measure/whole_way/whole_way_report.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/measure/drawn_deviation.hpp"

namespace volcomp::host {
namespace {

using testing::Contains;
using testing::HasSubstr;

// One slide that carries the tool, whose point is at the reading head; knots at the targets.
MachineFile one_slide() {
  return parse_machine(R"(
name = "slide"
id = 7
convention = "relative"
side = "moving"
chain = "w-b-X-t"
tool = { point_mm = [0.0, 0.0, 0.0] }
correction = { axes = ["X"] }
tables = { refine = 1, interpolation = "linear" }
axis = [
  { name = "X", travel_mm = [0.0, 1000.0], reference_mm = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
]
)",
                       "slide.toml");
}

constexpr std::size_t kTargets = 6;

// `runs` alike in each direction, whose readings at a target are `at(position)`.
template <class At>
RunsFile runs_of_slide(std::size_t runs, const At& at) {
  RunsFile file;
  file.name = "runs_X.csv";
  file.letter = 'X';
  RunValues values;
  for (std::size_t t = 0; t < kTargets; ++t) {
    file.positions.push_back(200.0 * static_cast<double>(t));
    values.push_back(at(file.positions.back()));
  }
  file.up.assign(runs, values);
  file.down.assign(runs, values);
  return file;
}

RunsFile silent_runs(std::size_t runs) {
  return runs_of_slide(runs, [](double) { return ErrorMotion(ErrorMotion::Zero()); });
}

Task places_of_slide(const std::vector<double>& x) {
  Task task{"task", TaskKind::places, {}};
  for (const double at : x)
    task.places.push_back({at});
  return task;
}

TaskUncertainty of_slide(const RunsFile& runs, const CampaignStatement& stated, const Task& task,
                         const WholeWaySettings& settings) {
  return uncertainty_of_task(one_slide(), {runs}, stated, task, settings, no_progress);
}

// n readings of 0.7 µm in each direction. The mean of both directions has σ/√2n, and its value at
// the reference is taken off it.
TEST(WholeWay, ReadingsAreAveragedAndReferred) {
  constexpr std::size_t kDraws = 1000;
  CampaignStatement stated;
  stated.reading_um = 0.7;
  const double one = 0.7e-3 / std::sqrt(2.0 * 4.0);
  const TaskUncertainty u =
      of_slide(silent_runs(4), stated, places_of_slide({0.0, 600.0, 700.0}), with_draws(kDraws));
  EXPECT_DOUBLE_EQ(u.places[0].error[0].deviation, 0.0);
  expect_deviation(u.places[1].error[0], std::sqrt(2.0) * one, kDraws);
  // Halfway between two targets: the mean of both, less the reference.
  expect_deviation(u.places[2].error[0], std::sqrt(1.5) * one, kDraws);
  // 95 % of a normal distribution.
  EXPECT_NEAR(u.places[1].error[0].high, 1.96 * std::sqrt(2.0) * one, 0.3 * one);
  EXPECT_NEAR(u.places[1].error[0].low, -1.96 * std::sqrt(2.0) * one, 0.3 * one);
}

// The table of one direction is referred to the mean of both: σ²/n + σ²/2n.
TEST(WholeWay, OneDirectionOfTravelHasItsOwnReadings) {
  constexpr std::size_t kDraws = 1000;
  CampaignStatement stated;
  stated.reading_um = 0.5;
  WholeWaySettings settings = with_draws(kDraws);
  settings.travel = Travel::backward;
  const TaskUncertainty u = of_slide(silent_runs(1), stated, places_of_slide({400.0}), settings);
  expect_deviation(u.places[0].error[0], 0.5e-3 * std::sqrt(1.5), kDraws);
}

// One instrument for all axes: E = scale · position, the same number in all three, so that the
// largest error at the far end is the length of its way times |N(0, u)|.
TEST(WholeWay, ScaleIsCommonToAllAxes) {
  constexpr std::size_t kDraws = 1500;
  const MachineFile file = read_machine_file(bundled_machine("xyfz"));
  const sim::Campaign campaign = sim::perfect_campaign(sim::draw_machine(file, 3), file);
  CampaignStatement stated;
  stated.scale_um_per_m = 0.25;
  const Task task = line_task("0,0,0:-300,-300,-300", 2, campaign.machine);
  const TaskUncertainty u = uncertainty_of_task(campaign.machine, campaign.runs, stated, task,
                                                with_draws(kDraws), no_progress);
  for (const DrawnNumber& n : u.places[1].error)
    expect_deviation(n, 0.25e-6 * 300.0, kDraws);
  EXPECT_EQ(u.figures.front().key, "from_nominal");
  const double length = 300.0 * std::sqrt(3.0);
  const double mean = std::sqrt(2.0 / kPi);  // of |N(0, 1)|; three independent ones have 0.92
  EXPECT_NEAR(u.figures.front().drawn.mean, 0.25e-6 * length * mean,
              0.25e-6 * length * 3.0 * 0.61 / std::sqrt(static_cast<double>(kDraws)));
}

// Paper, eq. 10: C = (Z a_xz, X a_xy − Z a_yz, 0), and the closure takes off what the tables show
// already, which the measurement of squareness does not change.
TEST(WholeWay, SquarenessTurnsWithTheOtherAxes) {
  constexpr std::size_t kDraws = 500;
  const MachineFile file = read_machine_file(bundled_machine("xyfz"));
  const sim::Campaign campaign = sim::perfect_campaign(sim::draw_machine(file, 3), file);
  CampaignStatement stated;
  stated.squareness_urad = 3.0;
  const TaskUncertainty u = uncertainty_of_task(campaign.machine, campaign.runs, stated,
                                                point_task("-400,-100,-300", campaign.machine),
                                                with_draws(kDraws), no_progress);
  expect_deviation(u.places[0].error[0], 3e-6 * 300.0, kDraws);
  expect_deviation(u.places[0].error[1], 3e-6 * 500.0, kDraws);  // of 400 and 300
  expect_deviation(u.places[0].error[2], 0.0, kDraws);
}

// An angle of 10 µrad a metre: δ = m − ε × L, so a lever off by u in Z and in X moves X and Z.
TEST(WholeWay, LeversActThroughAngles) {
  constexpr std::size_t kDraws = 500;
  const RunsFile runs = runs_of_slide(1, [](double x) {
    ErrorMotion e = ErrorMotion::Zero();
    e(4) = 1e-8 * x;
    return e;
  });
  CampaignStatement stated;
  stated.lever_mm = 3.0;
  const TaskUncertainty u = of_slide(runs, stated, places_of_slide({800.0}), with_draws(kDraws));
  expect_deviation(u.places[0].error[0], 8e-6 * 3.0, kDraws);
  expect_deviation(u.places[0].error[1], 0.0, kDraws);
  expect_deviation(u.places[0].error[2], 8e-6 * 3.0, kDraws);
}

TEST(WholeWay, BeamThatIsNotParallelReadsTooShort) {
  CampaignStatement stated;
  stated.cosine_mrad = 0.5;
  const TaskUncertainty u =
      of_slide(silent_runs(1), stated, places_of_slide({1000.0}), with_draws(1000));
  // φ²/2 of a metre with φ anywhere within 0.5 mrad: mean φ²/6, standard deviation φ²/√45, at most
  // φ²/2.
  const DrawnNumber& n = u.places[0].error[0];
  const double square = 0.25e-6 * 1000.0;
  EXPECT_NEAR(n.mean, -square / 6.0, 3.0 * square / std::sqrt(45.0 * 1000.0));
  EXPECT_NEAR(n.deviation, square / std::sqrt(45.0), 0.1 * square / std::sqrt(45.0));
  EXPECT_NEAR(*n.first_order, square / std::sqrt(45.0), 1e-9 * square);
  EXPECT_GT(n.low, -square / 2.0);
  EXPECT_LE(n.high, 0.0);
}

// What is removed from straightness cannot be uncertain in it; what is not removed is.
TEST(WholeWay, SlopeOfTheBeamIsTakenOutOfStraightness) {
  CampaignStatement stated;
  stated.slope_urad = 100.0;
  WholeWaySettings settings = with_draws(200);
  const Task task = places_of_slide({1000.0});
  const RunsFile runs = silent_runs(1);
  for (const DrawnNumber& n : of_slide(runs, stated, task, settings).places[0].error)
    EXPECT_LT(n.deviation, 1e-12);
  settings.build.slope = SlopeFit::keep;
  expect_deviation(of_slide(runs, stated, task, settings).places[0].error[1], 0.1, 200);
}

TEST(WholeWay, GrowthGainsWavesAndRollActOnTheirChannels) {
  constexpr std::size_t kDraws = 300;
  CampaignStatement growth;
  growth.growth_K = 0.1;
  growth.expansion_um_per_m_K = 11.7;
  const Task end = places_of_slide({1000.0});
  expect_deviation(of_slide(silent_runs(1), growth, end, with_draws(kDraws)).places[0].error[0],
                   1.17e-3, kDraws);
  // An angle of 20 µrad at the end, with a lever of 100 mm in Z between reading head and sensed
  // point: a gain of 2 % is 0.4 µrad, and 0.04 µm of position.
  MachineFile machine = one_slide();
  machine.axes[0].sensed.at_zero = Vec3(0.0, 0.0, 100.0);
  const RunsFile pitching = runs_of_slide(1, [](double x) {
    ErrorMotion e = ErrorMotion::Zero();
    e(4) = 2e-8 * x;
    return e;
  });
  CampaignStatement gain;
  gain.angle_gain_percent = 2.0;
  expect_deviation(
      uncertainty_of_task(machine, {pitching}, gain, end, with_draws(kDraws), no_progress)
          .places[0]
          .error[0],
      0.4e-6 * 100.0, kDraws);
  // Roll turns a lever of 100 mm in Z towards Y: 2 µrad over the travel.
  CampaignStatement roll;
  roll.roll_urad = 2.0;
  expect_deviation(
      uncertainty_of_task(machine, {pitching}, roll, end, with_draws(kDraws), no_progress)
          .places[0]
          .error[1],
      2e-6 * 100.0, kDraws);
}

// A campaign with the noise of real instruments: everything on the way is linear but for products
// of small numbers, so draws and propagation agree.
TEST(WholeWay, DrawsAgreeWithFirstOrderOfTheWholeMachine) {
  constexpr std::size_t kDraws = 800;
  const MachineFile file = read_machine_file(bundled_machine("xyfz"));
  const sim::Campaign campaign =
      sim::measure_machine(sim::draw_machine(file, 3), file, {}, 5, {5, 0});
  CampaignStatement stated;
  stated.scale_um_per_m = 0.25;
  stated.straightness_gain_percent = 0.5;
  stated.angle_gain_percent = 0.2;
  stated.roll_urad = 2.0;
  stated.straightness_wave_um = 0.3;
  stated.lever_mm = 2.0;
  stated.squareness_urad = 3.0;
  const Task task = line_task("-500,-300,-400:-50,-30,-40", 3, campaign.machine);
  const TaskUncertainty u = uncertainty_of_task(campaign.machine, campaign.runs, stated, task,
                                                with_draws(kDraws), no_progress);
  for (const PlaceUncertainty& place : u.places) {
    for (const DrawnNumber& n : place.error) {
      ASSERT_TRUE(n.ratio().has_value());
      EXPECT_NEAR(*n.ratio(), 1.0, TaskUncertainty::ratio_band(kDraws));
      EXPECT_LT(std::abs(n.mean - n.nominal),
                (3.0 / std::sqrt(static_cast<double>(kDraws)) + 0.01) * n.deviation);
    }
  }
  EXPECT_THAT(u.drawn_as_zero, Contains("slope of the beam (slope_urad)"));
  EXPECT_THAT(u.drawn_as_zero, testing::Not(Contains(HasSubstr("readings of"))));
}

TEST(WholeWay, ThreadsChangeNothing) {
  const MachineFile machine = one_slide();
  CampaignStatement stated;
  stated.reading_um = 0.7;
  stated.scale_um_per_m = 0.3;
  const std::vector<RunsFile> runs{silent_runs(2)};
  const Task task = places_of_slide({0.0, 300.0, 900.0});
  const auto text = [&](std::size_t threads) {
    WholeWaySettings settings = with_draws(200);
    settings.threads = threads;
    const TaskUncertainty u =
        uncertainty_of_task(machine, runs, stated, task, settings, no_progress);
    return uncertainty_json({"t.vct", 1, machine, runs, stated, task, settings}, u).dump();
  };
  EXPECT_EQ(text(1), text(3));
}

TEST(WholeWay, WhatIsNotKnownIsNamedAndNothingAtAllIsRefused) {
  const Task task = places_of_slide({500.0});
  CampaignStatement stated;
  const auto complaint = [&](const CampaignStatement& s, std::size_t draws) {
    return sim::complaint_of([&] { return of_slide(silent_runs(1), s, task, with_draws(draws)); });
  };
  EXPECT_THAT(complaint(stated, 100), HasSubstr("nothing is uncertain"));
  stated.growth_K = 0.1;
  EXPECT_THAT(complaint(stated, 100), HasSubstr("growth_K needs expansion_um_per_m_K"));
  stated.expansion_um_per_m_K = 11.7;
  EXPECT_THAT(complaint(stated, 99), HasSubstr("99 draws"));
  EXPECT_EQ(complaint(stated, 100), "accepted");
  const TaskUncertainty u = of_slide(silent_runs(1), stated, task, with_draws(100));
  EXPECT_THAT(u.drawn_as_zero,
              Contains(HasSubstr("readings of EXX, EYX, EZX, EAX, EBX, ECX (reading_um")));
  EXPECT_THAT(u.drawn_as_zero, Contains("scale (scale_um_per_m)"));
  stated.squareness_urad = 3.0;
  EXPECT_THAT(complaint(stated, 100), HasSubstr("slide.toml has no [squareness]"));
}

TEST(WholeWay, PlacesBeyondTheTargetsAreNamed) {
  CampaignStatement stated;
  stated.reading_um = 0.7;
  RunsFile runs = silent_runs(1);
  runs.positions.back() = 990.0;
  EXPECT_THAT(of_slide(runs, stated, places_of_slide({500.0, 995.0}), with_draws(100)).remarks,
              Contains(HasSubstr("1 of 2 places are beyond the targets of X")));
}

TEST(ImageOfRuns, MustBeOfTheseRunsAndThisMachine) {
  const MachineFile machine = one_slide();
  const auto slope = [](double per_mm) {
    return runs_of_slide(1, [per_mm](double x) {
      ErrorMotion e = ErrorMotion::Zero();
      e(0) = per_mm * x;
      return e;
    });
  };
  const auto built = build_tables(machine, {slope(1e-6)}, {});
  TableImage image{"t.vct", 0, 0, std::make_unique<MachineTables>(built->tables)};
  const auto complaint = [&](const MachineFile& of, const BuiltTables& tables) {
    return sim::complaint_of([&] {
      require_image_of_runs(image, of, tables);
      return 0;
    });
  };
  image.tables->provenance.built_unix_s = 1'700'000'000;  // when is no matter
  EXPECT_EQ(complaint(machine, *built), "accepted");
  // 3e-6 more of a metre.
  const auto others = build_tables(machine, {slope(4e-6)}, {});
  EXPECT_THAT(
      complaint(machine, *others),
      HasSubstr("t.vct: not made from these runs: the tables of axis X differ by up to 3 um"));
  MachineFile other = machine;
  other.id = 8;
  EXPECT_THAT(complaint(other, *built), HasSubstr("tables of machine 7"));
}

}  // namespace
}  // namespace volcomp::host
