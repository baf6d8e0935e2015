// The probe over the bus: latches of the drives in, points out, as process data and over SDO.

#include <cmath>
#include <cstring>
#include <limits>

#include "comp/tick/touch.hpp"
#include "firmware/node/probe/point_fifo.hpp"
#include "tests/firmware/node/probe/probe_bench.hpp"
#include "tests/oracle/probe_limits.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::ObjectId;

// The same machine in long double (tests/oracle/tick_bench.hpp).
TEST_F(NodeProbe, ATouchBecomesTheCorrectedPoint) {
  const MachineTables tables = bench_tables();
  start(tables);
  edge();
  const ReadPoint point = take();
  EXPECT_EQ(point.sequence, 1U);
  EXPECT_EQ(point.verdict, TouchVerdict::centre);
  std::array<std::int64_t, kMaxAxes> q{};
  for (std::size_t a = 0; a < 3; ++a) {
    q[a] = point.latched[a];
    EXPECT_NEAR(static_cast<double>(q[a]), position(a), 3000.0) << "offsets move on";
    EXPECT_NEAR(point.speed[a], -500'000.0, 1e5) << "1 µm in 2 ms";
  }
  test::MachineModel model(tables, tables.machine.tool_point);
  model.stand_at(q, {1, 1, 1});
  const test::Real3 nominal = model.nominal();
  const test::Real3 error = model.first_order();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(static_cast<double>(point.machine[k]), static_cast<double>(nominal[k] + error[k]),
                1.0);
  }
}

TEST_F(NodeProbe, ProcessDataTellTheLatestPoint) {
  start();
  ASSERT_EQ(set_real(0x2302, 1, 2e6), AbortCode::none);
  ASSERT_EQ(set_real(0x2304, 1, 1234.5), AbortCode::none);
  ASSERT_EQ(switch_on(), AbortCode::none);
  ASSERT_EQ(set_real(0x2310, 2, 1.0), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2310, 1, 0x12'3456), AbortCode::none);
  bench.sent.clear();
  edge();
  const hal::CanFrame* number = sent(0x2A0);
  const hal::CanFrame* xy = sent(0x3A0);
  const hal::CanFrame* z = sent(0x4A0);
  ASSERT_TRUE(number != nullptr && xy != nullptr && z != nullptr);
  EXPECT_EQ(load_le(number->data.data(), 4), 1U);
  EXPECT_EQ(number->data[4], static_cast<std::uint8_t>(TouchVerdict::point));
  EXPECT_EQ(load_le(&number->data[6], 2), 0x3456U);
  const ReadPoint point = take();
  EXPECT_EQ(point.feature, 0x12'3456U);
  EXPECT_EQ(load_le_signed(xy->data.data(), 4), point.workpiece[0]);
  EXPECT_EQ(load_le_signed(&xy->data[4], 4), point.workpiece[1]);
  EXPECT_EQ(load_le_signed(z->data.data(), 4), point.workpiece[2]);
  EXPECT_EQ(load_le(&z->data[4], 4), 1235U);
}

TEST_F(NodeProbe, TheRadiusGoesAlongTheNormal) {
  start();
  edge(0);
  const ReadPoint centre = take();
  ASSERT_EQ(set_real(0x2302, 1, 2e6), AbortCode::none);
  ASSERT_EQ(switch_on(), AbortCode::none);
  ASSERT_EQ(set_real(0x2310, 3, 0.6), AbortCode::none);
  ASSERT_EQ(set_real(0x2310, 4, -0.8), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2310, 1, 9), AbortCode::none);
  // Towards the part: the work carries X and Y, so its motion is the tool's, reversed.
  bench.drive[1].target -= 1000;
  edge(-1000);
  const ReadPoint point = take();
  EXPECT_NEAR(static_cast<double>(point.workpiece[0] - centre.workpiece[0]), 0.0, 2e4);
  EXPECT_NEAR(static_cast<double>(point.workpiece[1] - centre.workpiece[1]), -1.2e6, 2e4);
  EXPECT_NEAR(static_cast<double>(point.workpiece[2] - centre.workpiece[2]), 1.6e6, 2e4);
}

TEST_F(NodeProbe, IsOffUntilItIsSwitchedOn) {
  bench.bring_up();
  edge();
  EXPECT_EQ(bench.number(0x2400, 3), 0U);
  ASSERT_EQ(switch_on(), AbortCode::none);
  edge();
  EXPECT_EQ(bench.number(0x2400, 3), 1U);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2300, 1, 0), AbortCode::none);
  edge();
  EXPECT_EQ(bench.number(0x2400, 3), 1U);
}

TEST_F(NodeProbe, WithoutTablesThereIsNoMachine) {
  bench.configure();
  bench.nmt(canopen::NmtCommand::start);
  ASSERT_EQ(switch_on(), AbortCode::none);
  bench.cycles(3);
  edge();
  EXPECT_EQ(take().verdict, TouchVerdict::no_machine);
}

TEST_F(NodeProbe, WithoutCorrectionThePointIsMarked) {
  start();
  ASSERT_EQ(bench.command(TableCommand::deactivate), AbortCode::none);
  bench.cycles(100);
  edge();
  EXPECT_EQ(take().verdict, TouchVerdict::uncorrected);
}

// --- what is wrong with a touch

TEST_F(NodeProbe, ARejectedTouchIsToldEverywhere) {
  start();
  edge();
  take();
  latches[1] = false;
  edge();
  bench.cycles(3);
  EXPECT_TRUE(bench.emergency(ErrorCode::touch_rejected,
                              static_cast<std::uint8_t>(TouchVerdict::no_position)));
  EXPECT_EQ(bench.number(0x2400, 4), 1U);
  EXPECT_EQ(bench.number(0x2401, 2), static_cast<std::uint64_t>(TouchVerdict::no_position));
  EXPECT_EQ(bench.number(0x2401, 3), 2U) << "axis 2";
  const ReadPoint point = take();
  EXPECT_EQ(point.verdict, TouchVerdict::no_position);
  EXPECT_EQ(point.axis, 1U);
  EXPECT_EQ(point.machine, (std::array<std::int64_t, 3>{}));
  EXPECT_NE(point.latched[0], 0) << "raw latches are kept";
  EXPECT_EQ(point.latched[1], 0);

  latches[1] = true;
  bench.emergencies.clear();
  edge();
  EXPECT_EQ(take().verdict, TouchVerdict::centre);
  bench.cycles(20);
  EXPECT_TRUE(
      bench.emergency(ErrorCode::none, static_cast<std::uint8_t>(TouchVerdict::no_position)));
}

TEST_F(NodeProbe, ADriveThatFellSilentHasNoSpeed) {
  start();
  bench.drive[2].silent = true;
  bench.cycle();
  bench.drive[2].silent = false;
  edge();
  const ReadPoint point = take();
  EXPECT_EQ(point.verdict, TouchVerdict::no_velocity);
  EXPECT_EQ(point.axis, 2U);
}

TEST_F(NodeProbe, AnUnreferencedAxisHasNoPoint) {
  start();
  bench.drive[0].status = 0x0027;
  edge();
  EXPECT_EQ(take().verdict, TouchVerdict::not_homed);
}

// --- the queue

TEST_F(NodeProbe, PointsWaitInTheirOrder) {
  start();
  for (int i = 0; i < 5; ++i)
    edge();
  EXPECT_EQ(bench.number(0x2400, 1), 5U);
  EXPECT_EQ(oldest().sequence, 1U) << "reading takes nothing away";
  EXPECT_EQ(bench.set<std::uint32_t>(0x2411, 0, 2), AbortCode::invalid_value);
  for (std::uint32_t i = 1; i <= 5; ++i)
    EXPECT_EQ(take().sequence, i);
  Bytes nothing;
  EXPECT_EQ(bench.read({0x2410, 1}, nothing), AbortCode::no_data);
  EXPECT_EQ(bench.set<std::uint32_t>(0x2411, 0, 5), AbortCode::invalid_value);
}

TEST_F(NodeProbe, WhatFindsNoRoomIsCounted) {
  start();
  constexpr auto kRoom = static_cast<std::uint32_t>(PointFifo::kCapacity);
  for (std::uint32_t i = 0; i < kRoom; ++i)
    edge();
  EXPECT_EQ(bench.number(0x2400, 2), 0U);
  EXPECT_FALSE(bench.emergency(ErrorCode::point_lost, 0));
  edge();
  edge();
  EXPECT_EQ(bench.number(0x2400, 2), 2U);
  EXPECT_TRUE(bench.emergency(ErrorCode::point_lost, 0));
  for (std::uint32_t i = 1; i <= kRoom; ++i)
    EXPECT_EQ(take().sequence, i) << "none of those that waited was overwritten";
  edge();
  EXPECT_EQ(take().sequence, kRoom + 3) << "the gap shows";
}

// --- settings

TEST_F(NodeProbe, BadSettingsLeaveTheGoodOnes) {
  start();
  ASSERT_EQ(set_real(0x2302, 1, 2e6), AbortCode::none);
  ASSERT_EQ(switch_on(), AbortCode::none);
  ASSERT_EQ(set_real(0x2310, 2, 1.0), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2310, 1, 1), AbortCode::none);
  edge();
  const ReadPoint before = take();

  for (const oracle::ProbeSettingCase& bad : oracle::probe_setting_cases()) {
    SCOPED_TRACE(::testing::Message()
                 << std::hex << bad.index << ":" << unsigned{bad.sub} << " " << bad.wrong);
    const std::uint64_t raw = bench.number(bad.index, bad.sub);
    double before_that = 0.0;
    std::memcpy(&before_that, &raw, sizeof before_that);
    ASSERT_EQ(set_real(bad.index, bad.sub, bad.wrong), AbortCode::none);
    EXPECT_EQ(switch_on(), AbortCode::invalid_value);
    EXPECT_EQ(bench.number(0x2300, 5), static_cast<std::uint64_t>(bad.reason));
    edge();
    const ReadPoint point = take();
    EXPECT_EQ(point.verdict, TouchVerdict::point);
    EXPECT_LT(std::abs(point.workpiece[0] - before.workpiece[0]), 20'000) << "still in force";
    ASSERT_EQ(set_real(bad.index, bad.sub, bad.right), AbortCode::none);
    EXPECT_EQ(switch_on(), AbortCode::none);
    ASSERT_EQ(set_real(bad.index, bad.sub, before_that), AbortCode::none);
    EXPECT_EQ(switch_on(), AbortCode::none);
  }
  EXPECT_EQ(switch_on(), AbortCode::none);
  EXPECT_EQ(bench.number(0x2300, 5), 0U);
}

TEST_F(NodeProbe, DelaysAreThoseOfRadioProbes) {
  start();
  for (const ObjectId delay : {ObjectId{0x2300, 2}, ObjectId{0x2301, 1}, ObjectId{0x2301, 5}}) {
    EXPECT_EQ(bench.set<std::uint32_t>(delay.index, delay.sub, oracle::kLongestProbeDelay_ns + 1),
              AbortCode::value_too_high);
    EXPECT_EQ(bench.set<std::uint32_t>(delay.index, delay.sub, oracle::kLongestProbeDelay_ns),
              AbortCode::none);
  }
  EXPECT_EQ(switch_on(), AbortCode::none);
}

TEST_F(NodeProbe, WithoutACyclePeriodItIsNotSwitchedOn) {
  start();
  const std::uint64_t period_us = bench.number(0x1006, 0);
  bench.nmt(canopen::NmtCommand::enter_pre_operational);
  for (const std::uint32_t none : {0U, 1U, 249U}) {  // two frames take as long at 1 Mbit/s
    ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, none), AbortCode::none);
    EXPECT_EQ(switch_on(), AbortCode::invalid_value);
    EXPECT_EQ(bench.number(0x2300, 5), static_cast<std::uint64_t>(Reason::bad_setting));
  }
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, static_cast<std::uint32_t>(period_us)),
            AbortCode::none);
  EXPECT_EQ(switch_on(), AbortCode::none);
}

TEST_F(NodeProbe, ANormalIsAUnitVectorOrNothing) {
  start();
  const auto take_over = [&] { return bench.set<std::uint32_t>(0x2310, 1, 1); };
  for (const double bad : {0.5, 1.001, std::numeric_limits<double>::quiet_NaN()}) {
    ASSERT_EQ(set_real(0x2310, 2, bad), AbortCode::none);
    EXPECT_EQ(take_over(), AbortCode::invalid_value) << bad;
  }
  ASSERT_EQ(set_real(0x2310, 2, 0.0), AbortCode::none);
  EXPECT_EQ(take_over(), AbortCode::none);
}

}  // namespace
}  // namespace volcomp::node
