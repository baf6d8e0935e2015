// The simulated machine under control: it goes where it is told, and what the compensation does to
// it is what the model says.

#include <gtest/gtest.h>

#include "host_sim/commissioning/commission.hpp"
#include "host_sim/controller/motion_cell.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/scenarios/xyfz/campaign.hpp"
#include "host_sim/scenarios/xyfz/truth.hpp"

namespace volcomp::sim {
namespace {

class Cell : public testing::Test {
 protected:
  MachineFile file = read_machine_file(bundled_machine("xyfz"));
  TrueMachine truth = make_xyfz_truth(file, 5, {});
};

TEST_F(Cell, UncompensatedMachineStandsOnItsTargetAndShowsItsError) {
  MotionCell cell(truth, file.correction, {});
  const Vec3 target(-123.456, -78.9, -321.0);
  cell.place(Vec3(-100.0, -50.0, -300.0));
  cell.move_to(target, 100.0);
  EXPECT_LT(cell.axes().following_error_nm(), 0.5);
  const Vec3 expected =
      truth.error(cell.axes().position(), cell.axes().approach(), truth.chain.tool_point())
          .position_work;
  EXPECT_LT((cell.deviation_mm() - expected).norm(), 1e-6);
}

TEST_F(Cell, ArrivingFromBelowAndAboveDiffersByTheReversal) {
  MotionCell cell(truth, file.correction, {});
  const Vec3 middle(-250.0, -150.0, -200.0);
  cell.place(middle - Vec3(1.0, 0.0, 0.0));
  cell.move_to(middle, 50.0);
  const double up = cell.deviation_mm().x();
  cell.move_to(middle + Vec3(1.0, 0.0, 0.0), 50.0);
  cell.move_to(middle, 50.0);
  const double down = cell.deviation_mm().x();
  // The own reversal of X plus what its angular reversals do at the functional point.
  const Vec3 lever(truth.chain.tool_point() + Vec3(220.0, 670.0, 950.0) + middle);
  const Vec3 turn(truth.axis[0].reversal[3], truth.axis[0].reversal[4], truth.axis[0].reversal[5]);
  EXPECT_NEAR(up - down, truth.axis[0].reversal[0] + turn.cross(lever).x(), 2e-6);
}

TEST_F(Cell, DamagedImageNeverReachesTheMachine) {
  const Campaign campaign = perfect_campaign(truth, file);
  std::vector<std::uint8_t> image =
      make_image(commission(campaign.machine, campaign.runs, {})->tables);
  image[image.size() / 2] ^= 1U;
  EXPECT_THROW(MotionCell(truth, file.correction, image), UserError);
}

TEST_F(Cell, EveryOffsetObeysLimitAndRate) {
  const Campaign campaign = perfect_campaign(truth, file);
  CorrectionFile tight = file.correction;
  tight.limit_mm = 0.02;
  tight.rate_mm_per_s = 0.5;
  MotionCell cell(truth, tight,
                  make_image(commission(campaign.machine, campaign.runs, {})->tables));
  cell.place(Vec3(-500.0, -300.0, -400.0));
  auto before = cell.axes().offset_nm();
  bool limit_reached = false;
  cell.move_to(Vec3(0.0, 0.0, 0.0), 400.0, [&](const MotionCell& c) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t now = c.axes().offset_nm()[a];
      EXPECT_LE(std::abs(now), 20'000);
      EXPECT_LE(std::abs(now - before[a]), 500);
      limit_reached = limit_reached || std::abs(now) == 20'000;
    }
    before = c.axes().offset_nm();
  });
  EXPECT_TRUE(limit_reached);
}

}  // namespace
}  // namespace volcomp::sim
