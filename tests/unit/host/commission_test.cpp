// From run files to tables: a known error put in must come out, and wrong combinations of files are
// refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/tables/image.hpp"
#include "host_sim/commissioning/commission.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/scenarios/xyfz/campaign.hpp"
#include "host_sim/scenarios/xyfz/truth.hpp"

namespace volcomp::sim {
namespace {

class Commissioning : public testing::Test {
 protected:
  MachineFile file = read_machine_file(bundled_machine("xyfz"));
  TrueMachine truth = make_xyfz_truth(file, 3, {});
  Campaign campaign = perfect_campaign(truth, file);

  std::string refusal(const std::vector<RunsFile>& runs) const {
    try {
      static_cast<void>(commission(file, runs, {}));
    } catch (const UserError& e) {
      return e.what();
    }
    return "accepted";
  }
};

// Without noise, the model of the tables is the machine up to a rigid motion on the knots (which no
// diagonal sees), second-order terms and the resolution of the instrument.
TEST_F(Commissioning, TablesReproduceTheMachineOnTheKnots) {
  const auto tables =
      commission(campaign.machine, campaign.runs, {ModelKind::abbe_closed, SlopeFit::keep});
  const auto difference = [&](const Vec3& p) -> Vec3 {
    const Pose q{p.x(), p.y(), p.z()};
    return truth.error(q, {}, truth.chain.tool_point()).position_work -
           tables->model.first_order(q, kUnknownTravels, Beyond::stand_at_end);
  };
  const Vec3 zero = difference(Vec3::Zero());
  // Slopes kept: nothing rigid is lost, so only a constant remains.
  for (const Vec3& p :
       {Vec3(-500, -300, -400), Vec3(-250, -150, -200), Vec3(0, -300, -40), Vec3(-450, 0, -360)}) {
    EXPECT_LT((difference(p) - zero).norm(), 0.3e-3) << p.x() << ' ' << p.y() << ' ' << p.z();
  }
}

TEST_F(Commissioning, ImageOfTheTablesDecodesToTheSameTables) {
  const auto tables = commission(campaign.machine, campaign.runs, {});
  const std::vector<std::uint8_t> image = make_image(tables->tables);
  const auto decoded = std::make_unique<MachineTables>();
  ASSERT_TRUE(decode_image(image, 128, *decoded).ok());
  EXPECT_EQ(decoded->provenance.machine_id, 1001U);
  EXPECT_EQ(make_image(*decoded), image);
}

TEST_F(Commissioning, BoundOfTheModelIsExtraWorkThatChangesNoTable) {
  const auto full = commission(campaign.machine, campaign.runs, {ModelKind::abbe_closed});
  const auto quick =
      commission(campaign.machine, campaign.runs, tables_only(ModelKind::abbe_closed));
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
  const auto tables = commission(file, runs, {});
  EXPECT_THAT(tables->warnings,
              testing::ElementsAre(testing::HasSubstr("runs_Z.csv: one_direction")));
}

}  // namespace
}  // namespace volcomp::sim
