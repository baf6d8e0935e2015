// The simulated machine under control: it goes where it is commanded, and the compensation has the
// effect that the model predicts.

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::sim {
namespace {

class Cell : public testing::Test {
 protected:
  host::MachineFile file = host::read_machine_file(host::bundled_machine("xyfz"));
  TrueMachine truth = draw_machine(file, 5);
};

constexpr host::AxisKinds kThreeLinear{3, {}};

// Axes that follow at once, write down where they were sent, and pretend a ramp for a while.
class IdealAxes final : public AxisGroup {
 public:
  explicit IdealAxes(double period_s, int ramp_cycles = 0)
      : period_s_(period_s), ramp_cycles_(ramp_cycles) {}

  void stand_at(const Pose& pose) override { target_ = kThreeLinear.targets(pose); }
  void cycle(const host::Targets& target) override {
    target_ = target;
    ramp_cycles_ = std::max(0, ramp_cycles_ - 1);
  }
  [[nodiscard]] double period_s() const override { return period_s_; }
  [[nodiscard]] host::Targets target() const override { return target_; }
  [[nodiscard]] host::Offsets offset() const override { return {}; }
  [[nodiscard]] Pose position() const override {
    Pose q{};
    for (std::size_t a = 0; a < kThreeLinear.count; ++a)
      q[a] = static_cast<double>(target_[a]) / kNmPerMm;
    return q;
  }
  [[nodiscard]] Approach approach() const override { return {}; }
  [[nodiscard]] double following_error() const override { return 0.0; }
  [[nodiscard]] bool ramping() const override { return ramp_cycles_ > 0; }

 private:
  double period_s_;
  int ramp_cycles_;
  host::Targets target_{};
};

double distance_mm(const host::Targets& a, const host::Targets& b) {
  Vec3 d;
  for (std::size_t i = 0; i < kThreeLinear.count; ++i)
    d(static_cast<Eigen::Index>(i)) = static_cast<double>(a[i] - b[i]) / kNmPerMm;
  return d.norm();
}

// A trapezoid of feed v and acceleration a needs L / v + v / a for a length L, and the interpolator
// does not care how long a control period is.
TEST_F(Cell, LineKeepsItsFeedAndItsDurationAtAnyPeriod) {
  constexpr double kFeed = 100.0;
  constexpr double kAcceleration = 2000.0;
  for (const double period_s : {0.0005, 0.001, 0.004}) {
    MotionCell cell(truth, std::make_unique<IdealAxes>(period_s));
    const Vec3 from(-400.0, -200.0, -300.0);
    const Vec3 to(-100.0, -250.0, -50.0);
    cell.place(from);
    host::Targets last = cell.axes().target();
    int cycles = 0;
    cell.move_to(to, kFeed, [&](const MotionCell& c) {
      EXPECT_LE(distance_mm(c.axes().target(), last), kFeed * period_s + 2e-6);
      last = c.axes().target();
      ++cycles;
    });
    EXPECT_EQ(last, kThreeLinear.targets(host::pose_of(to)));
    EXPECT_NEAR(cycles * period_s, (to - from).norm() / kFeed + kFeed / kAcceleration, period_s);
  }
}

TEST_F(Cell, StandsUntilTheRampOfTheCompensationIsOver) {
  MotionCell cell(truth, std::make_unique<IdealAxes>(0.004, 250));
  cell.place(Vec3(-100.0, -50.0, -300.0));
  EXPECT_FALSE(cell.axes().ramping());
}

TEST_F(Cell, UncompensatedMachineStandsOnItsTargetAndShowsItsError) {
  const auto cell = make_integrated_cell(truth, file.correction, {});
  const Vec3 target(-123.456, -78.9, -321.0);
  cell->place(Vec3(-100.0, -50.0, -300.0));
  cell->move_to(target, 100.0);
  EXPECT_LT(cell->axes().following_error(), 0.5);
  const Vec3 expected =
      truth.error(cell->axes().position(), cell->axes().approach(), truth.chain.tool_point())
          .position_work;
  EXPECT_LT((cell->deviation_mm() - expected).norm(), 1e-6);
}

TEST_F(Cell, ArrivingFromBelowAndAboveDiffersByTheReversal) {
  const auto cell = make_integrated_cell(truth, file.correction, {});
  const Vec3 middle(-250.0, -150.0, -200.0);
  cell->place(middle - Vec3(1.0, 0.0, 0.0));
  cell->move_to(middle, 50.0);
  const double up = cell->deviation_mm().x();
  cell->move_to(middle + Vec3(1.0, 0.0, 0.0), 50.0);
  cell->move_to(middle, 50.0);
  const double down = cell->deviation_mm().x();
  // The own reversal of X plus what its angular reversals do at the functional point.
  const Vec3 lever(truth.chain.tool_point() + Vec3(220.0, 670.0, 950.0) + middle);
  const Vec3 turn(truth.axis[0].reversal[3], truth.axis[0].reversal[4], truth.axis[0].reversal[5]);
  EXPECT_NEAR(up - down, truth.axis[0].reversal[0] + turn.cross(lever).x(), 2e-6);
}

TEST_F(Cell, DamagedImageNeverReachesTheMachine) {
  const Campaign campaign = perfect_campaign(truth, file);
  std::vector<std::uint8_t> image =
      host::make_image(host::build_tables(campaign.machine, campaign.runs, {})->tables);
  image[image.size() / 2] ^= 1U;
  EXPECT_THROW(static_cast<void>(make_integrated_cell(truth, file.correction, image)),
               host::UserError);
}

TEST_F(Cell, EveryOffsetObeysLimitAndRate) {
  const Campaign campaign = perfect_campaign(truth, file);
  host::CorrectionFile tight = file.correction;
  tight.limit_mm = 0.02;
  tight.rate_mm_per_s = 0.5;
  const auto cell = make_integrated_cell(
      truth, tight,
      host::make_image(host::build_tables(campaign.machine, campaign.runs, {})->tables));
  cell->place(Vec3(-500.0, -300.0, -400.0));
  auto before = cell->axes().offset();
  bool limit_reached = false;
  cell->move_to(Vec3(0.0, 0.0, 0.0), 400.0, [&](const MotionCell& c) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t now = c.axes().offset()[a];
      EXPECT_LE(std::abs(now), 20'000);
      EXPECT_LE(std::abs(now - before[a]), 500);
      limit_reached = limit_reached || std::abs(now) == 20'000;
    }
    before = c.axes().offset();
  });
  EXPECT_TRUE(limit_reached);
}

}  // namespace
}  // namespace volcomp::sim
