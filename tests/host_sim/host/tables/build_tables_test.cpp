// From run files to tables: a known error put in must come out, and wrong combinations of files are
// refused.

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/tables/image.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

class Commissioning : public testing::Test {
 protected:
  MachineFile file = read_machine_file(bundled_machine("xyfz"));
  sim::TrueMachine truth = sim::draw_machine(file, 3);
  sim::Campaign campaign = sim::perfect_campaign(truth, file);

  std::string refusal(const std::vector<RunsFile>& runs) const {
    return sim::complaint_of([&] { return build_tables(file, runs, {}); });
  }
};

// Without noise, the model of the tables is the machine up to a rigid motion on the knots (which no
// diagonal sees), second-order terms and the resolution of the instrument.
TEST_F(Commissioning, TablesReproduceTheMachineOnTheKnots) {
  const auto tables =
      build_tables(campaign.machine, campaign.runs, {ModelKind::abbe_closed, SlopeFit::keep});
  const auto difference = [&](const Vec3& p) -> Vec3 {
    const Pose q{p.x(), p.y(), p.z()};
    return truth.error(q, {}, truth.chain.tool_point()).position_work -
           tables->model.first_order(q, kUnknownTravels, Beyond::stand_at_end);
  };
  const Vec3 zero = difference(Vec3::Zero());
  // Slopes not removed: nothing rigid is lost, so only a constant remains.
  for (const Vec3& p :
       {Vec3(-500, -300, -400), Vec3(-250, -150, -200), Vec3(0, -300, -40), Vec3(-450, 0, -360)}) {
    EXPECT_LT((difference(p) - zero).norm(), 0.3e-3) << p.x() << ' ' << p.y() << ' ' << p.z();
  }
}

TEST_F(Commissioning, ImageOfTheTablesDecodesToTheSameTables) {
  const auto tables = build_tables(campaign.machine, campaign.runs, {});
  const std::vector<std::uint8_t> image = make_image(tables->tables);
  const auto decoded = std::make_unique<MachineTables>();
  ASSERT_TRUE(decode_image(image, 128, *decoded).ok());
  EXPECT_EQ(decoded->provenance.machine_id, 1001U);
  EXPECT_EQ(make_image(*decoded), image);
}

TEST_F(Commissioning, BoundOfTheModelIsExtraWorkThatChangesNoTable) {
  const auto full = build_tables(campaign.machine, campaign.runs, {ModelKind::abbe_closed});
  const auto quick =
      build_tables(campaign.machine, campaign.runs, tables_only(ModelKind::abbe_closed));
  EXPECT_GT(full->model_bound_nm, 0.0);
  EXPECT_DOUBLE_EQ(quick->model_bound_nm, 0.0);
  EXPECT_EQ(make_image(quick->tables), make_image(full->tables));
}

TEST_F(Commissioning, EveryAxisNeedsExactlyOneFile) {
  EXPECT_THAT(refusal({campaign.runs[0], campaign.runs[1]}),
              testing::HasSubstr("no runs given for axis Z"));
  EXPECT_THAT(refusal({campaign.runs[0], campaign.runs[0], campaign.runs[1], campaign.runs[2]}),
              testing::HasSubstr("both hold axis X"));
}

TEST_F(Commissioning, ReferenceMustBeATarget) {
  file.axes[1].reference = -15.0;
  EXPECT_THAT(refusal(campaign.runs), testing::HasSubstr("reference_out_of_range"));
}

TEST_F(Commissioning, WarningsAreSaidWithTheFile) {
  auto runs = campaign.runs;
  runs[2].down.clear();
  const auto tables = build_tables(file, runs, {});
  EXPECT_THAT(tables->warnings,
              testing::ElementsAre(testing::AllOf(
                  testing::StartsWith("runs_Z.csv: Z was measured in one direction only"),
                  testing::EndsWith("[one_direction]"))));
}

// As a person would look it up: which column of the header, at which position, in which run.
TEST_F(Commissioning, AnOutlierIsSaidWithItsColumnPositionAndValue) {
  auto runs = campaign.runs;
  runs[0].up.assign(5, runs[0].up[0]);
  for (std::size_t r = 0; r < 5; ++r) {
    for (ErrorMotion& e : runs[0].up[r])
      e(1) += 1e-6 * static_cast<double>(r);
  }
  runs[0].down.clear();
  std::reverse(runs[0].positions.begin(), runs[0].positions.end());
  for (RunValues& run : runs[0].up)
    std::reverse(run.begin(), run.end());
  runs[0].up[3][2](1) += 0.030;
  const auto tables = build_tables(file, runs, tables_only(ModelKind::abbe_closed));
  EXPECT_THAT(
      tables->warnings,
      testing::Contains(testing::AllOf(
          testing::StartsWith("runs_X.csv: EYX at " + fmt::format("{:g}", runs[0].positions[2]) +
                              " mm, run 4 up, is "),
          testing::HasSubstr(" um instead of "), testing::EndsWith("[outlier]"))));
}

// The same runs as they come from a file: its lines 2 … are the readings in the order of writing.
TEST_F(Commissioning, WhatIsSaidOfAReadingNamesItsLine) {
  const auto from_file = [](const RunsFile& runs) {
    std::istringstream text(runs_csv(runs));
    return read_runs(text, runs.name);
  };
  RunsFile x = campaign.runs[0];
  x.up.assign(5, x.up[0]);
  x.down.clear();
  const std::size_t targets = x.positions.size();
  const auto with_x = [&] {
    return std::vector<RunsFile>{from_file(x), campaign.runs[1], campaign.runs[2]};
  };
  x.up[3][2](1) += 0.030;
  const std::string line = fmt::format("runs_X.csv:{}: ", 2 + 3 * targets + 2);
  EXPECT_THAT(build_tables(file, with_x(), {})->warnings,
              testing::Contains(testing::AllOf(testing::StartsWith(line + "EYX at "),
                                               testing::EndsWith("[outlier]"))));
  x.up[3][2](1) = 3.0;
  EXPECT_THAT(refusal(with_x()),
              testing::AllOf(testing::StartsWith(line), testing::HasSubstr("EYX"),
                             testing::EndsWith("[unit_suspected]")));
  x.up[3][2](1) = std::nan("");
  EXPECT_THAT(refusal(with_x()), testing::StartsWith(line));
}

TEST_F(Commissioning, ASlopeAndAJumpAreSaidWithColumnAndSize) {
  auto runs = campaign.runs;
  runs[0].up.resize(1);
  runs[0].down.clear();
  for (std::size_t t = 0; t < runs[0].positions.size(); ++t)
    runs[0].up[0][t](2) = 400e-6 * runs[0].positions[t];
  const double from = runs[1].positions[3];
  const double to = runs[1].positions[4];
  for (RunValues* const run : {&runs[1].up[0], &runs[1].down[0]}) {
    for (std::size_t t = 4; t < run->size(); ++t)
      (*run)[t](1) += 0.050;
  }
  const auto tables = build_tables(file, runs, {});
  EXPECT_THAT(tables->warnings,
              testing::Contains("runs_X.csv: EZX has a slope of 400 urad, steep for a straightness "
                                "[steep_slope]"));
  EXPECT_THAT(tables->warnings,
              testing::Contains(
                  testing::AllOf(testing::StartsWith("runs_Y.csv: EYY jumps by "),
                                 testing::EndsWith(fmt::format(
                                     " um between {:g} mm and {:g} mm [knot_jump]", from, to)))));
}

// 26 urad over 500 mm are 13 um; without the squareness of the machine nothing corrects them.
TEST_F(Commissioning, WithoutSquarenessWhatIsNotCorrectedIsSaid) {
  file.squareness.reset();
  auto runs = campaign.runs;
  for (auto* const direction : {&runs[0].up, &runs[0].down}) {
    for (RunValues& run : *direction) {
      for (std::size_t t = 0; t < run.size(); ++t)
        run[t](1) = 26e-6 * runs[0].positions[t];
    }
  }
  const auto tables = build_tables(file, runs, tables_only(ModelKind::abbe_closed));
  EXPECT_THAT(tables->warnings,
              testing::Contains(testing::HasSubstr(
                  "there is no [squareness]: X, Y and Z are taken as square to each other")));
  EXPECT_THAT(tables->warnings,
              testing::Contains(testing::HasSubstr("a slope of 26.0 urad was removed from EYX, "
                                                   "which is -13.0 um at -500 mm")));
}

TEST_F(Commissioning, WithSquarenessTheSlopesBelongToIt) {
  EXPECT_THAT(build_tables(file, campaign.runs, tables_only(ModelKind::abbe_closed))->warnings,
              testing::Not(testing::Contains(testing::HasSubstr("slope"))));
}

// Half the numbers of a wrong unit would pass as a short travel.
TEST_F(Commissioning, TargetsMustBeThoseOfTheTravel) {
  const auto scaled = [&](double factor) {
    auto runs = campaign.runs;
    for (double& q : runs[0].positions)
      q *= factor;
    return runs;
  };
  EXPECT_EQ(refusal(scaled(1.0)), "accepted");
  EXPECT_THAT(refusal(scaled(8.0)),
              testing::HasSubstr("travels from -500 to 0 mm [unit_suspected]"));
  EXPECT_THAT(refusal(scaled(1e-3)),
              testing::HasSubstr("runs_X.csv: targets of X from -0.5 to 0,"));
  const auto half = build_tables(file, scaled(0.5), tables_only(ModelKind::abbe_closed));
  EXPECT_THAT(half->warnings,
              testing::Contains(testing::HasSubstr("beyond them the value of the end is used")));
}

TEST_F(Commissioning, AxesThatCannotCorrectAreRefused) {
  MachineDescription d = file.chain.description();
  d.body[2].joint.axis = d.body[1].joint.axis;
  ASSERT_TRUE(MachineChain::build(d, file.chain).ok());
  EXPECT_THAT(refusal(campaign.runs), testing::HasSubstr("[no_authority]"));
}

TEST_F(Commissioning, WhatNoNodeTakesIsRefused) {
  file.axes[1].at_reference(0) = 100.0;
  EXPECT_THAT(refusal(campaign.runs), testing::HasSubstr("bound"));
}

// Machines with the same axes in other places have no naive model.
TEST_F(Commissioning, TheNaiveModelIsOfItsMachineOnly) {
  const auto complaint = [&] {
    return sim::complaint_of(
        [&] { return build_tables(file, campaign.runs, tables_only(ModelKind::naive)); });
  };
  EXPECT_EQ(complaint(), "accepted");
  MachineDescription d = file.chain.description();
  d.body[1].joint.sign = static_cast<std::int8_t>(-d.body[1].joint.sign);
  ASSERT_TRUE(MachineChain::build(d, file.chain).ok());
  EXPECT_THAT(complaint(), testing::HasSubstr("the naive model is that of a machine with"));
}

// A machine whose C turns once round, measured perfectly, but for what drifts while C turns.
class FullTurn : public testing::Test {
 protected:
  static constexpr std::size_t kC = 4;

  std::unique_ptr<BuiltTables> build_with(const ErrorMotion& drift) {
    sim::Campaign drifting = campaign;
    for (RunValues& run : drifting.runs[kC].up)
      add(drift, run);
    for (RunValues& run : drifting.runs[kC].down) {
      std::reverse(run.begin(), run.end());
      add(drift, run);
      std::reverse(run.begin(), run.end());
    }
    return build_tables(campaign.machine, drifting.runs, tables_only(ModelKind::abbe_closed));
  }

  MachineFile file = read_machine_file(bundled_machine("trunnion"));
  sim::Campaign campaign =
      sim::measure_any_machine(sim::draw_machine(file, 1), file, sim::no_noise(), 1, {});

 private:
  static void add(const ErrorMotion& drift, RunValues& run) {
    for (std::size_t t = 0; t < run.size(); ++t)
      run[t] += static_cast<double>(t) / static_cast<double>(run.size() - 1) * drift;
  }
};

// But for a constant of each direction: a reversal looks the same.
TEST_F(FullTurn, DriftThatGrowsEvenlyIsNoError) {
  ErrorMotion drift;
  drift << 3e-3, -2e-3, 1e-3, 4e-6, -5e-6, 30e-6;
  const auto still = build_with(ErrorMotion::Zero());
  const auto drifted = build_with(drift);
  ASSERT_TRUE(drifted->gaps[kC]);
  EXPECT_FALSE(drifted->gaps[0]) << "a slide does not turn";
  EXPECT_NEAR(still->gaps[kC]->mm, 0.0, 1e-12);
  EXPECT_NEAR(drifted->gaps[kC]->mm, 3e-3, 1e-12);
  EXPECT_NEAR(drifted->gaps[kC]->rad, 30e-6, 1e-12);
  const auto shape = [&](const BuiltTables& tables, std::size_t i, Travel travel) {
    const ErrorTable& table = *tables.refined[kC];
    return ErrorMotion(table.at_knot(i, travel) - table.at_knot(0, travel));
  };
  for (std::size_t i = 0; i < still->refined[kC]->knots; ++i) {
    for (const Travel travel : {Travel::forward, Travel::backward}) {
      const ErrorMotion difference = shape(*drifted, i, travel) - shape(*still, i, travel);
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12) << i;
    }
  }
}

TEST_F(FullTurn, ATargetLeftOutIsSaid) {
  RunsFile& runs = campaign.runs[kC];
  runs.positions.pop_back();
  runs.up[0].pop_back();
  runs.down[0].pop_back();
  const auto tables = build_with(ErrorMotion::Zero());
  EXPECT_FALSE(tables->gaps[kC]);
  EXPECT_THAT(tables->warnings, testing::ElementsAre(testing::HasSubstr(
                                    "runs_C.csv: C turns once round, but its targets do not")));
}

TEST_F(FullTurn, EndsFartherApartThanDriftExplainsAreRefused) {
  const auto complaint = [&](Eigen::Index channel, double drift) {
    return sim::complaint_of([&] { build_with(drift * ErrorMotion::Unit(channel)); });
  };
  EXPECT_EQ(complaint(2, 4.9e-3), "accepted");
  EXPECT_THAT(complaint(2, 5.1e-3), testing::HasSubstr("runs_C.csv: the ends of the turn of C"));
  EXPECT_EQ(complaint(5, 49e-6), "accepted");
  EXPECT_THAT(complaint(5, 51e-6), testing::HasSubstr("[not_periodic]"));
}

}  // namespace
}  // namespace volcomp::host
