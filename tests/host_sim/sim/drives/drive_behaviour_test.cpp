// What no data sheet tells of a drive, one by one: the frames are the same, what the axis does is
// not.

#include <gtest/gtest.h>

#include "host_sim/host/bus/device_files/eds_file.hpp"
#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint16_t kEnable = 0x0F;
constexpr std::uint16_t kSwitchOn = 0x07;

Cia402Drive::Settings behaving(const DriveBehaviour& behaviour) {
  Cia402Drive::Settings settings = Bench::node_three();
  settings.behaviour = behaviour;
  return settings;
}

// Disabled at 1000, moved to 4000 by hand, enabled without a new target.
std::int64_t demand_after_enabling(DriveBehaviour::AtEnabling at_enabling) {
  DriveBehaviour behaviour;
  behaviour.at_enabling = at_enabling;
  Bench bench(behaving(behaviour));
  bench.enable();
  bench.cycle(kEnable, 1000);
  bench.cycle(kSwitchOn, 1000);
  bench.drive.stand_at(4000);
  bench.give(0x603, {0x2B, 0x40, 0x60, 0x00, 0x0F, 0x00, 0x00, 0x00});  // 6040h by SDO, alone
  bench.sync();
  bench.sync();
  return bench.drive.demand();
}

TEST(DriveBehaviour, AtEnablingTheAxisStandsOrGoesToTheOldTarget) {
  EXPECT_EQ(demand_after_enabling(DriveBehaviour::AtEnabling::stands), 4000);
  EXPECT_EQ(demand_after_enabling(DriveBehaviour::AtEnabling::keeps_target), 1000);
}

// Targets 100, 200, 300; then none for five SYNCs.
std::vector<std::int64_t> without_targets(Bench& bench) {
  bench.enable();
  for (const std::int32_t target : {100, 200, 300})
    bench.cycle(kEnable, target);
  std::vector<std::int64_t> demands;
  for (int i = 0; i < 5; ++i) {
    bench.sync();
    demands.push_back(bench.drive.demand());
  }
  return demands;
}

TEST(DriveBehaviour, AMissingTargetIsHeld) {
  Bench bench;
  EXPECT_EQ(without_targets(bench), (std::vector<std::int64_t>{300, 300, 300, 300, 300}));
}

TEST(DriveBehaviour, AMissingTargetIsExtrapolated) {
  DriveBehaviour behaviour;
  behaviour.missing_target = DriveBehaviour::MissingTarget::extrapolated;
  behaviour.patience = 2;
  Bench bench(behaving(behaviour));
  EXPECT_EQ(without_targets(bench), (std::vector<std::int64_t>{400, 500, 500, 500, 500}));
  bench.cycle(kEnable, 450);
  EXPECT_EQ(bench.drive.demand(), 450);
}

TEST(DriveBehaviour, AMissingTargetIsAFault) {
  DriveBehaviour behaviour;
  behaviour.missing_target = DriveBehaviour::MissingTarget::fault;
  behaviour.patience = 2;
  Bench bench(behaving(behaviour));
  without_targets(bench);
  EXPECT_NE(bench.drive.power_state(), host::PowerState::operation_enabled);
  ASSERT_FALSE(bench.emergencies.empty());
  EXPECT_EQ(bench.emergencies.back().data[0], 0x50);  // 8250h
  EXPECT_EQ(bench.emergencies.back().data[1], 0x82);
}

// 140xh:05 of a drive that extrapolates meanwhile.
TEST(DriveBehaviour, ATimerMakesAFaultOfTheThirdMissingTarget) {
  DriveBehaviour behaviour;
  behaviour.missing_target = DriveBehaviour::MissingTarget::extrapolated;
  behaviour.target_timer = 3;
  Bench bench(behaving(behaviour));
  const std::vector<std::int64_t> demands = without_targets(bench);
  EXPECT_EQ(demands[0], 400);
  EXPECT_EQ(demands[1], 500);
  EXPECT_NE(bench.drive.power_state(), host::PowerState::operation_enabled);
  ASSERT_EQ(bench.emergencies.size(), 1U);
  EXPECT_EQ(bench.emergencies.back().data[0], 0x50);  // 8250h
}

// 6066h: above 6065h for longer than that. A period is 1 ms, the lag of the axis a few.
TEST(DriveBehaviour, AFollowingErrorIsAFaultAfterItsTimeOut) {
  for (const std::uint16_t timeout_ms : {std::uint16_t{0}, std::uint16_t{2}}) {
    Cia402Drive::Settings settings = Bench::node_three();
    settings.following_window = 100;
    settings.following_timeout_ms = timeout_ms;
    Bench bench(settings);
    bench.enable();
    bench.cycle(kEnable, 100'000);
    EXPECT_EQ(bench.emergencies.empty(), timeout_ms != 0);
    bench.cycle(kEnable, 100'000);
    bench.cycle(kEnable, 100'000);
    EXPECT_EQ(bench.emergencies.size(), 1U);
  }
}

// {6040h} alone out of a frame of six bytes, or {6040h, 4 × 0005h}.
TEST(DriveBehaviour, AFrameThatIsLongerThanMappedIsUsedOrAnError) {
  for (const bool exact : {false, true}) {
    for (const bool filled : {false, true}) {
      DriveBehaviour behaviour;
      behaviour.exact_length = exact;
      Bench bench(behaving(behaviour));
      bench.give(0x000, {0x80, 0x03});  // PRE-OPERATIONAL
      ASSERT_EQ(bench.write(0x1400, 1, 0x8000'0203, 4), 0U);
      ASSERT_EQ(bench.write(0x1600, 0, 0, 1), 0U);
      ASSERT_EQ(bench.write(0x1600, 1, 0x6040'0010, 4), 0U);
      for (std::uint8_t i = 2; filled && i <= 5; ++i)
        ASSERT_EQ(bench.write(0x1600, i, 0x0005'0008, 4), 0U);
      ASSERT_EQ(bench.write(0x1600, 0, filled ? 5 : 1, 1), 0U);
      ASSERT_EQ(bench.write(0x1400, 1, 0x0000'0203, 4), 0U);
      bench.give(0x000, {0x01, 0x03});
      bench.cycle(0x06, 0);
      const bool heard = !exact || filled;
      EXPECT_EQ(bench.drive.objects().controlword, heard ? 0x06 : 0);
      ASSERT_EQ(bench.emergencies.size(), heard ? 0U : 1U);
      for (const hal::CanFrame& emergency : bench.emergencies)
        EXPECT_EQ(emergency.data[0], 0x20);  // 8220h
    }
  }
}

// RPDO1 of type 255: the controlword acts when it comes; the position loop still waits for SYNC.
TEST(DriveBehaviour, ATargetActsAtSyncOrAtReception) {
  for (const bool at_reception : {false, true}) {
    DriveBehaviour behaviour;
    if (at_reception) behaviour.target_acts = DriveBehaviour::TargetActs::at_reception;
    Bench bench(behaving(behaviour));
    ASSERT_EQ(bench.write(0x1400, 2, 255, 1), 0U);
    bench.enable();
    bench.command(kEnable, 5000);
    EXPECT_EQ(bench.drive.demand(), at_reception ? 5000 : 0);
    bench.sync();
    EXPECT_EQ(bench.drive.demand(), 5000);
  }
}

TEST(DriveBehaviour, AControlwordActsAtSyncOrAtReceptionByTheTypeOfItsRpdo) {
  for (const int type : {1, 255}) {
    Bench bench;
    ASSERT_EQ(bench.write(0x1400, 2, type, 1), 0U);
    bench.enable();
    bench.command(kSwitchOn, 0);
    EXPECT_EQ(bench.drive.power_state() == host::PowerState::switched_on, type == 255);
    bench.sync();
    EXPECT_EQ(bench.drive.power_state(), host::PowerState::switched_on);
  }
}

TEST(DriveBehaviour, ATargetBeyondTheSoftwareLimitIsClippedOrAFault) {
  for (const bool fault : {false, true}) {
    DriveBehaviour behaviour;
    if (fault) behaviour.beyond_limit = DriveBehaviour::BeyondLimit::fault;
    Cia402Drive::Settings settings = behaving(behaviour);
    settings.software_max = 2000;
    Bench bench(settings);
    bench.enable();
    bench.cycle(kEnable, 2000);
    EXPECT_TRUE(bench.emergencies.empty());
    bench.cycle(kEnable, 2001);
    EXPECT_LE(bench.drive.demand(), 2000);
    ASSERT_EQ(bench.emergencies.size(), fault ? 1U : 0U);
    for (const hal::CanFrame& emergency : bench.emergencies)
      EXPECT_EQ(emergency.data[0], 0x12);  // 8612h
  }
}

// 607Bh = -500…499: 600 is -400, and from 450 it is 150 ahead.
TEST(DriveBehaviour, PositionsWrapInTheirRange) {
  DriveBehaviour behaviour;
  behaviour.range = PositionRange{-500, 499};
  Bench bench(behaving(behaviour));
  bench.enable();
  for (const std::int32_t target : {200, 450, -400})
    bench.cycle(kEnable, target);
  EXPECT_EQ(bench.drive.demand(), 600);
  EXPECT_EQ(bench.drive.objects().demand, -400);
  for (int i = 0; i < 60; ++i)
    bench.cycle(kEnable, -400);
  EXPECT_EQ(bench.drive.objects().actual, -400);
  EXPECT_EQ(behaviour.range->inside(-501), 499);
  EXPECT_EQ(behaviour.range->shortest(-850), 150);
}

// An EPOS4 hears {6040h, 6060h} on 300h + n until it is mapped, and after every reset again.
TEST(DriveBehaviour, TheMappingOfTheDataSheetIsBackAfterBootUp) {
  Cia402Drive::Settings settings = Bench::node_three();
  settings.profile = std::make_shared<const DriveProfile>(host::find_drive_eds("epos4_0170"));
  Bench bench(settings);
  EXPECT_EQ(bench.read(0x1601, 1), 0x6040'0010U);
  ASSERT_EQ(bench.write(0x1401, 1, 0x8000'0303, 4), 0U);
  ASSERT_EQ(bench.write(0x1601, 0, 0, 1), 0U);
  ASSERT_EQ(bench.write(0x1601, 1, 0x60B0'0020, 4), 0U);
  ASSERT_EQ(bench.write(0x1601, 0, 1, 1), 0U);
  EXPECT_EQ(bench.read(0x1601, 1), 0x60B0'0020U);
  bench.give(0x000, {0x82, Bench::kNode});  // NMT: reset communication
  bench.wait(1000);
  EXPECT_EQ(bench.read(0x1601, 1), 0x6040'0010U);
  EXPECT_EQ(bench.read(0x1601, 0), 2U);
}

}  // namespace
}  // namespace volcomp::sim
