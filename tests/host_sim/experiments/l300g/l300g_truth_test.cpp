// The simulated L300G: its errors, and what identification finds of them.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/l300g/printed_procedure.hpp"
#include "host_sim/experiments/l300g/truth.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/campaign/identification.hpp"
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

// The fit is repeated, so that nothing of second order is left either.
TEST(L300gIdentification, FindsAll24FunctionsWithoutNoise) {
  for (const char* errors : {"p8", "p8-variation", "a-slope"}) {
    const sim::Identification found = sim::identify_axes(machine_with(errors), file());
    ASSERT_EQ(found.found.axis.size(), 4U);
    EXPECT_LT(found.max_error(), 1e-9) << errors;
  }
}

// docs/papers/l300g.md, eq. 18: the printed equations have rank 3, and their "solution" is the mean
// reading.
TEST(L300gIdentification, PrintedProcedureGivesTheMeanReadingAndNoMore) {
  const sim::Identification found = sim::identify_axes(machine_with("p8-variation"), file());
  const PrintedProcedure printed = printed_procedure(found, file());
  EXPECT_EQ(printed.x.rank, 3);
  EXPECT_NEAR(printed.x.least(0) + printed.x.least(4) - printed.x.least(5), printed.own[0].mean,
              1e-12);
}

// Targets across the lever keep the noise down; all six unknowns alike.
TEST(L300gIdentification, TargetsAreWellConditioned) {
  const sim::Identification found = sim::identify_axes(machine_with("none"), file());
  EXPECT_LT(found.found.condition, 30.0);
  EXPECT_LT(found.found.spread.head<3>().maxCoeff(), host::kTracker_mm);
}

// Six targets, two at ± 150 mm on every axis of the body, each coordinate read with σ: translations
// have σ/√6, and four targets with a lever make σ/(2 · 150 mm) of an angle. Of the first axis,
// which inherits nothing.
TEST(L300gIdentification, ScattersAsItsTargetsDo) {
  constexpr double kSigma = 1e-3;
  constexpr std::uint32_t kDraws = 100;
  const sim::TrueMachine machine = machine_with("none");
  ErrorMotion squares = ErrorMotion::Zero();
  double count = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const sim::Identification found = sim::identify_axes(machine, file(), {kSigma, 5, draw});
    for (const ErrorMotion& e : found.found.axis[0].motion) {
      squares += e.cwiseAbs2();
      count += 1.0;
    }
  }
  const ErrorMotion spread = (squares / count).cwiseSqrt();
  for (Eigen::Index c = 0; c < 3; ++c) {
    EXPECT_NEAR(spread(c), kSigma / std::sqrt(6.0), 0.1 * kSigma / std::sqrt(6.0)) << c;
    EXPECT_NEAR(spread(c + 3), kSigma / 300.0, 0.1 * kSigma / 300.0) << c;
  }
}

}  // namespace
}  // namespace volcomp::l300g
