// What goes wrong in a measurement is found and named, or does no harm, or can be found by nothing:
// then the plan has to state it.

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/identification.hpp"
#include "tests/host_sim/host/measure/identify/simulated_plan.hpp"

namespace volcomp::test {
namespace {

using Readings = host::identify::SetUp;  // gtest has a SetUp of its own
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

constexpr double kSigma_mm = 0.8e-3;

Identified identified(const MeasurementPlan& plan) {
  IdentifySettings settings;
  settings.leave_out = false;
  return identify(plan, settings, [](double /*done*/, const std::string& /*what*/) {});
}

// Why a plan is refused; empty where it is not.
std::string refusal_of(const MeasurementPlan& plan) {
  try {
    static_cast<void>(identified(plan));
  } catch (const host::UserError& e) {
    return e.what();
  }
  return {};
}

// As a machine with these errors has touched the balls with what was really there, `touched`, while
// the plan states what it states.
void touch_all(MeasurementPlan& plan, const Problem& touched, const VectorXd& truth,
               ObservationKind kind = ObservationKind::centre) {
  const Unknowns unknowns(touched, true);
  for (const Placement& pose : placements()) {
    Readings setup;
    setup.name = "placement " + std::to_string(plan.problem.setups.size() + 1);
    setup.kind = kind;
    setup.artefact = 0;
    setup.pose = pose;
    plan.touched.emplace_back();
    const std::vector<TipTouch> touches = touches_of(touched, unknowns, truth, pose);
    if (kind == ObservationKind::centre)
      add_centres(plan, "touches.csv", touches, kSigma_mm, setup);
    else
      add_single_touches(touches, kSigma_mm, setup);
    plan.problem.setups.push_back(setup);
  }
}

VectorXd errors_of(const MeasurementPlan& plan, unsigned seed) {
  return some_errors(Unknowns(plan.problem, true), seed);
}

// Largest difference of two estimates, over the uncertainty.
double largest_difference(const Identified& a, const Identified& b) {
  double largest = 0.0;
  for (std::size_t f = 0; f < a.functions.size(); ++f)
    for (std::size_t k = 0; k < a.functions[f].at.size(); ++k)
      largest = std::max(largest,
                         std::abs(a.functions[f].value[k].value - b.functions[f].value[k].value) /
                             a.functions[f].value[k].u);
  return largest;
}

// Lengths from a station, by the ideal machine, over its travels.
Readings tracer_of(const Problem& problem) {
  Readings s;
  s.name = "tracer";
  s.kind = ObservationKind::tracer;
  s.station = Vec3(600.0, -500.0, 100.0);
  for (int i = 0; i < 27; ++i) {
    Pose q{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& travel = problem.machine.travel.at(a);
      const int step = a == 0 ? i % 3 : a == 1 ? i / 3 % 3 : i / 9;
      q.at(a) = travel.lo + (0.1 + 0.4 * step) * (travel.hi - travel.lo);
    }
    s.q.push_back(q);
    const Vec3 tip =
        ideal_geometry(problem.machine.chain, q).in_work(problem.machine.chain.tool_point());
    s.y.push_back((tip - *s.station).norm());
  }
  s.d.assign(s.q.size(), {});
  s.sigma.assign(s.q.size(), kSigma_mm);
  return s;
}

// Turns of Z and the yaw of Y act on one tip as displacements alone: right for this tool, wrong for
// one of another length.
TEST(WrongThings, WithOneStylusOnlyWhatIsUnseenIsNamed) {
  MeasurementPlan plan = empty_plan();
  plan.problem.styli.resize(1);
  const VectorXd truth = errors_of(plan, 1);
  touch_all(plan, plan.problem, truth);
  EXPECT_THAT(rank_of(plan.problem).unseen,
              UnorderedElementsAre("EXZ", "EYZ", "EZZ", "EAZ", "EBZ", "ECZ", "EZX", "EZY", "EXY",
                                   "EYY", "ECY", "EYX"));
  EXPECT_THAT(refusal_of(plan), AllOf(HasSubstr("[not_observable]"), HasSubstr("EAZ"),
                                      HasSubstr("EBZ"), HasSubstr("ECZ"), HasSubstr("ECY")));
}

// Half a millimetre where a tenth was stated: the readings know the tip far better than what was
// stated of it, so the errors are right all the same. Chi-square does not show it, being off in one
// row of thousands; the correction of the tip does.
TEST(WrongThings, AStylusOfAWrongLengthDoesNotChangeTheErrors) {
  MeasurementPlan good = empty_plan();
  MeasurementPlan plan = good;
  const VectorXd truth = errors_of(plan, 2);
  touch_all(good, good.problem, truth);
  Problem touched = plan.problem;
  touched.styli[3].offset.z() -= 0.5;
  touch_all(plan, touched, truth);
  const Identified found = identified(plan);
  EXPECT_LT(largest_difference(found, identified(good)), 0.2);
  EXPECT_TRUE(found.consistency.good());

  const Equations equations(plan.problem, true);
  const Solution solution = solve(equations, false);
  const Index tip = *equations.unknowns().stylus(3);
  EXPECT_NEAR(solution.estimate.x(tip + 2), -0.5, 0.01);
  EXPECT_GT(-solution.estimate.x(tip + 2), 4.0 * *plan.problem.styli[3].place);
}

// Readings of one set-up a thousand times too small or too large: the first that cannot be is
// named.
TEST(WrongThings, ReadingsInAWrongUnitAreSuspected) {
  MeasurementPlan plan = empty_plan();
  touch_all(plan, plan.problem, errors_of(plan, 3));
  plan.touched.emplace_back();
  plan.problem.setups.push_back(tracer_of(plan.problem));
  EXPECT_TRUE(check_problem(plan.problem).ok());
  for (const double factor : {1e-3, 1e3}) {
    MeasurementPlan wrong = plan;
    for (double& length : wrong.problem.setups.back().y)
      length *= factor;
    const Refusal refusal = check_problem(wrong.problem);
    EXPECT_EQ(refusal.reason, Reason::unit_suspected);
    EXPECT_EQ(refusal.setup, "tracer");
    EXPECT_TRUE(refusal.index);
    EXPECT_THAT(refusal_of(wrong), HasSubstr("set-up \"tracer\", observation "));
  }
}

// Positions of touches have nothing beside them that could be compared: the centre follows from
// them. The balls of the artefact do not fit any more.
TEST(WrongThings, PositionsOfTouchesInAWrongUnitAreRefused) {
  MeasurementPlan plan = empty_plan();
  const VectorXd truth = errors_of(plan, 4);
  touch_all(plan, plan.problem, truth);
  const MeasurementPlan empty = empty_plan();
  const Unknowns unknowns(empty.problem, true);
  std::vector<TipTouch> touches = touches_of(plan.problem, unknowns, truth, placements().front());
  for (TipTouch& touch : touches)
    for (double& q : touch.q)
      q *= 1e-3;
  Readings wrong = plan.problem.setups.front();
  wrong.q.clear();
  wrong.d.clear();
  wrong.y.clear();
  wrong.sigma.clear();
  wrong.sphere.clear();
  wrong.stylus.clear();
  plan.touched.front().clear();
  MeasurementPlan scratch = empty_plan();
  scratch.touched.emplace_back();
  add_centres(scratch, "touches.csv", touches, kSigma_mm, wrong);
  plan.problem.setups.front() = wrong;
  EXPECT_THAT(refusal_of(plan), HasSubstr("\"placement 1\""));
}

// The same touches in a table twice are one observation of a ball, not two.
TEST(WrongThings, TouchesThatComeTwiceAreOneCentre) {
  MeasurementPlan plan = empty_plan();
  const VectorXd truth = errors_of(plan, 5);
  const Unknowns unknowns(plan.problem, true);
  std::vector<TipTouch> touches = touches_of(plan.problem, unknowns, truth, placements().front());
  Readings once, twice;
  plan.touched.resize(1);
  add_centres(plan, "touches.csv", touches, kSigma_mm, once);
  touches.insert(touches.end(), touches.begin(), touches.end());
  add_centres(plan, "touches.csv", touches, kSigma_mm, twice);
  ASSERT_EQ(once.q.size(), twice.q.size());
  for (std::size_t n = 0; n < once.y.size(); ++n)
    EXPECT_NEAR(once.y[n], twice.y[n], 1e-9);
}

// A ball counted twice: the numbers of all after it are one too high.
TEST(WrongThings, ABallCountedTwiceIsFoundByItsSetUp) {
  MeasurementPlan plan = empty_plan();
  touch_all(plan, plan.problem, errors_of(plan, 6));
  for (std::size_t& sphere : plan.problem.setups[4].sphere)
    if (sphere >= 4 && sphere < 8) ++sphere;
  EXPECT_THAT(refusal_of(plan), HasSubstr("\"placement 5\""));
}

// With compensation on the machine shows what is left of its errors: small ones, and no reading
// contradicts another.
TEST(WrongThings, CompensationLeftOnIsShownByNoReading) {
  MeasurementPlan plan = empty_plan();
  const VectorXd left = 0.02 * errors_of(plan, 7);
  touch_all(plan, plan.problem, left);
  const Identified found = identified(plan);
  EXPECT_TRUE(found.consistency.good());
  for (const FoundFunction& f : found.functions)
    for (const Measured& v : f.value)
      EXPECT_LT(std::abs(v.value), f.quantity.angular() ? 5e-6 : 3e-3) << f.quantity.name;
}

// Therefore a plan states whether it was off, and with tables at work positions must be those of
// the encoders, which hold what the tables added.
TEST(WrongThings, APlanStatesWhatWasCompensated) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "volcomp_stated_off.toml";
  const auto refused = [&](const std::string& positions, const std::string& compensation) {
    std::ofstream(path) << "positions = \"" << positions << "\"\n"
                        << compensation << "temperature_C = 20.0\n";
    try {
      static_cast<void>(read_plan(path));
    } catch (const host::UserError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  for (const char* const positions : {"actual", "command"}) {
    EXPECT_THAT(refused(positions, "compensation = \"on\"\n"),
                HasSubstr(":2: 'compensation' must be \"off\" or the CRC-32"));
    EXPECT_THAT(refused(positions, "compensation = false\n"), HasSubstr("'compensation'"));
    EXPECT_THAT(refused(positions, ""),
                AllOf(HasSubstr("'compensation'"), HasSubstr("[missing_field]")));
    EXPECT_THAT(refused(positions, "compensation = \"off\"\n"), Not(HasSubstr("compensation")));
  }
  EXPECT_THAT(refused("command", "compensation = \"1234ABCD\"\n"),
              HasSubstr("compensation switched off"));
  EXPECT_THAT(refused("actual", "compensation = \"1234ABCD\"\n"), Not(HasSubstr("compensation")));
  std::filesystem::remove(path);
}

// The radius of a fitted sphere is free: the same touches 20 µm farther out have the same centres.
TEST(WrongThings, ARadiusOfTheProbeDoesNotMatterToCentres) {
  MeasurementPlan good = empty_plan();
  MeasurementPlan plan = good;
  const VectorXd truth = errors_of(plan, 8);
  touch_all(good, good.problem, truth);
  Problem touched = plan.problem;
  for (Stylus& stylus : touched.styli)
    stylus.radius += 20e-3;
  touch_all(plan, touched, truth);
  EXPECT_LT(largest_difference(identified(plan), identified(good)), 0.01);
}

TEST(WrongThings, ARadiusOfTheProbeContradictsSingleTouches) {
  MeasurementPlan plan = empty_plan();
  const VectorXd truth = errors_of(plan, 9);
  Problem touched = plan.problem;
  for (Stylus& stylus : touched.styli)
    stylus.radius += 20e-3;
  touch_all(plan, touched, truth, ObservationKind::touch);
  EXPECT_THAT(refusal_of(plan), HasSubstr("[contradictory]"));
}

// Where the plan says how well it is known it is an unknown like the others.
TEST(WrongThings, ARadiusOfTheProbeThatIsAskedForIsFound) {
  MeasurementPlan plan = empty_plan();
  const VectorXd truth = errors_of(plan, 10);
  Problem touched = plan.problem;
  for (Stylus& stylus : touched.styli)
    stylus.radius += 20e-3;
  for (Stylus& stylus : plan.problem.styli)
    stylus.radius_prior = 50e-3;
  touch_all(plan, touched, truth, ObservationKind::touch);
  EXPECT_TRUE(check_problem(plan.problem).ok());
  const Equations equations(plan.problem, true);
  const Solution solution = solve(equations, false);
  EXPECT_TRUE(check_solution(solution).ok());
  for (std::size_t s = 0; s < plan.problem.styli.size(); ++s)
    EXPECT_NEAR(solution.estimate.x(*equations.unknowns().stylus_radius(s)), 20e-3, 0.2e-3);
}

}  // namespace
}  // namespace volcomp::test
