// The whole way from touches to error functions, on machines whose errors are known.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/identification.hpp"
#include "tests/host_sim/host/measure/identify/simulated_plan.hpp"

namespace volcomp::test {
namespace {

void no_progress(double /*done*/, const std::string& /*what*/) {}

Identified identified(const MeasurementPlan& plan) {
  IdentifySettings settings;
  settings.leave_out = false;
  return identify(plan, settings, no_progress);
}

// Largest difference from the truth, over its uncertainty with touches of 0.8 µm.
double largest_miss(const MeasurementPlan& plan, const VectorXd& truth,
                    const std::vector<FoundFunction>& functions) {
  Problem none = plan.problem;
  none.setups.clear();
  const Unknowns unknowns(none, true);
  double largest = 0.0;
  for (const FoundFunction& f : functions)
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      const double wanted = unknowns.value_row(f.quantity, f.at[k])
                                .head(unknowns.of_machine())
                                .dot(truth.head(unknowns.of_machine()));
      largest = std::max(largest, std::abs(f.value[k].value - wanted) / f.value[k].u);
    }
  return largest;
}

TEST(Identification, TouchesOfAMachineInTheBasisGiveItsErrorsExactly) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const Identified found = identified(plan);
  EXPECT_LT(largest_miss(plan, truth, found.functions), 0.01);
  EXPECT_LT(found.consistency.chi2, 1e-2);
  EXPECT_GE(found.refinements, 2);
}

// A fitted centre is off by the radius times how the error changes over the sphere, which no
// residual shows: 13 mm times some 1e-4.
TEST(Identification, CentresThatAreNotRefinedAreOffByTheStrainOverASphere) {
  VectorXd truth;
  MeasurementPlan plan = touched_plan(2, truth);
  const double refined = largest_miss(plan, truth, identified(plan).functions);
  plan.touched.assign(plan.problem.setups.size(), {});
  const Identified found = identified(plan);
  EXPECT_LT(refined, 0.01);
  EXPECT_GT(largest_miss(plan, truth, found.functions), 0.1);
}

TEST(Identification, OrderOfReadingsDoesNotMatter) {
  VectorXd truth;
  MeasurementPlan plan = touched_plan(3, truth);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.5e-3);
  for (host::identify::SetUp& s : plan.problem.setups)
    for (double& y : s.y)
      y += noise(random);
  MeasurementPlan shuffled = plan;
  plan.touched.assign(plan.problem.setups.size(), {});
  shuffled.touched = plan.touched;
  for (host::identify::SetUp& s : shuffled.problem.setups) {
    std::reverse(s.q.begin(), s.q.end());
    std::reverse(s.sphere.begin(), s.sphere.end());
    std::reverse(s.stylus.begin(), s.stylus.end());
    const std::vector<double> y = s.y;
    const std::vector<double> sigma = s.sigma;
    const std::size_t n = s.q.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        s.y[3 * i + k] = y[3 * (n - 1 - i) + k];
        s.sigma[3 * i + k] = sigma[3 * (n - 1 - i) + k];
      }
  }
  std::reverse(shuffled.problem.setups.begin(), shuffled.problem.setups.end());
  const Identified a = identified(plan);
  const Identified b = identified(shuffled);
  for (std::size_t f = 0; f < a.functions.size(); ++f)
    for (std::size_t k = 0; k < a.functions[f].at.size(); ++k) {
      EXPECT_NEAR(a.functions[f].value[k].value, b.functions[f].value[k].value, 1e-10);
      EXPECT_NEAR(a.functions[f].value[k].u, b.functions[f].value[k].u,
                  1e-8 * a.functions[f].value[k].u);
    }
}

// What the tables hold is the error of the machine: at a place between, against the truth.
TEST(Identification, TablesHoldTheErrorsOfTheMachine) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(4, truth);
  const Identified found = identified(plan);
  Problem none = plan.problem;
  none.setups.clear();
  const Unknowns unknowns(none, true);
  const VectorXd x = truth.head(unknowns.size());
  for (std::size_t a = 0; a < 3; ++a) {
    const host::identify::Travel& travel = plan.problem.machine.travel.at(a);
    const ErrorTable& table = *found.tables->refined[a];
    for (const double part : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const double q = travel.lo + part * (travel.hi - travel.lo);
      const ErrorMotion wanted = unknowns.error(a, q, 0.0, x);
      const ErrorMotion held = table.linear(q, volcomp::Travel::unknown);
      // The end of Z, which no ball reaches, is known to 150 µm and 400 µrad only.
      EXPECT_LT((translation(held) - translation(wanted)).norm(), 0.3e-3) << a << ' ' << part;
      EXPECT_LT((rotation(held) - rotation(wanted)).norm(), 1e-6) << a << ' ' << part;
    }
  }
}

TEST(Identification, ABallWithAWrongNumberIsFound) {
  VectorXd truth;
  MeasurementPlan plan = touched_plan(5, truth);
  host::identify::SetUp& s = plan.problem.setups[2];
  std::swap(s.sphere[0], s.sphere[1]);
  try {
    static_cast<void>(identified(plan));
    FAIL() << "not refused";
  } catch (const host::UserError& e) {
    EXPECT_THAT(std::string(e.what()), testing::HasSubstr("of \"placement 3\" fits least"));
  }
}

// Three rows about where the plan has the station, which a test of what readings see leaves out.
TEST(Identification, AStationWhosePlaceIsKnownIsKnownBeforehand) {
  VectorXd truth;
  Problem problem = touched_plan(1, truth).problem;
  problem.setups.clear();
  host::identify::SetUp s;
  s.name = "station";
  s.station = Vec3(-300.0, -100.0, 200.0);
  s.station_prior = 2e-3;
  s.q = {Pose{}};
  s.d = {Directions{}};
  s.sigma = {1e-4};
  problem.setups.push_back(s);
  const Equations equations(problem, true);
  Estimate e = equations.start();
  const Index station = equations.unknowns().local(0);
  e.x(station + 1) += 1e-3;
  const auto rows_of_station = [&](bool places) {
    std::vector<double> residuals;
    KnownBefore known;
    known.places = places;
    equations.visit_known(e, known, [&](const VectorXd& row, double residual) {
      if (row.segment<3>(station).norm() > 0.0) residuals.push_back(residual);
    });
    return residuals;
  };
  EXPECT_THAT(rows_of_station(true),
              testing::ElementsAre(testing::DoubleNear(0.0, 1e-12), testing::DoubleNear(-0.5, 1e-9),
                                   testing::DoubleNear(0.0, 1e-12)));
  EXPECT_TRUE(rows_of_station(false).empty());
}

// The table goes by −X in the base: a beam along X reads a way of 100 mm by 100 mm · 3e-6 longer
// where X has grown by 3e-6, and nothing of the growth of Y and Z.
TEST(Identification, AGrownAxisReadsLongerByItsWay) {
  Problem problem = empty_plan().problem;
  host::identify::SetUp s;
  s.name = "beam";
  s.kind = ObservationKind::diagonal;
  s.along = Vec3::UnitX();
  s.growth = 1e-6;
  s.q = {Pose{}, Pose{-100.0}};
  s.d = {Directions{}, Directions{}};
  s.sigma = {1.0, 1.0};
  problem.setups.push_back(s);
  const Equations equations(problem, true);
  const Unknowns& unknowns = equations.unknowns();
  const Index x = unknowns.setup_growth(0, 0).value();
  Estimate e = equations.start();
  const auto read = [&] {
    std::vector<double> residual;
    std::vector<double> slope;
    equations.visit_readings(e, [&](const ReadingPlace&, const VectorXd& row, double r) {
      residual.push_back(r);
      slope.push_back(row(x));
      EXPECT_EQ(row(unknowns.setup_growth(0, 1).value()), 0.0);
      EXPECT_EQ(row(unknowns.setup_growth(0, 2).value()), 0.0);
    });
    return std::array<double, 2>{residual[0] - residual[1], slope[1] - slope[0]};
  };
  const auto [as_cold, slope] = read();
  EXPECT_NEAR(std::abs(slope), 100.0, 1e-6);
  e.x(x) = 3e-6;
  EXPECT_NEAR(read()[0] - as_cold, slope * 3e-6, 1e-9);
}

}  // namespace
}  // namespace volcomp::test
