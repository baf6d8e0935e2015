// The simulated L300G: its errors, and what identification finds of them.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/l300g/printed_procedure.hpp"
#include "host_sim/experiments/l300g/traced_grinder.hpp"
#include "host_sim/experiments/l300g/truth.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "tests/complaint.hpp"

namespace volcomp::l300g {
namespace {

const host::MachineFile& file() {
  static const host::MachineFile f = host::read_machine_file(host::bundled_machine("l300g"));
  return f;
}

sim::TrueMachine machine_with(const std::string& errors) {
  return make_l300g_truth(file(), grinder_errors(errors), 1);
}

// At the pitch point of the left flank: arm hardly swung, Y = 231.
Vec3 error_um(const sim::TrueMachine& machine) {
  const Pose q{0.0, 231.0, file().axes[2].reference + 0.02, 0.0};
  return kUmPerMm * machine.error(q, {}, machine.chain.tool_point()).position_work;
}

// To a tenth of a micrometre; 0.02 rad of swing move it by less.
TEST(L300gTruth, P8IsTheErrorOfTheSpecification) {
  const Vec3 e = error_um(machine_with("p8"));
  EXPECT_NEAR(e.x(), -7.7, 0.2);
  EXPECT_NEAR(e.y(), -52.0, 0.2);
  EXPECT_NEAR(e.z(), -8.4, 0.2);
}

TEST(L300gTruth, Table2IsTheErrorOfTheSpecification) {
  const Vec3 e = error_um(machine_with("table2"));
  EXPECT_NEAR(e.x(), 4.1, 0.1);
  EXPECT_NEAR(e.y(), 4.8, 0.1);
  EXPECT_NEAR(e.z(), 6.6, 0.1);
}

TEST(L300gTruth, ASlopeOfATurningAxisReturns) {
  const sim::TrueMachine machine = machine_with("a-slope");
  const auto about_itself = [&](double A) { return machine.errors({0.0, 0.0, 0.0, A}, {})[3](3); };
  for (const double A : {-0.44, -0.1, 0.1, 0.44})
    EXPECT_NEAR(about_itself(A), 8.6e-4 * A, 0.0014 * 8.6e-4 * std::abs(A));
  EXPECT_NEAR(about_itself(0.3 + 2.0 * kPi), about_itself(0.3), 1e-15);
}

TEST(L300gTruth, AFileSaysTheSameAsAName) {
  const sim::TrueMachine by_file =
      make_l300g_truth(file(),
                       parse_grinder_errors("convention = \"relative\"\n"
                                            "[X]\nconstant = [3.8, 0, 0, 0, 0, 0]\n"
                                            "[Y]\nconstant = [0, 4.5, 0, 0, 0, 0]\n"
                                            "[B]\nconstant = [0, 0, 0, 0, 63.7045, 0]\n"
                                            "[A]\nconstant = [0, 0, 0, -72.4312, 0, 0]\n",
                                            "errors.toml"),
                       1);
  EXPECT_LT((error_um(by_file) - error_um(machine_with("table2"))).norm(), 1e-4);
}

TEST(L300gTruth, ABadFileIsRefusedWithItsLine) {
  const auto refusal = [](const std::string& text) {
    return sim::complaint_of([&] { return parse_grinder_errors(text, "errors.toml"); });
  };
  EXPECT_NE(refusal("arm_mm = 0.1\n").find("missing mandatory field 'convention'"),
            std::string::npos);
  EXPECT_EQ(refusal("convention = \"body\"\n[Q]\n").rfind("errors.toml:2: ", 0), 0U);
  EXPECT_EQ(refusal("convention = \"body\"\n[X]\nwave_um = 1.0\n").rfind("errors.toml:3: ", 0), 0U);
  EXPECT_THROW(static_cast<void>(grinder_errors("no-such-file.toml")), host::UserError);
}

sim::TracedErrors traced(const std::string& errors, const sim::TracerScatter& scatter = {true}) {
  return sim::trace_errors(machine_with(errors), file(), traced_plan(), scatter);
}

// All 24 functions and all places: with them the ball is everywhere where the machine really has
// it, and the tool turns as it really does. What is left without noise: of constants what is of
// second order in 70 µrad; of waves what cubic pieces of a third of them leave.
TEST(L300gIdentification, FindsAll24FunctionsWithoutNoise) {
  for (const char* errors : {"p8", "a-slope"}) {
    const sim::TracedErrors found = traced(errors);
    EXPECT_EQ(found.functions.size(), 4U);
    EXPECT_LT(found.largest_mm, 1e-6) << errors;
    EXPECT_LT(found.largest_rad, 2e-8) << errors;
  }
  const sim::TracedErrors found = traced("p8-variation");
  EXPECT_LT(found.rms_mm, 0.1e-3);
  EXPECT_LT(found.largest_mm, 0.25e-3);
  EXPECT_LT(found.largest_rad, 2.5e-6);
}

// docs/papers/l300g.md, eq. 18: the printed equations have rank 3, and their "solution" is the mean
// reading.
TEST(L300gIdentification, PrintedProcedureGivesTheMeanReadingAndNoMore) {
  const PrintedProcedure printed = printed_procedure(machine_with("p8-variation"), file());
  EXPECT_EQ(printed.x.rank, 3);
  EXPECT_NEAR(printed.x.least(0) + printed.x.least(4) - printed.x.least(5), printed.own[0].mean,
              1e-12);
}

TEST(L300gIdentification, ThePlanSeesEverything) {
  // As many unknowns as fit into a test; the kinds of what is asked are those of the plan.
  sim::TracedPlan plan = traced_plan();
  plan.places = 120;
  for (auto& functions : plan.model.functions)
    if (functions.segments > 0) functions.segments = 4;
  EXPECT_EQ(sim::refusal_of(file(), plan), std::vector<std::string>{});
  // From one reflector the turns of what carries it cannot be told from its ways.
  plan.reflectors.clear();
  EXPECT_EQ(sim::refusal_of(file(), plan).front(), "not_observable");
}

// The estimator predicts its own uncertainty: readings and stations that scatter as stated.
TEST(L300gIdentification, ScattersAsItPredicts) {
  constexpr std::uint32_t kDraws = 4;
  double ratio = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const sim::TracedErrors found = traced("p8", {false, 0.1e-3, 5, draw});
    EXPECT_NEAR(found.chi2_over_dof, 1.0, 0.15);
    ratio += std::pow(found.rms_mm / found.u_rms_mm, 2.0) / kDraws;
  }
  EXPECT_NEAR(std::sqrt(ratio), 1.0, 0.5);
}

}  // namespace
}  // namespace volcomp::l300g
