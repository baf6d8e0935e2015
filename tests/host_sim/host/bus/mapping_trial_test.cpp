// volcomp drive check --try against simulated drives that take what the EDS of real ones grants:
// the answers, what is written, and that the drive is as it was however the command ends.

#include <gmock/gmock.h>

#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/trial_bench.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;
using sim::complaint_of;
using testing::HasSubstr;
using testing::IsEmpty;

class MappingTrial : public testing::TestWithParam<const char*> {
 protected:
  TrialBench bench{GetParam()};
  EdsFile eds = find_drive_eds(GetParam());
};

TEST_P(MappingTrial, SaysWhatTheEdsGrants) {
  const TriedMappings tried = bench.try_all();
  const auto grants = [this](PdoKind kind, std::uint16_t index) {
    const EdsFileObject* const object = eds.find({index, 0});
    return object != nullptr && (kind == PdoKind::receive ? object->to_rpdo : object->to_tpdo);
  };
  const bool has_offset = eds.find({0x60B0, 0}) != nullptr;
  for (const PdoKind kind : {PdoKind::receive, PdoKind::transmit}) {
    const auto offset = tried.took(kind, {kOffsetEntry});
    EXPECT_EQ(offset.has_value(), has_offset);
    EXPECT_EQ(offset.value_or(false), grants(kind, 0x60B0));
  }
  EXPECT_EQ(tried.took(PdoKind::receive, control_alone()), true);
  EXPECT_EQ(tried.took(PdoKind::receive, {kTargetEntry}), grants(PdoKind::receive, 0x607A));
  EXPECT_EQ(tried.took(PdoKind::transmit, {kModeEntry}), grants(PdoKind::transmit, 0x6061));
  EXPECT_TRUE(tried.rpdo_at_sync);
  EXPECT_TRUE(tried.tpdo_at_sync);
}

// DummyUsage of the EDS files, read by a person: Elmo has UNSIGNED8 only, EPOS4 and Trinamic none.
TEST_P(MappingTrial, TakesThePlaceholdersOfTheEds) {
  const std::string name = GetParam();
  const bool none = name == "epos4_0150" || name == "epos4_0170" || name == "trinamic_tmcm1270";
  const TriedMappings tried = bench.try_all();
  EXPECT_EQ(tried.took(PdoKind::receive, control_and_single_bytes()), !none);
  EXPECT_EQ(tried.took(PdoKind::receive, control_and_four_bytes()), !none && name != "elmo_gold");
}

TEST_P(MappingTrial, LeavesTheDriveAsItWas) {
  const TriedMappings tried = bench.try_all();
  EXPECT_TRUE(bench.is_as_before());
  EXPECT_TRUE(bench.always_invalid);
  EXPECT_FALSE(std::filesystem::exists(bench.journal()));
  const auto rpdo = static_cast<std::uint16_t>(tried.rpdo - 1);
  const auto tpdo = static_cast<std::uint16_t>(tried.tpdo - 1);
  for (const std::uint16_t index : bench.written)
    EXPECT_TRUE(index == 0x1400 + rpdo || index == 0x1600 + rpdo || index == 0x1800 + tpdo ||
                index == 0x1A00 + tpdo)
        << std::hex << index;
}

// Ctrl-C or SIGTERM before each SDO in turn: the tool restores before it ends.
TEST_P(MappingTrial, ASignalAtEverySdoLeavesTheDriveAsItWas) {
  std::size_t interrupted = 0;
  for (bool ended = false; !ended; ++interrupted) {
    std::size_t left = interrupted;
    try {
      static_cast<void>(bench.try_all([&left] {
        if (left-- == 0) throw Interrupted(SIGINT);
      }));
      ended = true;
    } catch (const Interrupted& signal) {
      EXPECT_EQ(signal.signal, SIGINT);
    }
    ASSERT_TRUE(bench.is_as_before()) << interrupted;
    ASSERT_FALSE(std::filesystem::exists(bench.journal())) << interrupted;
  }
  EXPECT_GT(interrupted, 40U);
  EXPECT_TRUE(bench.always_invalid);
}

// Gone after each frame in turn, while it restores, too: the next call puts everything back.
TEST_P(MappingTrial, AKillAtEveryFrameIsMadeGoodByTheNextCall) {
  std::size_t killed = 1;
  std::size_t changed = 0;
  for (bool ended = false; !ended; ++killed) {
    bench.start_process();
    bench.killed_after = killed;
    try {
      static_cast<void>(bench.try_all());
      ended = true;
    } catch (const Killed&) {
      if (!bench.is_as_before()) ++changed;
    }
    static_cast<void>(bench.call_again());
    ASSERT_TRUE(bench.is_as_before()) << killed;
    ASSERT_FALSE(std::filesystem::exists(bench.journal())) << killed;
  }
  EXPECT_GT(changed, 40U);
  EXPECT_TRUE(bench.always_invalid);
}

// And killed again in the call that restores.
TEST_P(MappingTrial, ARestoringCallMayBeKilledToo) {
  for (std::size_t again = 1; again < 40; ++again) {
    bench.start_process();
    bench.killed_after = 60;
    EXPECT_THROW(static_cast<void>(bench.try_all()), Killed);
    bench.start_process();
    bench.killed_after = again;
    try {
      auto left = DriveJournal::open(bench.journal());
      if (left) static_cast<void>(restore(*bench.tool, *left));
    } catch (const Killed&) {  // as wanted
    }
    static_cast<void>(bench.call_again());
    ASSERT_TRUE(bench.is_as_before()) << again;
  }
  EXPECT_TRUE(bench.always_invalid);
}

// By trial the same verdict as by the data sheet.
TEST_P(MappingTrial, TheVerdictIsThatOfTheEds) {
  const DriveCheck by_eds = check_drive(read_drive(eds, kDrive), {});
  bench.read.tried = bench.try_all();
  const DriveCheck by_trial = check_drive(bench.read, {});
  EXPECT_EQ(by_trial.best, by_eds.best);
  EXPECT_EQ(by_trial.best_is_sure, true);
  EXPECT_EQ(by_trial.confirmed, by_eds.confirmed);
  const auto fact = [](const DriveCheck& check, const std::string& key) {
    const auto found = std::find_if(check.facts.begin(), check.facts.end(),
                                    [&key](const DriveFact& one) { return one.key == key; });
    return found == check.facts.end() ? DriveFact{} : *found;
  };
  EXPECT_EQ(fact(by_trial, "offset").value, fact(by_eds, "offset").value);
  EXPECT_THAT(fact(by_trial, "offset").objects, HasSubstr("tried in RPDO"));
  EXPECT_EQ(fact(by_trial, "forwarding").value, fact(by_eds, "forwarding").value);
  EXPECT_THAT(fact(by_trial, "forwarding").value, HasSubstr("yes: 6040h alone"));
}

INSTANTIATE_TEST_SUITE_P(Real, MappingTrial,
                         testing::Values("elmo_gold", "epos4_0150", "epos4_0170", "nanotec_cl4e",
                                         "trinamic_tmcm1270", "novanta_eve_net_c", "eyou"),
                         [](const auto& one) { return std::string(one.param); });

// What is in use is the last choice, and never what somebody sends to.
TEST(MappingTrials, UseThePdoThatIsMissedLeast) {
  const auto number_of = [](const char* name, const std::set<std::uint16_t>& heard = {}) {
    return pdos_for_trial(read_drive(find_drive_eds(name), kDrive), heard).receive.number;
  };
  EXPECT_EQ(number_of("nanotec_cl4e"), 8U);       // 1407h is invalid
  EXPECT_EQ(number_of("trinamic_tmcm1270"), 4U);  // so is 1403h
  EXPECT_EQ(number_of("elmo_gold"), 4U);          // maps nothing
  EXPECT_EQ(number_of("epos4_0170"), 4U);         // all are in use
  EXPECT_EQ(number_of("epos4_0170", {0x503}), 3U);
  EXPECT_THAT(complaint_of([&] {
                return number_of("epos4_0170", {0x503, 0x403, 0x303});
              }),
              HasSubstr("node 3 has no RPDO that is free for a trial"));
}

// Another drive in the place of the one that was tried is not written.
TEST(MappingTrials, AnotherDriveGetsNothingOfAJournal) {
  TrialBench bench("eyou");
  bench.killed_after = 60;
  EXPECT_THROW(static_cast<void>(bench.try_all()), Killed);
  bench.start_process();
  auto left = DriveJournal::open(bench.journal());
  ASSERT_TRUE(left);
  TrialBench other("nanotec_cl4e");
  try {
    static_cast<void>(restore(*other.tool, *left));
    FAIL() << "another drive was restored";
  } catch (const NotRestored& refused) {
    EXPECT_THAT(refused.what(), HasSubstr("another drive answers now (1018h)"));
    EXPECT_FALSE(refused.writes.empty());
  }
  EXPECT_THAT(other.written, IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(bench.journal()));
}

// After power-on nothing of the trial is left, and the controller may have set the PDO up.
TEST(MappingTrials, WhatSomebodyHasSetUpSinceIsLeftAlone) {
  TrialBench bench("eyou");
  bench.killed_after = 60;
  EXPECT_THROW(static_cast<void>(bench.try_all()), Killed);
  bench.start_process();
  bench.drive.power_off();
  bench.drive.power_on(bench.bus.now_us());
  bench.run_ms(3);
  bench.tool->write({0x1603, 1}, {0x20, 0, 0x7A, 0x60}, "entry");
  bench.tool->write({0x1603, 0}, {1}, "count");
  bench.tool->write({0x1403, 1}, {0x03, 0x05, 0, 0}, "COB-ID");
  const DriveState configured(bench.drive);
  EXPECT_EQ(bench.call_again().notes.size(), 1U);
  EXPECT_TRUE(same(configured, DriveState(bench.drive)));
  EXPECT_FALSE(std::filesystem::exists(bench.journal()));
}

TEST(MappingTrials, ASilentDriveKeepsItsJournal) {
  TrialBench bench("eyou");
  bench.killed_after = 60;
  EXPECT_THROW(static_cast<void>(bench.try_all()), Killed);
  bench.drive.power_off();
  EXPECT_THAT(complaint_of([&] { return bench.call_again(); }),
              HasSubstr("is not as it was found: node 3 does not answer"));
  EXPECT_TRUE(std::filesystem::exists(bench.journal()));
}

// A mapping is not changed under an axis that may move.
TEST(MappingTrials, AnEnabledDriveKeepsItsJournal) {
  TrialBench bench("eyou");
  bench.killed_after = 60;
  EXPECT_THROW(static_cast<void>(bench.try_all()), Killed);
  bench.start_process();
  for (const std::uint8_t word : std::initializer_list<std::uint8_t>{0x06, 0x07, 0x0F})
    bench.tool->write({0x6040, 0}, {word, 0}, "controlword");
  bench.written.clear();
  EXPECT_THAT(complaint_of([&] { return bench.call_again(); }),
              HasSubstr("its power stage is on: disable it first"));
  EXPECT_THAT(bench.written, IsEmpty());
  bench.tool->write({0x6040, 0}, {0, 0}, "controlword");
  EXPECT_GT(bench.call_again().objects, 0U);
  EXPECT_TRUE(same(bench.before->receive, DriveState(bench.drive).receive));
  EXPECT_TRUE(same(bench.before->transmit, DriveState(bench.drive).transmit));
}

TEST(MappingTrials, AJournalThatCannotBeWrittenLetsNothingBeWritten) {
  TrialBench bench("eyou");
  DriveChanges changes(*bench.tool, "/proc/none/can0-3.journal", {"can0", kDrive, bench.identity});
  EXPECT_THROW(static_cast<void>(try_mappings(changes, bench.read, pdos_for_trial(bench.read, {}))),
               UserError);
  EXPECT_THAT(bench.written, IsEmpty());
}

}  // namespace
}  // namespace volcomp::host
