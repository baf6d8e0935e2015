// Axes that grow with temperature. The oracle is the machine itself: a grown scale drives a
// carriage to another place than it reads, so the warm machine is the ideal one standing at those
// places.

#include <algorithm>

#include "comp/metrology/tables/quantise.hpp"
#include "tests/oracle/growing_machine.hpp"

namespace volcomp::test {
namespace {

// A double model of the same tables, as warm as they are.
struct DoubleModel {
  explicit DoubleModel(const MachineTables& tables, const Temperatures& temperature) {
    EXPECT_TRUE(MachineChain::build(tables.machine, model.chain).ok());
    model.directions = tables.directions;
    model.tool_point = tool_of(tables.machine);
    model.expansion = tables.expansion;
    model.strain = strains(tables.expansion, static_cast<double>(tables.provenance.temperature_C),
                           temperature);
    for (std::size_t a = 0; a < model.chain.axis_count(); ++a) {
      dequantise(tables.axis[a], model.chain.axis(a), (*table)[a]);
      model.table[a] = &(*table)[a];
    }
  }
  std::unique_ptr<std::array<ErrorTable, 5>> table = std::make_unique<std::array<ErrorTable, 5>>();
  VolumetricModel model;
};

Pose pose_of(const MachineChain& chain, const std::array<std::int64_t, 5>& q) {
  Pose pose{};
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    const bool turns = chain.axis(a).kind == JointKind::rotary;
    pose[a] = static_cast<double>(q[a]) / (turns ? kUnitsPerRad : kNmPerMm);
  }
  return pose;
}

// --- sign and amount -----------------------------------------------------------------------------

// 500 mm · 11.7e-6/K · 3 K = 17.55 µm too far, so the axis is sent back by as much.
TEST(Thermal, AWarmScaleDrivesTooFarAndTheMotionTakesItBack) {
  MachineTables tables;
  tables.machine = kXyfzMachine;
  for (AxisTable& t : tables.axis)
    t = {{-500'000'000, 50'000'000, 11, false}, {}};
  tables.expansion[0] = {kSteel, -500.0F, 3};
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.compensator->configure(open_settings<5>()).ok());
  ASSERT_TRUE(stage_warm(runner, tables, {0.0F, 0.0F, 0.0F, 23.0F}).ok());
  runner.tick({0, 0, 0, 0, 0});
  EXPECT_EQ(runner.tick({0, 0, 0, 0, 0}).offset[0], -17'550);
  EXPECT_EQ(runner.tick({-250'000'000, 0, 0, 0, 0}).offset[0], -8'775);
  EXPECT_EQ(runner.tick({-500'000'000, 0, 0, 0, 0}).offset[0], 0);
  EXPECT_EQ(runner.out.offset[1], 0);
  EXPECT_EQ(runner.out.offset[2], 0);
  // Measured: p_true = p + E.
  std::array<LatchedAxis, kMaxAxes> latched{};
  EXPECT_NEAR(runner.compensator->error_at(latched).base.x(), 17'550.0, 0.01);
  // Colder than the campaign: the other way.
  ASSERT_TRUE(stage_warm(runner, tables, {0.0F, 0.0F, 0.0F, 17.0F}).ok());
  runner.tick({0, 0, 0, 0, 0});
  EXPECT_EQ(runner.tick({0, 0, 0, 0, 0}).offset[0], 17'550);
}

// Whatever branch an axis is on and whichever way it counts.
TEST(Thermal, TheErrorIsWhereTheGrownScalesReallyDriveTheIdealMachine) {
  Random random(60);
  SCOPED_TRACE(random.trace());
  const Temperatures temperature = warm(26.0F, 17.5F, 24.25F);
  for (const int x : {-1, 1}) {
    for (const int y : {-1, 1}) {
      MachineTables tables = five_axes(0.0, 0.0, random);
      tables.machine = table_table(x, y, -y);
      let_grow(tables);
      MachineChain chain;
      ASSERT_TRUE(MachineChain::build(tables.machine, chain).ok());
      LoadedRunner runner(tables.machine);
      ASSERT_TRUE(runner.compensator->configure(open_settings<5>()).ok());
      ASSERT_TRUE(stage_warm(runner, tables, temperature).ok());
      const Vec3 tool = tool_of(tables.machine);
      for (int n = 0; n < 500; ++n) {
        const std::array<std::int64_t, 5> q{
            random.integer(-250'000'000, 249'000'000), random.integer(-250'000'000, 249'000'000),
            random.integer(-250'000'000, 249'000'000), random.integer(-kTurn / 4, kTurn / 4),
            random.integer(0, kTurn)};
        runner.tick(q);
        const Pose read = pose_of(chain, q);
        Pose real = read;
        const std::array<double, 3> grown{kSteel_per_K * (26.0 - 21.5), -8.5e-6 * (17.5 - 21.5),
                                          23.8e-6 * (24.25 - 21.5)};
        const std::array<double, 3> fixed{-200.0, 150.0, 0.0};
        for (std::size_t a = 0; a < 3; ++a)
          real[a] = fixed[a] + (1.0 + grown[a]) * (read[a] - fixed[a]);
        const auto seen_from_work = [&](const Pose& at) -> Vec3 {
          const Frame work = chain.ideal(chain.work(), at);
          return work.R.transpose() * (chain.ideal(chain.tool(), at).apply(tool) - work.t);
        };
        const Vec3 moved = kNmPerMm * (seen_from_work(real) - seen_from_work(read));
        const Vec3 expected = chain.ideal(chain.work(), read).R * moved;
        ASSERT_LT((error_of_tick(runner) - expected).cwiseAbs().maxCoeff(), 0.1) << "point " << n;
      }
    }
  }
}

// --- one model in every path ---------------------------------------------------------------------

TEST(Thermal, TickAndDoubleModelAgreeFoldedAndSecondOrder) {
  Random random(61);
  SCOPED_TRACE(random.trace());
  MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  scale_to_bound(tables, 0.4e6);
  let_grow(tables);
  const Temperatures temperature = warm(25.5F, 16.0F, 30.0F);
  const DoubleModel oracle(tables, temperature);
  LoadedRunner first(kXyfzMachine, RuntimeModel::folded);
  LoadedRunner second(kXyfzMachine, RuntimeModel::second_order);
  for (LoadedRunner* runner : {&first, &second}) {
    ASSERT_TRUE(runner->compensator->configure(open_settings<5>()).ok());
    ASSERT_TRUE(stage_warm(*runner, tables, temperature).ok());
  }
  ASSERT_TRUE(first.compensator->fold_report().within_1nm);
  double worst = 0.0;
  for (int n = 0; n < kManyPoints / 20; ++n) {
    // Beyond the ends, too: an axis counts as standing at its end.
    const std::array<std::int64_t, 5> q{random.integer(-530'000'000, 30'000'000),
                                        random.integer(-330'000'000, 30'000'000),
                                        random.integer(-430'000'000, 30'000'000), 0, 0};
    first.tick(q);
    second.tick(q);
    Travels travels{};
    for (std::size_t a = 0; a < 3; ++a) {
      const Direction d = first.compensator->direction(a);
      travels[a] = d == Direction::unknown
                       ? Travel::unknown
                       : (d == Direction::forward ? Travel::forward : Travel::backward);
    }
    const Pose pose = pose_of(oracle.model.chain, q);
    const Vec3 e1 = kNmPerMm * oracle.model.first_order(pose, travels, Beyond::stand_at_end);
    const Vec3 e2 = kNmPerMm * oracle.model.second_order(pose, travels, Beyond::stand_at_end);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      worst = std::max(
          {worst, std::abs(first.out.offset[a] + e1(i)), std::abs(second.out.offset[a] + e2(i))});
    }
    ASSERT_LT(worst, 1.0) << "point " << n;
  }
  EXPECT_GT(worst, 0.4) << "rounding alone must show";
}

TEST(Thermal, FiveAxesAndTheProbeFollowTheSameModel) {
  Random random(62);
  SCOPED_TRACE(random.trace());
  MachineTables tables = five_axes(8e3, 40e-6, random);
  for (AxisTable& t : tables.axis)
    t.value[1] = t.value[0];
  scale_to_bound(tables, 0.8e6);
  let_grow(tables);
  const Temperatures temperature = warm(23.0F, 27.0F, 19.0F);
  const DoubleModel oracle(tables, temperature);
  LoadedRunner runner(tables.machine);
  ASSERT_TRUE(runner.compensator->configure(open_settings<5>()).ok());
  ASSERT_TRUE(stage_warm(runner, tables, temperature).ok());
  ASSERT_TRUE(runner.compensator->fold_report().within_1nm);
  double worst = 0.0;
  double worst_touch = 0.0;
  for (int n = 0; n < kManyPoints / 50; ++n) {
    const std::array<std::int64_t, 5> q{
        random.integer(-250'000'000, 249'000'000), random.integer(-250'000'000, 249'000'000),
        random.integer(-250'000'000, 249'000'000), random.integer(-kTurn * 100 / 360, kTurn / 4),
        random.integer(-kTurn, kTurn)};
    runner.tick(q);
    const Vec3 e = kNmPerMm * oracle.model.second_order(pose_of(oracle.model.chain, q), {},
                                                        Beyond::stand_at_end);
    worst = std::max(worst, (error_of_tick(runner) - e).cwiseAbs().maxCoeff());
    std::array<LatchedAxis, kMaxAxes> latched{};
    for (std::size_t a = 0; a < 5; ++a)
      latched[a].position = q[a];
    const PoseError touch = runner.compensator->error_at(latched);
    worst_touch = std::max(worst_touch, (touch.base - e).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 1.0);
  EXPECT_LT(worst_touch, 1.0);
  EXPECT_GT(worst, 0.0);
}

// At the reference and where no temperature is known, tables are what they are, to the last bit.
TEST(Thermal, NothingIsAddedWithoutATemperature) {
  Random random(63);
  MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  LoadedRunner plain(kXyfzMachine);
  LoadedRunner unknown(kXyfzMachine);
  LoadedRunner reference(kXyfzMachine);
  ASSERT_TRUE(plain.start(tables).ok());
  let_grow(tables);
  ASSERT_TRUE(unknown.start(tables).ok());
  ASSERT_TRUE(reference.compensator->configure(open_settings<5>()).ok());
  ASSERT_TRUE(stage_warm(reference, tables, warm(21.5F, 21.5F, 21.5F)).ok());
  for (int n = 0; n < 2000; ++n) {
    const std::array<std::int64_t, 5> q{random.integer(-500'000'000, 0),
                                        random.integer(-300'000'000, 0),
                                        random.integer(-400'000'000, 0), 0, 0};
    plain.tick(q);
    unknown.tick(q);
    reference.tick(q);
    ASSERT_EQ(plain.out.offset, unknown.out.offset);
    ASSERT_EQ(plain.out.offset, reference.out.offset);
    ASSERT_EQ(error_of_tick(plain), error_of_tick(unknown));
  }
}

}  // namespace
}  // namespace volcomp::test
