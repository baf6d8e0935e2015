// volcomp drive check against simulated drives that have what the EDS of real ones grants, against
// the EDS themselves, and against nodes that are no help.

#include <gmock/gmock.h>

#include "firmware/node/node.hpp"
#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/bus/drive_check/drive_units.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/drive_bench.hpp"

namespace volcomp::host {
namespace {

using sim::complaint_of;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

DriveCheck check_simulated(const std::string& name, std::size_t* writing = nullptr) {
  sim::Cia402Drive::Settings settings;
  settings.node_id = kDrive;
  if (!name.empty()) settings.profile = profile(name);
  sim::Cia402Drive drive(settings);
  DriveBench bench(drive);
  drive.power_on(0);
  DriveCheck check = check_drive(read_drive(bench.client), {});
  if (writing != nullptr) *writing = bench.writing_frames();
  return check;
}

DriveCheck check_eds(const std::string& name) {
  return check_drive(read_drive(find_drive_eds(name), kDrive), {});
}

std::string value_of(const DriveCheck& check, const std::string& key) {
  for (const DriveFact& fact : check.facts) {
    if (fact.key == key) return fact.value;
  }
  return "no such fact";
}

// What the vendors' EDS grant (docs/drives.md).
struct Granted {
  const char* name;
  Way way;
  const char* offset;
  const char* probe;
  const char* sync;
  const char* watch;
};

// The name of a test does not depend on addresses.
void PrintTo(const Granted& granted, std::ostream* out) { *out << granted.name; }

class DriveProfiles : public testing::TestWithParam<Granted> {};

TEST_P(DriveProfiles, TheCheckOfTheEdsSaysWhatTheDriveLacks) {
  const Granted& granted = GetParam();
  const DriveCheck check = check_eds(granted.name);
  EXPECT_EQ(value_of(check, "device"), "yes");
  EXPECT_EQ(check.best, granted.way);
  EXPECT_EQ(value_of(check, "offset"), granted.offset);
  EXPECT_EQ(value_of(check, "probe"), granted.probe);
  EXPECT_EQ(value_of(check, "sync"), granted.sync);
  EXPECT_EQ(value_of(check, "watch"), granted.watch);
  EXPECT_FALSE(check.good());
}

// Over SDO the same, but where an object may be mapped nobody says.
TEST_P(DriveProfiles, TheDriveOnTheBusTellsTheSame) {
  const Granted& granted = GetParam();
  std::size_t writing = 1;
  const DriveCheck check = check_simulated(granted.name, &writing);
  EXPECT_EQ(writing, 0U);
  EXPECT_EQ(value_of(check, "device"), "yes");
  EXPECT_EQ(value_of(check, "probe"), granted.probe);
  EXPECT_EQ(value_of(check, "sync"), granted.sync);
  EXPECT_EQ(value_of(check, "watch"), granted.watch);
  const bool absent = std::string(granted.offset) == "absent";
  EXPECT_EQ(value_of(check, "offset"),
            absent ? "absent" : "there; whether a PDO takes it, only trying tells");
  EXPECT_EQ(check.best, absent ? granted.way : Way::offset);
  EXPECT_EQ(check.best_is_sure.has_value(), absent);
}

// No object beyond the EDS: the simulated drive answers 0602 0000h or 0609 0011h.
TEST_P(DriveProfiles, HaveNoObjectMoreThanTheirEds) {
  const EdsFile eds = find_drive_eds(GetParam().name);
  sim::Cia402Drive::Settings settings;
  settings.node_id = kDrive;
  settings.profile = profile(GetParam().name);
  sim::Cia402Drive drive(settings);
  for (const canopen::NamedEntry& entry : named_cia402_dictionary()) {
    for (unsigned sub = entry.first_sub; sub <= entry.last_sub; ++sub) {
      const canopen::ObjectId object{entry.index, static_cast<std::uint8_t>(sub)};
      const bool there = drive.device().objects().find(object).entry != nullptr;
      EXPECT_LE(there, eds.find(object) != nullptr) << std::hex << object.index << ":" << sub;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Real, DriveProfiles,
    testing::Values(Granted{"elmo_gold", Way::offset, "by PDO; not in a TPDO",
                            "latches, does not say when", "without counter", "2 heartbeats"},
                    Granted{"epos4_0150", Way::offset, "by PDO; not in a TPDO", "none",
                            "without counter", "2 heartbeats"},
                    Granted{"epos4_0170", Way::offset, "by PDO; not in a TPDO",
                            "latches, does not say when", "without counter", "2 heartbeats"},
                    Granted{"nanotec_cl4e", Way::offset, "by PDO; not in a TPDO", "none",
                            "with or without counter", "1 heartbeat, node guarding"},
                    Granted{"trinamic_tmcm1270", Way::forwarded_target, "by SDO only", "none",
                            "without counter", "1 heartbeat, node guarding"},
                    Granted{"novanta_eve_net_c", Way::forwarded_target, "absent", "none",
                            "without counter", "no heartbeat, node guarding"},
                    Granted{"eyou", Way::forwarded_target, "absent", "none",
                            "with or without counter", "5 heartbeats, node guarding"}),
    [](const auto& one) { return std::string(one.param.name); });

// 60B0h of the complete drive is mapped both ways from the beginning.
TEST(DriveCheck, TheCompleteDriveIsConfirmed) {
  const DriveCheck check = check_simulated("");
  EXPECT_EQ(check.best, Way::offset);
  EXPECT_EQ(check.best_is_sure, true);
  EXPECT_EQ(check.confirmed, true);
  EXPECT_EQ(value_of(check, "probe"), "latches, says when");
  EXPECT_THAT(check.missing, Contains(HasSubstr("1016h does not watch node 32")));
}

TEST(DriveCheck, ADriveThatWatchesTheNodeLacksNothing) {
  sim::Cia402Drive::Settings settings;
  settings.node_id = kDrive;
  sim::Cia402Drive drive(settings);
  DriveBench bench(drive);
  drive.power_on(0);
  bench.client.write({0x1016, 1}, {100, 0, 32, 0}, "watched node");
  const DriveCheck check = check_drive(read_drive(bench.client), {});
  EXPECT_THAT(check.missing, IsEmpty());
  EXPECT_TRUE(check.good());
}

// What listens where the node sends: four bytes of an offset would be a command there.
TEST(DriveCheck, WhatListensWhereTheOffsetGoesIsSaid) {
  EXPECT_THAT(
      check_eds("epos4_0170").warnings,
      Contains(HasSubstr("RPDO2 hears 303h: an offset there would be taken for 6040h, 6060h")));
  EXPECT_THAT(check_eds("novanta_eve_net_c").warnings, Not(Contains(HasSubstr("hears 303h"))));
}

TEST(DriveCheck, AnotherDeviceEndsItAfterAFewReads) {
  node::Node node(kDrive, nullptr);
  DriveBench bench(node.device());
  node.power_on(0);
  const DriveCheck check = check_drive(read_drive(bench.client), {});
  EXPECT_EQ(value_of(check, "device"), "no");
  EXPECT_EQ(check.best, Way::none);
  EXPECT_THAT(check.missing, Contains(HasSubstr("no CiA 402 drive")));
  EXPECT_LT(bench.frames.size(), 60U);
}

TEST(DriveCheck, ASilentNodeIsNamed) {
  DriveBench bench;
  EXPECT_EQ(complaint_of([&] { return read_drive(bench.client); }), "node 3 does not answer");
}

// Ends in time: an answer that comes after the time-out is none.
class SlowNode {
 public:
  void receive(const hal::CanFrame& frame, std::uint64_t now_us) {
    if (frame.id == 0x600 + kDrive) asked_us_ = now_us;
  }
  void poll(std::uint64_t) {}
  bool offer(hal::CanFrame& frame, std::uint64_t now_us) const {
    if (asked_us_ == 0 || now_us < asked_us_ + 300'000) return false;
    frame = {0x580 + kDrive, 8, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}};
    return true;
  }
  void taken(std::uint64_t) { asked_us_ = 0; }

 private:
  std::uint64_t asked_us_ = 0;
};

TEST(DriveCheck, ASlowNodeEndsItInTime) {
  SlowNode slow;
  DriveBench bench(slow);
  bench.client.set_timeout_us(100'000);
  EXPECT_EQ(complaint_of([&] { return read_drive(bench.client); }), "node 3 does not answer");
  EXPECT_LT(bench.bus.now_us(), 1'000'000U);
}

// --- units: exact fractions of a turn of 2^40 (conventions.md: rotary run-time unit)

DriveUnits units(const std::string& objects) {
  return units_of(read_drive(EdsFile(objects, "drive.eds"), kDrive));
}

std::string unsigned32(const std::string& section, const std::string& value) {
  return "[" + section + "]\nObjectType=0x7\nDataType=0x7\nAccessType=ro\nDefaultValue=" + value +
         "\n";
}

TEST(DriveUnits, DecimalDegreesDoNotFitAndLoseTheTurn) {
  const DriveUnits tenths = units(unsigned32("60A8", "0xFF410000"));
  EXPECT_EQ(tenths.whole_per_turn, 3600U);
  EXPECT_FALSE(tenths.scale);  // 2^36 : 225
  EXPECT_FALSE(tenths.survives_wrap());
}

TEST(DriveUnits, PowersOfTwoFitFrom2To20) {
  const auto counts = [](const std::string& n) {
    return units(unsigned32("608Fsub1", n) + unsigned32("608Fsub2", "1"));
  };
  EXPECT_FALSE(counts("8192").scale);  // 2^27 : 1
  EXPECT_TRUE(counts("8192").survives_wrap());
  EXPECT_EQ(counts("1048576").scale, std::pair(1U << 20U, 1U));
  EXPECT_EQ(counts("2147483648").scale, std::pair(512U, 1U));
}

TEST(DriveUnits, AGearIsAFactor) {
  const DriveUnits geared = units(unsigned32("608Fsub1", "8192") + unsigned32("608Fsub2", "1") +
                                  unsigned32("6091sub1", "81") + unsigned32("6091sub2", "1"));
  EXPECT_EQ(geared.whole_per_turn, 663552U);
}

TEST(DriveUnits, ALinearAxisHasItsFeed) {
  DriveUnits screw = units(unsigned32("608Fsub1", "8192") + unsigned32("608Fsub2", "1"));
  screw.become_linear(10.0);
  EXPECT_NEAR(screw.nm_per_unit.value(), 1e7 / 8192, 1e-9);  // 1.2 um
  EXPECT_EQ(screw.scale, std::pair(78125U, 64U));
  EXPECT_EQ(units(unsigned32("60A8", "0xF7010000")).scale, std::pair(1U, 1U));
}

TEST(DriveUnits, WhatFactorsDoNotTellIsNotGuessed) {
  EXPECT_THAT(units(unsigned32("6041", "0")).unknown, HasSubstr("see its manual"));
  EXPECT_THAT(units(unsigned32("608Fsub1", "1") + unsigned32("608Fsub2", "1")).unknown,
              HasSubstr("cancel out"));
}

}  // namespace
}  // namespace volcomp::host
