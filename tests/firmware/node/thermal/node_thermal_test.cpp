// Temperatures and the date over the bus: which are believed, what they do to the offsets, and when
// tables are too old.

#include <cmath>

#include "comp/core/bytes.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;

constexpr double kSteel_per_K = 11.7e-6;
constexpr auto kSteel = static_cast<float>(kSteel_per_K);
constexpr std::int64_t k2030 = 1'893'456'000;  // 1 January 2030, 00:00 UTC
constexpr std::uint16_t kDay2030 = 16802;      // since 1 January 1984, as TIME counts
constexpr std::uint32_t kHour_ms = 3'600'000;

// X grows from −500 on, Z from 0; Y keeps its length. The drives of the bench stand at −100.
MachineTables growing_tables(std::uint64_t seed = 0) {
  MachineTables t = bench_tables(seed);
  t.provenance.temperature_C = 20.0F;
  t.expansion[0] = {kSteel, -500.0F, 0};
  t.expansion[2] = {kSteel, 0.0F, 2};
  return t;
}

class NodeThermal : public ::testing::Test {
 protected:
  // TPDO2 of the controller, 127.
  void warm(double first, double second, double third, double fourth = -327.68) {
    hal::CanFrame f = bench_frame(0x2FF, 8);
    const std::array<double, 4> celsius{first, second, third, fourth};
    for (std::size_t i = 0; i < 4; ++i)
      store_le(&f.data[2 * i], 2, static_cast<std::uint16_t>(std::lround(100.0 * celsius[i])));
    bench.give(f);
  }
  // CANopen TIME.
  void time(std::uint32_t midnight_ms, std::uint16_t days) {
    hal::CanFrame f = bench_frame(0x100, 6);
    store_le(f.data.data(), 4, midnight_ms);
    store_le(&f.data[4], 2, days);
    bench.give(f);
  }
  // Long enough for the node to look, to fold and to ramp.
  void settle() { bench.cycles(600); }
  std::uint8_t input(std::uint8_t number) {
    return static_cast<std::uint8_t>(bench.number(0x2701, number));
  }
  ThermalState state() { return static_cast<ThermalState>(bench.number(0x2703, 1)); }

  NodeBench bench;
};

// 400 mm · 11.7e-6 · 3 K and −100 mm · 11.7e-6 · −2 K: the axes are sent back by what they grew.
TEST_F(NodeThermal, TheOffsetsTakeTheGrowthBack) {
  bench.bring_up(growing_tables());
  const auto cold = bench.offsets();
  bench.largest_step = 0;
  EXPECT_EQ(state(), ThermalState::following);
  warm(23.0, 50.0, 18.0);
  settle();
  const auto grown = bench.offsets();
  EXPECT_NEAR(grown[0] - cold[0], -14'040.0, 1.0);
  EXPECT_NEAR(grown[1], cold[1], 2);  // where the other two now stand
  EXPECT_NEAR(grown[2] - cold[2], -2'340.0, 1.0);
  EXPECT_LT(bench.largest_step, 1'400);  // a ramp of 20 cycles, not a step
  EXPECT_EQ(bench.number(0x2703, 3), 1U);
  EXPECT_EQ(state(), ThermalState::following);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_TRUE(bench.emergencies.empty());
}

TEST_F(NodeThermal, BeforeTheFirstTemperatureTheReferenceCounts) {
  NodeBench plain;
  plain.bring_up(bench_tables());
  bench.bring_up(growing_tables());
  settle();
  EXPECT_EQ(bench.offsets(), plain.offsets());
  EXPECT_EQ(input(1), 0);
  EXPECT_EQ(bench.number(0x2703, 3), 0U);
  EXPECT_TRUE(bench.emergencies.empty());
}

// Over the travel of X, 500 mm, 0.01 K is 58.5 nm.
TEST_F(NodeThermal, SmallChangesAreGathered) {
  ASSERT_EQ(bench.set<std::uint32_t>(0x2702, 1, 100), AbortCode::none);
  bench.bring_up(growing_tables());
  warm(20.01, 20.0, 20.0);
  settle();
  EXPECT_EQ(bench.number(0x2703, 3), 0U);
  EXPECT_EQ(bench.number(0x2703, 2), 58U);
  EXPECT_EQ(state(), ThermalState::following);
  warm(20.02, 20.0, 20.0);
  settle();
  EXPECT_EQ(bench.number(0x2703, 3), 1U);
  EXPECT_EQ(bench.number(0x2703, 2), 0U);
}

TEST_F(NodeThermal, WhatCannotBeTrueIsHeldAndTold) {
  bench.bring_up(growing_tables());
  warm(21.0, 20.0, 20.0);
  settle();
  const auto good = bench.offsets();
  for (const double wrong : {-327.68, 80.01, -20.01, 120.0, 60.0}) {
    warm(wrong, wrong, 20.0);
    settle();
    EXPECT_EQ(input(1), 3) << wrong;
    EXPECT_EQ(bench.offsets(), good) << wrong;
  }
  EXPECT_TRUE(bench.emergency(ErrorCode::temperature_held, 1));
  EXPECT_FALSE(bench.emergency(ErrorCode::temperature_held, 2));  // Y does not grow
  EXPECT_EQ(bench.number(0x1001, 0) & 0x08U, 0x08U);
  warm(21.0, 20.0, 20.0);
  settle();
  EXPECT_EQ(input(1), 1);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
}

TEST_F(NodeThermal, AMissingTemperatureIsHeldAndTold) {
  ASSERT_EQ(bench.set<std::uint16_t>(0x2702, 2, 2), AbortCode::none);
  bench.bring_up(growing_tables());
  warm(21.0, 20.0, 20.0);
  settle();
  const auto good = bench.offsets();
  bench.cycles(1500);  // 3 s
  EXPECT_EQ(input(1), 2);
  EXPECT_TRUE(bench.emergency(ErrorCode::temperature_held, 1));
  EXPECT_TRUE(bench.emergency(ErrorCode::temperature_held, 3));
  EXPECT_EQ(bench.offsets(), good);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  // Over SDO will do as well.
  ASSERT_EQ(bench.set<std::int16_t>(0x2700, 1, 2110), AbortCode::none);
  settle();
  EXPECT_EQ(input(1), 1);
  EXPECT_NEAR(bench.offsets()[0] - good[0], -400e6 * kSteel_per_K * 0.1, 1.0);
}

// The one buffer for images is needed for the next one: the axes keep the length they had.
TEST_F(NodeThermal, AnImageOnItsWayHoldsTheGrowth) {
  bench.bring_up(growing_tables());
  warm(21.0, 20.0, 20.0);
  settle();
  const auto before = bench.offsets();
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(growing_tables())), AbortCode::none);
  warm(22.0, 20.0, 20.0);
  settle();
  EXPECT_EQ(state(), ThermalState::held);
  EXPECT_EQ(bench.offsets(), before);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  settle();
  EXPECT_EQ(state(), ThermalState::following);
  EXPECT_NEAR(bench.offsets()[0] - before[0], -400e6 * kSteel_per_K, 1.0);
}

TEST_F(NodeThermal, TablesWithoutExpansionDoNotCare) {
  bench.bring_up();
  const auto before = bench.offsets();
  warm(23.0, 23.0, 23.0);
  settle();
  EXPECT_EQ(state(), ThermalState::off);
  EXPECT_EQ(bench.offsets(), before);
}

// --- date

// 1 January 2000 is 5844 days after 1 January 1984, and 946684800 s after 1970 (date -u -d @…).
TEST_F(NodeThermal, TimeIsThatOfTheBus) {
  EXPECT_EQ(bench.number(0x1012, 0), 0x8000'0100U);
  EXPECT_EQ(bench.number(0x2704, 1), 0U);
  time(0xF000'0000U + 3'600'000U, 5844);  // reserved bits set, one in the morning
  EXPECT_EQ(bench.number(0x2704, 1), 946'688'400U);
  bench.wait(10'000'000);
  EXPECT_NEAR(static_cast<double>(bench.number(0x2704, 1)), 946'688'410.0, 1.0);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2704, 1, 1'000'000'000), AbortCode::none);
  bench.wait(2'000'000);
  EXPECT_NEAR(static_cast<double>(bench.number(0x2704, 1)), 1'000'000'002.0, 1.0);
}

// One frame of anybody would otherwise make every image with an expiry refused.
TEST_F(NodeThermal, ATimeThatJumpsIsNotBelieved) {
  bench.bring_up();
  time(0, kDay2030 - 100);
  bench.wait(10'000'000);
  time(0, kDay2030 + 1826);
  bench.wait(1'000'000);
  EXPECT_NEAR(static_cast<double>(bench.number(0x2704, 1)), k2030 - 100.0 * 86'400 + 11, 1.0);
  EXPECT_TRUE(bench.emergency(ErrorCode::time_doubted, 0));
  MachineTables tables = growing_tables();
  tables.provenance.expires_unix_s = k2030;
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(tables)), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  // The good one takes the complaint back.
  EXPECT_NE(bench.number(0x1001, 0), 0U);
  time(12'000, kDay2030 - 100);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
}

// A clock that was set, a new battery, a node with a foreign first TIME.
TEST_F(NodeThermal, AThirdTimeInARowThatGoesOnIsBelieved) {
  time(0, kDay2030 - 100);
  for (std::uint32_t second = 0; second < 30; second += 10) {
    EXPECT_LT(bench.number(0x2704, 1), k2030 - 99 * 86'400);
    time(second * 1000, kDay2030);
    bench.wait(10'000'000);
  }
  EXPECT_NEAR(static_cast<double>(bench.number(0x2704, 1)), k2030 + 30.0, 1.0);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
}

TEST_F(NodeThermal, JumpsThatDoNotGoOnAreNeverBelieved) {
  time(0, kDay2030);
  for (std::uint16_t i = 1; i < 20; ++i) {
    time(0, static_cast<std::uint16_t>(kDay2030 + 10 * i));  // every one on another day
    bench.wait(1'000'000);
    EXPECT_LT(bench.number(0x2704, 1), k2030 + 60);
  }
  for (std::uint32_t i = 0; i < 20; ++i) {  // the good one between
    time(i * 1000, kDay2030 + 365);
    time((i + 19) * 1000, kDay2030);
    bench.wait(1'000'000);
    EXPECT_LT(bench.number(0x2704, 1), k2030 + 60);
  }
}

// Some producers send local time.
TEST_F(NodeThermal, SummerTimeIsNoJump) {
  time(2 * kHour_ms, kDay2030);
  time(3 * kHour_ms, kDay2030);
  EXPECT_EQ(bench.number(0x2704, 1), k2030 + 3 * 3600);
  time(2 * kHour_ms, kDay2030);
  EXPECT_EQ(bench.number(0x2704, 1), k2030 + 2 * 3600);
  bench.wait(1'000'000);
  EXPECT_TRUE(bench.emergencies.empty());
}

TEST_F(NodeThermal, ATimeWrittenOverSdoIsBelieved) {
  time(0, kDay2030);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2704, 1, 1'000'000'000), AbortCode::none);
  EXPECT_EQ(bench.number(0x2704, 1), 1'000'000'000U);
}

TEST_F(NodeThermal, ExpiredTablesAreRefusedOnceTheDateIsKnown) {
  MachineTables old = growing_tables();
  old.provenance.expires_unix_s = k2030;
  bench.bring_up(growing_tables());
  const auto before = bench.offsets();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2704, 1, k2030), AbortCode::none);
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(old)), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  EXPECT_EQ(bench.number(0x2112, 2), static_cast<std::uint8_t>(Reason::expired));
  EXPECT_EQ(bench.text(0x2112, 6), sentence(Reason::expired));
  EXPECT_TRUE(bench.emergency(ErrorCode::table_refused, 0));
  settle();
  EXPECT_EQ(bench.offsets(), before);
  // A second earlier they were still good.
  ASSERT_EQ(bench.set<std::uint32_t>(0x2704, 1, k2030 - 100), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_EQ(bench.number(0x2704, 2), static_cast<std::uint64_t>(k2030));
}

TEST_F(NodeThermal, TablesThatExpireWhileActiveGoOnWithAWarning) {
  MachineTables tables = growing_tables();
  tables.provenance.expires_unix_s = k2030;
  bench.bring_up(tables);
  const auto before = bench.offsets();
  time(86'399'000U, kDay2030 - 1);  // 31 December 2029, 23:59:59
  bench.cycles(250);
  EXPECT_EQ(bench.number(0x2704, 3), 0U);
  bench.cycles(1000);
  EXPECT_EQ(bench.number(0x2704, 3), 1U);
  EXPECT_TRUE(bench.emergency(ErrorCode::tables_expired, 0));
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_EQ(bench.offsets(), before);
  // They still follow the temperature.
  warm(21.0, 20.0, 20.0);
  settle();
  EXPECT_NEAR(bench.offsets()[0] - before[0], -400e6 * kSteel_per_K, 1.0);
}

}  // namespace
}  // namespace volcomp::node
