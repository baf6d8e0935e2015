// Staging: a bad table set is refused with its reason, counted, and the active one goes on.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr LoadedRunner::Positions kHere{-222'000'000, -111'000'000, -333'000'000, 0, 0};

class Staging : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(runner.compensator->configure(open_settings<5>()).ok());
    ASSERT_TRUE(runner.compensator->stage(good, tool_of(good.machine), 0xC0FFEE).ok());
    ASSERT_TRUE(runner.compensator->activate().ok());
    before = runner.tick(kHere).offset;
    ASSERT_NE(before[0], 0);
  }

  void expect_refused(const MachineTables& tables, Reason reason, const Vec3& tool) {
    const std::uint32_t count = runner.compensator->diagnostics().rejections;
    const Status status = runner.compensator->stage(tables, tool, 0xBAD);
    EXPECT_EQ(code(status.reason), std::string(code(reason)));
    EXPECT_EQ(runner.compensator->diagnostics().rejections, count + 1);
    EXPECT_EQ(runner.compensator->diagnostics().last_rejection.reason, status.reason);
    EXPECT_EQ(runner.compensator->activate().reason, Reason::not_staged);
    EXPECT_EQ(runner.tick(kHere).offset, before) << "the active tables go on";
    EXPECT_EQ(runner.out.status[0] & kRamping, 0);
    EXPECT_EQ(runner.compensator->diagnostics().active_crc, 0xC0FFEEU);
    last = status;
  }
  void expect_refused(const MachineTables& tables, Reason reason) {
    expect_refused(tables, reason, tool_of(tables.machine));
  }

  Random random{80};
  MachineTables good = xyfz_tables(40e3, 4e-5, random);
  LoadedRunner runner{kXyfzMachine};
  std::array<std::int32_t, 5> before{};
  Status last{};
};

TEST_F(Staging, OtherNumberOfAxes) {
  MachineTables two = good;
  two.machine.body_count = 3;
  two.machine.tool_body = 1;
  two.machine.correcting_count = 2;
  expect_refused(two, Reason::axes_mismatch);
  MachineTables four = good;
  four.machine.body[4] = moving_body(4, JointKind::rotary, Axis::z, 1, 3, 'C');
  four.machine.body_count = 5;
  four.machine.tool_body = 5;
  four.axis[3] = random_table(0, 1'000'000, 5, 0.0, 0.0, random);
  expect_refused(four, Reason::axes_mismatch);
}

// Tables of a machine of another shape do not fit, even with as many axes.
TEST_F(Staging, OtherShapeOfMachine) {
  MachineTables other_sign = good;
  other_sign.machine.body[2].joint.sign = 1;
  expect_refused(other_sign, Reason::machine_mismatch);
  MachineTables other_axis = good;
  other_axis.machine.body[3].joint.kind = JointKind::rotary;
  expect_refused(other_axis, Reason::machine_mismatch);
  MachineTables other_branch = good;  // X on Y on Z, all carrying the tool
  other_branch.machine.work_body = 1;
  other_branch.machine.tool_body = 4;
  other_branch.machine.body[3].lower = 3;
  expect_refused(other_branch, Reason::machine_mismatch);
  MachineTables other_order = good;
  std::swap(other_order.machine.body[1].joint.nc_axis, other_order.machine.body[2].joint.nc_axis);
  expect_refused(other_order, Reason::machine_mismatch);
}

TEST_F(Staging, MoreKnotsThanTheCapacity) {
  MachineTables full = good;
  full.axis[1] = random_table(-300'000'000, 2'000'000, 128, 1e3, 1e-6, random);
  EXPECT_TRUE(runner.compensator->stage(full, tool_of(full.machine), 0).ok());
  MachineTables many = good;
  many.axis[1] = random_table(-300'000'000, 2'000'000, 129, 1e3, 1e-6, random);
  expect_refused(many, Reason::too_many_knots);
  EXPECT_EQ(last.where.axis, 'Y');
  EXPECT_EQ(last.where.count, 129);
}

TEST_F(Staging, ErrorsBeyondTenMillimetres) {
  MachineTables huge = good;
  for (auto& column : huge.axis[2].value)
    column.fill({10.1e6F, 0, 0, 0, 0, 0});
  expect_refused(huge, Reason::bound_exceeded);
}

TEST_F(Staging, ErrorsThatChangeTooFast) {
  MachineTables steep = good;
  steep.axis[0].value[0][5][0] = 600e3F;  // 0.6 mm within 50 mm
  expect_refused(steep, Reason::contraction_exceeded);
  MachineTables twisted = good;
  for (auto& column : twisted.axis[2].value)
    column.fill({0, 0, 0, 0, 0, 1.1e-2F});
  const Status status = runner.compensator->stage(twisted, Vec3::Zero(), 0);
  EXPECT_FALSE(status.ok());
}

TEST_F(Staging, CorrectingAxesWithoutAuthority) {
  MachineTables parallel = good;  // X and Y both move along Y
  parallel.machine.body[2].joint.axis = Axis::y;
  LoadedRunner other(parallel.machine);
  ASSERT_TRUE(other.compensator->configure(open_settings<5>()).ok());
  const Status status = other.compensator->stage(parallel, tool_of(parallel.machine), 0);
  EXPECT_EQ(status.reason, Reason::no_authority);
  EXPECT_EQ(other.compensator->activate().reason, Reason::not_staged);
  other.tick(kHere);
  EXPECT_EQ(other.out.offset, (std::array<std::int32_t, 5>{}));
}

// A machine that is watched only: its tables load, and no axis gets anything.
TEST_F(Staging, WithoutACorrectingAxisNothingIsPutOut) {
  MachineTables watched = good;
  watched.machine.correcting_count = 0;
  LoadedRunner other(watched.machine);
  ASSERT_TRUE(other.start(watched).ok());
  EXPECT_EQ(other.tick(kHere).offset, (std::array<std::int32_t, 5>{}));
}

TEST_F(Staging, ToolPointThatIsNotANumber) {
  expect_refused(good, Reason::not_finite, Vec3(0.0, std::nan(""), 0.0));
  expect_refused(good, Reason::not_finite, Vec3(HUGE_VAL, 0.0, 0.0));
}

TEST_F(Staging, ValuesThatAreNotNumbers) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (std::size_t c = 0; c < 6; ++c) {
      MachineTables poisoned = good;
      poisoned.axis[1].value[1][4][c] = bad;
      const Status status = runner.compensator->stage(poisoned, tool_of(poisoned.machine), 0);
      EXPECT_FALSE(status.ok()) << "channel " << c;
    }
  }
  MachineTables poisoned = good;
  poisoned.directions[1].x() = std::nan("");
  EXPECT_FALSE(runner.compensator->stage(poisoned, tool_of(poisoned.machine), 0).ok());
}

TEST_F(Staging, TablesWithoutKnotsOrPitch) {
  for (const std::uint32_t knots : {0U, 1U}) {
    MachineTables empty = good;
    empty.axis[0].knots = knots;
    EXPECT_FALSE(runner.compensator->stage(empty, tool_of(empty.machine), 0).ok()) << knots;
  }
}

TEST_F(Staging, ActivateWithoutOrTwice) {
  EXPECT_EQ(runner.compensator->activate().reason, Reason::not_staged);
  ASSERT_TRUE(runner.compensator->stage(good, tool_of(good.machine), 1).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  EXPECT_EQ(runner.compensator->activate().reason, Reason::not_staged);
}

TEST_F(Staging, NothingIsWrittenWhileAHandOverIsPending) {
  MachineTables other = xyfz_tables(40e3, 4e-5, random);
  ASSERT_TRUE(runner.compensator->stage(other, tool_of(other.machine), 2).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  EXPECT_TRUE(runner.compensator->pending());
  EXPECT_EQ(runner.compensator->stage(good, tool_of(good.machine), 3).reason,
            Reason::hand_over_pending);
  const auto swapped = runner.tick(kHere).offset;
  EXPECT_FALSE(runner.compensator->pending());
  EXPECT_EQ(runner.compensator->diagnostics().active_crc, 2U);
  LoadedRunner fresh(kXyfzMachine);
  ASSERT_TRUE(fresh.start(other).ok());
  EXPECT_EQ(swapped, fresh.tick(kHere).offset);
}

// The tables that no tick has taken yet are given up; what comes next finds a free place.
TEST_F(Staging, ADeactivationOvertakesAnActivation) {
  ASSERT_TRUE(runner.compensator->stage(good, tool_of(good.machine), 2).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  runner.compensator->deactivate();
  EXPECT_EQ(runner.tick(kHere).offset, (std::array<std::int32_t, 5>{}));
  EXPECT_FALSE(runner.compensator->active());
  ASSERT_TRUE(runner.compensator->stage(good, tool_of(good.machine), 3).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  EXPECT_EQ(runner.tick(kHere).offset, before);
  EXPECT_EQ(runner.compensator->diagnostics().active_crc, 3U);
}

// While a set waits, it is undefined which one is to be judged.
TEST_F(Staging, NothingIsScrubbedOrViewedWhileAHandOverIsPending) {
  TablesView view;
  ASSERT_TRUE(view_tables(good, view).ok());
  ASSERT_TRUE(runner.compensator->stage(view, tool_of(good.machine), 2).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  EXPECT_TRUE(runner.compensator->scrub().ok());
  EXPECT_EQ(runner.compensator->stage(view, tool_of(good.machine), 3).reason,
            Reason::hand_over_pending);
  EXPECT_EQ(runner.tick(kHere).offset, before);
  EXPECT_TRUE(runner.compensator->scrub().ok());
}

TEST_F(Staging, AMachineThatIsNoneIsRefusedWithItsTables) {
  MachineTables broken = good;
  broken.machine.body[1].joint.sign = 0;
  expect_refused(broken, Reason::bad_joint);
}

// Restarted with more axes than it has room for, it runs no machine at all.
TEST_F(Staging, AMachineOfTooManyAxesIsNotRun) {
  MachineDescription six = good.machine;
  for (std::uint8_t axis = 3; axis < 6; ++axis) {
    six.body[six.body_count] =
        moving_body(six.tool_body, JointKind::prismatic, Axis::z, 1, axis, 'W');
    six.tool_body = ++six.body_count;
  }
  runner.compensator->restart(LoadedMachine<5>{make_runtime_chain(six)});
  EXPECT_EQ(runner.compensator->machine().chain.axes, 0);
  EXPECT_EQ(runner.compensator->stage(good, tool_of(good.machine), 2).reason,
            Reason::axes_mismatch);
  runner.out = {};
  EXPECT_EQ(runner.tick(kHere).offset, (std::array<std::int32_t, 5>{}));
}

// A staged set that was never activated does not leak into the active one.
TEST_F(Staging, StagingAloneChangesNothing) {
  MachineTables other = xyfz_tables(40e3, 4e-5, random);
  ASSERT_TRUE(runner.compensator->stage(other, tool_of(other.machine), 2).ok());
  EXPECT_EQ(runner.tick(kHere).offset, before);
  runner.compensator->deactivate();
  EXPECT_EQ(runner.tick(kHere).offset, (std::array<std::int32_t, 5>{}));
  EXPECT_FALSE(runner.compensator->active());
}

// A longer tool changes the correction by ε × ΔP, nothing else.
TEST_F(Staging, ToolChangeMovesTheLever) {
  const Vec3 tool = tool_of(good.machine) + Vec3(0, 0, -100.0);
  MachineModel model(good, {tool.x(), tool.y(), tool.z()});
  ASSERT_TRUE(runner.compensator->stage(good, tool, 4).ok());
  ASSERT_TRUE(runner.compensator->activate().ok());
  runner.tick(kHere);
  model.stand_at({kHere[0], kHere[1], kHere[2]}, {2, 2, 2});
  const Real3 e = model.first_order();
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_LT(std::abs(static_cast<double>(runner.out.offset[a] + e[a])), 1.0);
  EXPECT_NE(runner.out.offset[0], before[0]);
}

}  // namespace
}  // namespace volcomp::test
