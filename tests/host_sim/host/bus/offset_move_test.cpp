// volcomp drive check --move against simulated drives, and which drives may be written at all.

#include <gmock/gmock.h>

#include "host_sim/host/bus/drive_check/offset_move.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/trial_bench.hpp"

namespace volcomp::host {
namespace {

using sim::complaint_of;
using testing::HasSubstr;

sim::Cia402Drive::Settings with_idle_demand(std::int32_t times) {
  sim::Cia402Drive::Settings settings;
  settings.offset_in_idle_demand = times;
  return settings;
}

TEST(OffsetMove, TellsWhatTheOffsetDoes) {
  for (const auto& [times, meaning] :
       {std::pair{0, MovedDemand::unknown}, std::pair{1, MovedDemand::as_named},
        std::pair{-1, MovedDemand::otherwise}, std::pair{7, MovedDemand::otherwise}}) {
    TrialBench bench("nanotec_cl4e", with_idle_demand(times));
    DriveChanges changes = bench.changes();
    require_movable(*bench.tool, bench.read);
    EXPECT_EQ(move_offset(*bench.tool, changes, bench.read), meaning) << times;
    EXPECT_TRUE(bench.is_as_before());
    EXPECT_EQ(bench.written, std::set<std::uint16_t>{0x60B0});
    EXPECT_FALSE(std::filesystem::exists(bench.journal()));
  }
}

TEST(OffsetMove, AKillAtEveryFrameIsMadeGoodByTheNextCall) {
  TrialBench bench("elmo_gold", with_idle_demand(1));
  std::size_t changed = 0;
  std::size_t killed = 1;
  for (bool ended = false; !ended; ++killed) {
    bench.start_process();
    bench.killed_after = killed;
    try {
      DriveChanges changes = bench.changes();
      static_cast<void>(move_offset(*bench.tool, changes, bench.read));
      ended = true;
    } catch (const Killed&) {
      if (!bench.is_as_before()) ++changed;
    }
    static_cast<void>(bench.call_again());
    ASSERT_TRUE(bench.is_as_before()) << killed;
  }
  EXPECT_GT(changed, 8U);
}

TEST(OffsetMove, IsRefusedWhereTheObjectIsAnother) {
  TrialBench bench("elmo_gold");
  bench.read.objects[{0x60B0, 0}].bytes = 2;
  EXPECT_THAT(complaint_of([&] { return require_movable(*bench.tool, bench.read), 0; }),
              HasSubstr("60B0h of node 3 is no INTEGER32"));
  bench.read.objects.erase({0x60B0, 0});
  EXPECT_THAT(complaint_of([&] { return require_movable(*bench.tool, bench.read), 0; }),
              HasSubstr("is no INTEGER32"));
}

// An encoder that trembles is no answer.
TEST(OffsetMove, OnlyARegularChangeIsAnAnswer) {
  EXPECT_EQ(judge_demand({110, 90, 110, 90}), MovedDemand::as_named);
  EXPECT_EQ(judge_demand({111, 90, 109, 90}), MovedDemand::as_named);
  EXPECT_EQ(judge_demand({100, 100, 100, 100}), MovedDemand::unknown);
  EXPECT_EQ(judge_demand({100, 101, 99, 100}), MovedDemand::unknown);
  EXPECT_EQ(judge_demand({100, 80, 60, 40}), MovedDemand::unknown);
  EXPECT_EQ(judge_demand({-100, 100, -100, 100}), MovedDemand::otherwise);
}

// --- who may be written

// Switched on by hand, as a controller does it.
void enable(TrialBench& bench) {
  for (const std::uint8_t word : std::initializer_list<std::uint8_t>{0x06, 0x07, 0x0F})
    bench.tool->write({0x6040, 0}, {word, 0}, "controlword");
}

TEST(DriveReady, AnEnabledDriveIsNotWritten) {
  TrialBench bench("nanotec_cl4e");
  enable(bench);
  EXPECT_THAT(complaint_of([&] { return require_movable(*bench.tool, bench.read), 0; }),
              HasSubstr("the power stage of node 3 is on (6041h)"));
  EXPECT_THAT(complaint_of([&] {
                return require_ready(*bench.tool, bench.read, canopen::NmtState::boot_up, {}), 0;
              }),
              HasSubstr("the power stage of node 3 is on"));
}

TEST(DriveReady, AnOperationalDriveIsNotWritten) {
  TrialBench bench("nanotec_cl4e");
  bench.tool->write({0x1017, 0}, {10, 0}, "heartbeat");
  bench.read.objects[{0x1017, 0}].number = 10;
  require_ready(*bench.tool, bench.read, {}, {});
  bench.drive.device().enter(canopen::NmtState::operational, bench.bus.now_us());
  EXPECT_THAT(complaint_of([&] { return require_ready(*bench.tool, bench.read, {}, {}), 0; }),
              HasSubstr("node 3 is operational: it must be PRE-OPERATIONAL"));
}

// The first guarding frame starts life guarding where both factors are set.
TEST(DriveReady, AGuardingFrameGoesOnlyWhereItIsHarmless) {
  TrialBench bench("nanotec_cl4e");
  std::size_t sent = 0;
  const SendGuarding guard = [&sent] { return ++sent > 0; };
  const auto complaint = [&] {
    return complaint_of([&] { return require_ready(*bench.tool, bench.read, {}, guard), 0; });
  };
  EXPECT_THAT(complaint(), HasSubstr("no guarding frame was answered"));
  EXPECT_EQ(sent, 1U);
  bench.read.objects[{0x100C, 0}].number = 100;
  bench.read.objects[{0x100D, 0}].number = 3;
  EXPECT_THAT(complaint(), HasSubstr("a guarding frame would start its life guarding"));
  bench.read.objects[{0x1017, 0}].number = 10;
  EXPECT_THAT(complaint(), HasSubstr("its heartbeat is not heard"));
  bench.read.objects[{0x1017, 0}].number = 60'000;
  EXPECT_THAT(complaint(), HasSubstr("its heartbeat comes only every 60 s"));
  EXPECT_EQ(sent, 1U);
}

// A boot-up that was heard says PRE-OPERATIONAL.
TEST(DriveReady, ABootUpIsEnough) {
  TrialBench bench("nanotec_cl4e");
  EXPECT_EQ(complaint_of([&] {
              return require_ready(*bench.tool, bench.read, canopen::NmtState::boot_up, {}), 0;
            }),
            "accepted");
}

}  // namespace
}  // namespace volcomp::host
