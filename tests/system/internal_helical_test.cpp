// Internal helical grinding over 16 seeds against the ranges for the gear of
// docs/papers/internal-helical.md, and the ways to learn that must come out worse.

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/report.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/tables/learned_files.hpp"
#include "tests/oracle/controller_tables.hpp"

namespace volcomp::sim {
namespace {

internal_helical::InternalHelicalResult run(internal_helical::LearningWay way, int seeds,
                                            int updates = internal_helical::kLearningUpdates,
                                            std::size_t threads = host::processors()) {
  internal_helical::InternalHelicalOptions options;
  options.machine = host::bundled_machine("internal_grinder");
  options.way = way;
  options.seeds = seeds;
  options.updates = updates;
  options.threads = threads;
  return internal_helical::run_internal_helical(options, [](double, const std::string&) {});
}

const internal_helical::InternalHelicalResult& right_way() {
  static const internal_helical::InternalHelicalResult result =
      run(internal_helical::LearningWay::right, 16);
  return result;
}

TEST(InternalHelical, MediansOfSixteenSeedsLieInTheSpecifiedRanges) {
  for (const internal_helical::HelicalMeasure& m :
       internal_helical::helical_measures(right_way())) {
    EXPECT_TRUE(m.ok()) << m.name << ' ' << m.side << (m.after ? " after: " : " before: ")
                        << m.found.median << " um";
  }
  EXPECT_TRUE(internal_helical::internal_helical_verdict(right_way()).ok);
}

TEST(InternalHelical, AnyNumberOfThreadsGivesTheSameFigures) {
  const auto figures = [](std::size_t threads) {
    return internal_helical::internal_helical_figures(
               run(internal_helical::LearningWay::right, 3, 1, threads), {})
        .dump();
  };
  EXPECT_EQ(figures(1), figures(3));
}

TEST(InternalHelical, SynchronisationErrorFallsByFiveInSixUpdates) {
  for (const internal_helical::SeedResult& seed : right_way().seed)
    EXPECT_GT(seed.before.sync_rms_um, 5.0 * seed.after.sync_rms_um);
  EXPECT_NEAR(internal_helical::sync_spread(right_way(), false).median, 3.1, 0.15);
  EXPECT_NEAR(internal_helical::sync_spread(right_way(), true).median, 0.47, 0.05);
}

// A controller that is corrected well still shows the lag (docs/papers/internal-helical.md, "What
// we do").
TEST(InternalHelical, TheLagOfZStays) {
  for (const internal_helical::SeedResult& seed : right_way().seed) {
    EXPECT_NEAR(seed.before.z_peak_mm, 0.170, 0.001);
    EXPECT_NEAR(seed.after.z_peak_mm, 0.170, 0.001);
  }
  EXPECT_NEAR(right_way().lags.z_um, -39.1, 0.1);
  EXPECT_NEAR(right_way().lags.together_um, 1.38, 0.01);
}

TEST(InternalHelical, GeometryHoldsAgainstTheExactEnvelope) {
  EXPECT_LT(right_way().geometry.regenerated_nm, 1.0);
  EXPECT_LE(right_way().geometry.single_nm, 5.0);
  EXPECT_LE(right_way().geometry.all_nm, 10.0);
}

TEST(InternalHelical, LearningCAloneBreaksTheHelix) {
  const internal_helical::WrongWay wrong =
      internal_helical::wrong_way(run(internal_helical::LearningWay::c_alone, 3));
  EXPECT_GT(wrong.found, 80.0);
  EXPECT_TRUE(wrong.beyond());
}

TEST(InternalHelical, OneTableForBothDirectionsKeepsTheLag) {
  const internal_helical::InternalHelicalResult result =
      run(internal_helical::LearningWay::one_table, 3);
  EXPECT_GT(internal_helical::wrong_way(result).found, 1.2);
  EXPECT_FALSE(internal_helical::internal_helical_verdict(result).ok);
}

TEST(InternalHelical, NodesOfAMillimetreMissTheRipple) {
  EXPECT_GT(internal_helical::wrong_way(run(internal_helical::LearningWay::coarse, 3)).found, 9.5);
}

TEST(InternalHelical, TheSameSeedIsTheSameGear) {
  const internal_helical::InternalHelicalResult again =
      run(internal_helical::LearningWay::right, 1);
  EXPECT_EQ(again.seed[0].learning_um, right_way().seed[0].learning_um);
  EXPECT_EQ(again.seed[0].after.inspection.pitch[0].position,
            right_way().seed[0].after.inspection.pitch[0].position);
}

// Every file, read back, commands what was learned.
TEST(InternalHelical, LearnedFilesSayWhatWasLearned) {
  const internal_helical::InternalHelicalResult& result = right_way();
  const internal_helical::LearnedTables& t = result.detail.tables;
  const std::vector<host::LearnedFile> files = host::learned_files(result.gear, t);
  ASSERT_EQ(files.size(), 5U);
  const host::CecTable up = test::read_cec(files[0].text, true, 1);
  const host::CecTable down = test::read_cec(files[1].text, true, 1);
  const host::EncCompTable slots = test::read_enc_comp(files[2].text, true);
  std::istringstream comp(files[3].text);
  const host::LinuxcncComp linuxcnc = host::read_linuxcnc(comp, files[3].name, 1);
  const host::SsfkTable isg = test::read_ssfk(files[4].text, false);
  const double p = result.gear.screw_parameter();
  constexpr double kRounding_rad = 0.51e-6 * internal_helical::kRadPerDegree;
  for (std::size_t j = 0; j < t.stroke[0].size(); ++j) {
    const double z = t.z0_mm + t.pitch_mm * static_cast<double>(j);
    EXPECT_NEAR(test::offset_at(up, z, 1), t.stroke[0][j], kRounding_rad);
    EXPECT_NEAR(test::offset_at(down, z, -1), t.stroke[1][j], kRounding_rad);
    EXPECT_NEAR(test::offset_at(linuxcnc, z, 1), p * t.stroke[0][j], 0.51e-6);
    EXPECT_NEAR(test::offset_at(isg, z, -1), p * t.stroke[1][j], 0.51e-4);
  }
  for (std::size_t k = 0; k < t.slot.size(); ++k) {
    const double c = internal_helical::slot_place(result.gear, static_cast<std::uint16_t>(k)) /
                     internal_helical::kRadPerDegree;
    EXPECT_NEAR(test::offset_at(slots, c), t.slot[k], 3.0 * kRounding_rad) << k;
  }
}

TEST(InternalHelical, FiguresAndReportAreComplete) {
  const nlohmann::json j = internal_helical::internal_helical_figures(right_way(), {"a"});
  for (const char* name : {"Fp", "fp"}) {
    for (const char* side : {"left", "right"})
      EXPECT_GT(j[name][side]["before"]["median"], j[name][side]["after"]["median"]);
  }
  EXPECT_GT(j["Fa"]["before"]["min"], j["Fa"]["after"]["median"]);
  EXPECT_EQ(j["grades"].size(), 20U);
  EXPECT_EQ(j["signals"]["before"]["slots"]["verdict"], "compensate");
  EXPECT_EQ(j["tables_written"].size(), 1U);
  EXPECT_EQ(internal_helical::internal_helical_document(right_way(), {})["sections"].size(), 16U);
}

}  // namespace
}  // namespace volcomp::sim
