// volcomp drive check --try against simulated drives that take what the EDS of real ones grants:
// the answers, what is written, and that the drive is as it was however the command ends.

#include <gmock/gmock.h>

#include <cstring>

#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/bus/drive_check/drive_ready.hpp"
#include "host_sim/host/bus/drive_check/mapping_trial.hpp"
#include "host_sim/host/bus/drive_check/offset_move.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/drive_bench.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;
using sim::complaint_of;
using testing::HasSubstr;
using testing::IsEmpty;

// The process is gone: nothing of it runs any more.
struct Killed {};

// All that a drive holds.
struct DriveState {
  explicit DriveState(sim::Cia402Drive& drive) : objects(sizeof(Cia402Objects)) {
    std::memcpy(objects.data(), &drive.objects(), objects.size());
    for (const canopen::Pdo& pdo : drive.device().pdos().receive())
      receive.push_back(pdo.parameters());
    for (const canopen::Pdo& pdo : drive.device().pdos().transmit())
      transmit.push_back(pdo.parameters());
  }
  std::vector<std::uint8_t> objects;
  std::vector<canopen::PdoParameters> receive;
  std::vector<canopen::PdoParameters> transmit;
};

bool same(const canopen::PdoParameters& a, const canopen::PdoParameters& b) {
  return a.cob_id == b.cob_id && a.type == b.type && a.inhibit_100us == b.inhibit_100us &&
         a.event_timer_ms == b.event_timer_ms && a.count == b.count && a.mapping == b.mapping;
}

bool same(const std::vector<canopen::PdoParameters>& a,
          const std::vector<canopen::PdoParameters>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const DriveState& a, const DriveState& b) {
  return a.objects == b.objects && same(a.receive, b.receive) && same(a.transmit, b.transmit);
}

// A valid PDO is one that nobody has touched.
bool no_trial_is_valid(const DriveState& before, const DriveState& now) {
  const auto untouched = [](const auto& was, const auto& is) {
    return (is.cob_id & canopen::kPdoInvalid) != 0 || same(was, is);
  };
  return std::equal(before.receive.begin(), before.receive.end(), now.receive.begin(), untouched) &&
         std::equal(before.transmit.begin(), before.transmit.end(), now.transmit.begin(),
                    untouched);
}

// Thousands of journals: in memory where there is such a place.
std::filesystem::path quick_place() {
  const std::filesystem::path memory = "/dev/shm";
  std::error_code none;
  return std::filesystem::is_directory(memory, none) ? memory
                                                     : std::filesystem::temp_directory_path();
}

// A drive of a profile on a bus, the process of a tool, and its journal.
class TrialBench {
 public:
  explicit TrialBench(const std::string& profile_name, sim::Cia402Drive::Settings settings = {})
      : drive(with_profile(profile_name, std::move(settings))) {
    bus.attach(drive, "drive");
    bus.attach_served("tool", [this](sim::SimulatedBus::Port& port, std::uint64_t now_us) {
      canopen::exchange(*tool, port, now_us);
    });
    start_process();
    drive.power_on(0);
    run_ms(3);
    read = read_drive(*tool);
    identity = read_identity(*tool);
    before.emplace(drive);
    bus.bus().set_observer([this](std::uint64_t, const hal::CanFrame& frame,
                                  const hal::LoopbackBus::Port&) { observe(frame); });
  }

  static sim::Cia402Drive::Settings with_profile(const std::string& name,
                                                 sim::Cia402Drive::Settings settings) {
    settings.node_id = kDrive;
    if (!name.empty()) settings.profile = profile(name);
    return settings;
  }

  void start_process() {
    killed_after = kNever;
    tool = std::make_unique<NodeClient>(kDrive, [this](NodeClient&) {
      if (killed_after == 0) throw Killed();
      run_ms(1);
      return bus.now_us();
    });
  }

  void run_ms(std::uint64_t ms) { bus.run_until(bus.bus().now_ns() + ms * 1'000'000U); }

  // Requests that write: expedited downloads begin with 001.
  void observe(const hal::CanFrame& frame) {
    if (frame.id == 0x600 + kDrive && frame.data[0] >> 5U == 1)
      written.insert(static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8U));
    if (frame.id == 0x600 + kDrive || frame.id == 0x580 + kDrive) ++sdo_frames;
    if (killed_after > 0 && killed_after != kNever) --killed_after;
    always_invalid = always_invalid && no_trial_is_valid(*before, DriveState(drive));
  }

  [[nodiscard]] DriveChanges changes(const DriveChanges::Check& check = {}) {
    return DriveChanges(*tool, journal(), {"can0", kDrive, identity}, check);
  }
  [[nodiscard]] std::filesystem::path journal() const { return folder.path() / "can0-3.journal"; }

  TriedMappings try_all(const DriveChanges::Check& check = {}) {
    DriveChanges all = changes(check);
    return try_mappings(all, read, pdos_for_trial(read, {}));
  }

  // What any command does first, in a new process.
  Restored call_again() {
    start_process();
    auto left = DriveJournal::open(journal());
    return left ? restore(*tool, *left) : Restored{};
  }

  [[nodiscard]] bool is_as_before() { return same(*before, DriveState(drive)); }

  static constexpr std::size_t kNever = SIZE_MAX;
  TemporaryFolder folder{quick_place()};
  sim::SimulatedBus bus;
  sim::Cia402Drive drive;
  std::unique_ptr<NodeClient> tool;
  ForeignDrive read;
  std::array<std::uint32_t, 4> identity{};
  std::optional<DriveState> before;
  std::set<std::uint16_t> written;
  std::size_t killed_after = kNever;  // frames
  std::size_t sdo_frames = 0;
  bool always_invalid = true;
};

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

TEST(MappingTrials, AJournalThatCannotBeWrittenLetsNothingBeWritten) {
  TrialBench bench("eyou");
  DriveChanges changes(*bench.tool, "/proc/none/can0-3.journal", {"can0", kDrive, bench.identity});
  EXPECT_THROW(static_cast<void>(try_mappings(changes, bench.read, pdos_for_trial(bench.read, {}))),
               UserError);
  EXPECT_THAT(bench.written, IsEmpty());
}

// --- --move

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
