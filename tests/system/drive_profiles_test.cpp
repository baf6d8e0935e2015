// Machines with drives as their data sheets have them: the controller maps them at every start, the
// node corrects them as it corrects today's, and what a drive lacks is said.

#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "host_sim/host/bus/drive_model.hpp"
#include "tests/complaint.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

using testing::HasSubstr;

constexpr std::size_t kX = 0;
const Vec3 kElsewhere{120.0, 80.0, -60.0};

host::BusSettings settings_with(const std::vector<std::string>& names) {
  return host::with_models(bus_machine_settings(), names);
}

std::unique_ptr<BusAxes> machine_with(const std::vector<std::string>& names) {
  auto axes = std::make_unique<BusAxes>(settings_with(names), bus_machine().image);
  axes->stand_at({-250.0, -150.0, -200.0});
  axes->bring_up();
  return axes;
}

using Mapping = std::vector<std::uint32_t>;
Mapping mapping(const canopen::Pdo& pdo) {
  const canopen::PdoParameters& p = pdo.parameters();
  return {p.mapping.begin(), p.mapping.begin() + p.count};
}

struct WayZero {
  const char* name;
  double unit_nm;            // of a linear axis, docs/drives.md
  bool counts_sync;          // the EDS has 1019h
  std::size_t actual_bytes;  // 8: with 60B9h
};
void PrintTo(const WayZero& drive, std::ostream* out) { *out << drive.name; }

class WayZeroDrive : public testing::TestWithParam<WayZero> {};

// CiA 301 and docs/drives.md: {6040h, 607Ah}, {60B0h}; {6064h, 6041h}, with 60B9h where there is a
// probe; all of type 1, nothing else is valid.
TEST_P(WayZeroDrive, IsMappedAtTheStart) {
  const auto axes = machine_with({GetParam().name});
  const canopen::PdoTable& pdos = axes->drive(kX).device().pdos();
  EXPECT_EQ(mapping(pdos.receive()[0]), (Mapping{0x6040'0010U, 0x607A'0020U}));
  EXPECT_EQ(mapping(pdos.receive()[1]), (Mapping{0x60B0'0020U}));
  EXPECT_EQ(pdos.receive()[0].parameters().cob_id, 0x201U);
  EXPECT_EQ(pdos.receive()[1].parameters().cob_id, 0x301U);
  EXPECT_EQ(pdos.transmit()[0].parameters().cob_id, 0x4000'0181U);
  EXPECT_EQ(pdos.transmit()[0].bytes(), GetParam().actual_bytes);
  for (const canopen::Pdo* pdo : {&pdos.receive()[0], &pdos.receive()[1], &pdos.transmit()[0]})
    EXPECT_EQ(pdo->parameters().type, 1U);
  EXPECT_EQ(pdos.transmit()[0].parameters().inhibit_100us, 0U);
  for (std::size_t i = 2; i < pdos.receive().size(); ++i)
    EXPECT_FALSE(pdos.receive()[i].valid()) << "RPDO" << i + 1;
  for (std::size_t i = 1; i < pdos.transmit().size(); ++i)
    EXPECT_FALSE(pdos.transmit()[i].valid()) << "TPDO" << i + 1;
}

// Nobody says or hears anything in the running cycle but what the plan has.
TEST_P(WayZeroDrive, AddsNoFrameToTheCycle) {
  const auto axes = machine_with({GetParam().name});
  std::set<std::uint32_t> ids;
  std::set<std::size_t> sync_bytes;
  axes->bus().bus().set_observer(
      [&](std::uint64_t, const hal::CanFrame& frame, const hal::LoopbackBus::Port&) {
        ids.insert(frame.id);
        if (frame.id == 0x80) sync_bytes.insert(frame.size);
      });
  const std::size_t said = axes->controller().emergencies().size();
  const host::Targets here = axes->target();
  for (int i = 0; i < 200; ++i)
    axes->cycle(here);
  const std::set<std::uint32_t> expected{0x80,  0x181, 0x182, 0x183, 0x1A0, 0x201, 0x202, 0x203,
                                         0x301, 0x302, 0x303, 0x701, 0x702, 0x703, 0x720, 0x77F};
  EXPECT_EQ(ids, expected);
  EXPECT_EQ(sync_bytes, std::set<std::size_t>{GetParam().counts_sync ? 1U : 0U});
  // A node that has not been told 1019h yet says 8240h at the first SYNC: that was before.
  const std::vector<EmergencyRecord>& all = axes->controller().emergencies();
  const bool well = std::all_of(all.begin() + static_cast<std::ptrdiff_t>(said), all.end(),
                                [](const EmergencyRecord& e) { return e.code == 0; });
  EXPECT_TRUE(well);
}

// The same offset as of a drive in nanometres, rounded to the unit: half a unit from the offset,
// and what half a unit of the target changes the tables by, which is nothing.
TEST_P(WayZeroDrive, IsCorrectedAsTodaysDriveButForRounding) {
  BusWorld today(5);
  ASSERT_TRUE(today.go_to(kElsewhere));
  const auto axes = machine_with({GetParam().name});
  host::Targets target = axes->target();
  const host::Targets goal =
      host::axis_kinds(bus_machine().file.chain).targets(host::pose_of(kElsewhere));
  for (int i = 0; i < 4000; ++i) {
    for (std::size_t a = 0; a < kBusMachineAxes; ++a)
      target[a] += std::clamp<std::int64_t>(goal[a] - target[a], -400'000, 400'000);
    axes->cycle(target);
  }
  const host::Offsets offset = axes->offset();
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    EXPECT_NEAR(static_cast<double>(offset[a]), static_cast<double>(today.offsets()[a]),
                1.0 + 0.5 * GetParam().unit_nm)
        << a;
}

// After its reset the drive has the PDOs of its data sheet, and is mapped again.
TEST_P(WayZeroDrive, IsMappedAgainAfterItLostItsPower) {
  const auto axes = machine_with({GetParam().name});
  const std::vector<std::int32_t> here = axes->on_wire(axes->target());
  axes->power_drive(kX, false);
  for (int i = 0; i < 500; ++i)
    axes->run_cycle(here);
  EXPECT_FALSE(axes->controller().motion_allowed());
  axes->power_drive(kX, true);
  int cycles = 0;
  while (!axes->controller().motion_allowed() && ++cycles < 5000)
    axes->run_cycle(here);
  EXPECT_EQ(axes->controller().trouble(), "");
  const canopen::PdoTable& pdos = axes->drive(kX).device().pdos();
  EXPECT_EQ(mapping(pdos.receive()[1]), (Mapping{0x60B0'0020U}));
}

// The node comes back, the drives hold their offsets: the controller asks each for it (60B0h) and
// tells the node (2206h); no drive sees a step.
TEST_P(WayZeroDrive, KeepsItsOffsetWhileTheNodeIsRestarted) {
  const auto axes = machine_with({GetParam().name});
  const std::vector<std::int32_t> here = axes->on_wire(axes->target());
  for (int i = 0; i < 200; ++i)
    axes->run_cycle(here);
  std::int32_t largest = 0;
  for (std::size_t a = 0; a < kBusMachineAxes; ++a) {
    axes->drive(a).on_input = [&largest](const Cia402Drive::InputStep& in) {
      largest = std::max(largest, std::abs(in.offset - in.previous_offset));
    };
  }
  const host::Offsets before = axes->offset();
  ASSERT_NE(before[kX], 0);
  axes->power_node(false);
  for (int i = 0; i < 500; ++i)
    axes->run_cycle(here);
  axes->power_node(true);
  int cycles = 0;
  while (!axes->controller().motion_allowed() && ++cycles < 5000)
    axes->run_cycle(here);
  EXPECT_EQ(axes->controller().trouble(), "");
  EXPECT_LE(largest * GetParam().unit_nm, 1.0 + GetParam().unit_nm);
}

INSTANTIATE_TEST_SUITE_P(Real, WayZeroDrive,
                         testing::Values(WayZero{"elmo_gold", 1.0, false, 8},
                                         WayZero{"epos4_0150", 78125.0 / 8192.0, false, 6},
                                         WayZero{"epos4_0170", 78125.0 / 8192.0, false, 8},
                                         WayZero{"nanotec_cl4e", 10.0, true, 6}));

TEST(DriveProfiles, MayDifferFromAxisToAxis) {
  const auto axes = machine_with({"elmo_gold", "epos4_0170", "nanotec_cl4e"});
  EXPECT_EQ(axes->drive(0).device().pdos().transmit()[0].bytes(), 8U);
  EXPECT_EQ(axes->drive(2).device().pdos().transmit()[0].bytes(), 6U);
  // One drive cannot count, so nobody does: 1019h.
  EXPECT_EQ(axes->drive(2).objects().communication.sync_counter_overflow, 0U);
  EXPECT_EQ(axes->node()->objects().communication.sync_counter_overflow, 0U);
}

// 1016h of a CL4-E has one entry: it watches the controller. The others watch the node, too.
TEST(DriveProfiles, WatchWhomTheyCan) {
  const auto axes = machine_with({"nanotec_cl4e", "epos4_0150", "elmo_gold"});
  const auto watched = [&](std::size_t a, std::size_t entry) {
    return axes->drive(a).objects().communication.consumer_heartbeat[entry] >> 16U;
  };
  EXPECT_EQ(watched(0, 0), 127U);
  EXPECT_EQ(watched(0, 1), 0U);
  EXPECT_EQ(watched(1, 1), 32U);
  EXPECT_EQ(watched(2, 1), 32U);
}

// A name that is none, names that do not fit, and a way that a drive cannot take.
TEST(DriveProfiles, ThatDoNotFitAreRefusedWithWhatIsMissing) {
  const auto refusal = [](const std::vector<std::string>& names) {
    return complaint_of([&] { return settings_with(names).axes.size(); });
  };
  EXPECT_THAT(refusal({"epos4_017"}), HasSubstr("did you mean 'epos4_0170'?"));
  EXPECT_THAT(refusal({"epos4_0170", "eyou"}), HasSubstr("2 drives are named for 3 axes"));
  const auto by_offset = [](const std::string& name) {
    return complaint_of([&] {
      host::BusAxis axis = bus_machine_settings().axes[kX];
      host::put_model(axis, host::find_drive_model(name));
      return axis.drive;
    });
  };
  EXPECT_THAT(by_offset("trinamic_tmcm1270"), HasSubstr("60B0h cannot be mapped"));
  EXPECT_THAT(by_offset("novanta_eve_net_c"), HasSubstr("60B0h is missing"));
}

// --- forwarded targets, and a controller that adds

// Every drive with cyclic synchronous position can take its target from the node.
class ForwardedDrive : public testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<BusAxes> machine() {
    host::BusSettings settings = bus_machine_settings();
    for (host::BusAxis& axis : settings.axes)
      axis.way = host::Way::forwarded_target;
    if (*GetParam() != '\0') settings = host::with_models(settings, {GetParam()});
    auto axes = std::make_unique<BusAxes>(settings, bus_machine().image);
    axes->stand_at({-250.0, -150.0, -200.0});
    axes->bring_up();
    return axes;
  }
};

host::Targets travel(BusAxes& axes, const Vec3& to, int cycles) {
  host::Targets target = axes.target();
  const host::Targets goal = host::axis_kinds(bus_machine().file.chain).targets(host::pose_of(to));
  for (int i = 0; i < cycles; ++i) {
    for (std::size_t a = 0; a < kBusMachineAxes; ++a)
      target[a] += std::clamp<std::int64_t>(goal[a] - target[a], -400'000, 400'000);
    axes.cycle(target);
  }
  return target;
}

// RPDO1 takes the controlword out of the controller's frame, RPDO2 the target of the node.
TEST_P(ForwardedDrive, IsMappedAndServed) {
  const auto axes = machine();
  const canopen::PdoTable& pdos = axes->drive(kX).device().pdos();
  EXPECT_EQ(mapping(pdos.receive()[0]), (Mapping{0x6040'0010U}));
  EXPECT_EQ(mapping(pdos.receive()[1]), (Mapping{0x607A'0020U}));
  EXPECT_EQ(mapping(pdos.transmit()[0]), (Mapping{0x6064'0020U, 0x6041'0010U, 0x6061'0008U}));
  EXPECT_EQ(axes->node()->objects().mapped_way[kX], 1U);
  const node::NodeObjects& node = axes->node()->objects();
  const std::uint32_t missed = node.deadline_missed;
  travel(*axes, kElsewhere, 200);
  EXPECT_EQ(node.not_forwarded, 0U);
  EXPECT_EQ(node.deadline_missed, missed);
}

TEST_P(ForwardedDrive, IsCorrectedAsTodaysDriveButForRounding) {
  BusWorld today(5);
  ASSERT_TRUE(today.go_to(kElsewhere));
  const auto axes = machine();
  travel(*axes, kElsewhere, 4000);
  const host::Offsets offset = axes->offset();
  for (std::size_t a = 0; a < kBusMachineAxes; ++a) {
    const host::BusAxis& axis = axes->controller().settings().axes[a];
    const double unit = static_cast<double>(axis.scale_numerator) / axis.scale_denominator;
    EXPECT_NEAR(static_cast<double>(offset[a]), static_cast<double>(today.offsets()[a]),
                1.0 + 0.5 * unit)
        << a;
  }
}

// The drive that lost its power is mapped again, read back, and only then gets targets.
TEST_P(ForwardedDrive, IsServedAgainAfterItLostItsPower) {
  const auto axes = machine();
  const std::vector<std::int32_t> here = axes->on_wire(axes->target());
  axes->power_drive(kX, false);
  for (int i = 0; i < 500; ++i)
    axes->run_cycle(here);
  axes->power_drive(kX, true);
  int cycles = 0;
  while (!axes->controller().motion_allowed() && ++cycles < 5000)
    axes->run_cycle(here);
  EXPECT_EQ(axes->controller().trouble(), "");
}

// The node is gone: its axes stop, and the controller stops all of them. It comes back when the
// drives are seen disabled.
TEST_P(ForwardedDrive, StopsAndStartsWithTheNode) {
  const auto axes = machine();
  std::vector<std::int32_t> path = axes->on_wire(axes->target());
  axes->power_node(false);
  for (int i = 0; i < 500; ++i)
    axes->run_cycle(path);
  EXPECT_FALSE(axes->controller().motion_allowed());
  EXPECT_FALSE(axes->controller().axis(kX).following());
  axes->power_node(true);
  int cycles = 0;
  while (!axes->controller().motion_allowed() && ++cycles < 5000)
    axes->run_cycle(path);
  EXPECT_EQ(axes->controller().trouble(), "");
}

INSTANTIATE_TEST_SUITE_P(All, ForwardedDrive,
                         testing::Values("", "elmo_gold", "epos4_0150", "epos4_0170",
                                         "nanotec_cl4e", "trinamic_tmcm1270", "novanta_eve_net_c",
                                         "eyou"));

// Three ways on one bus.
TEST(DriveProfiles, MayBeCorrectedInThreeWays) {
  BusWorld today(5);
  ASSERT_TRUE(today.go_to(kElsewhere));
  host::BusSettings settings = bus_machine_settings();
  settings.axes[1].way = host::Way::forwarded_target;
  settings.axes[2].way = host::Way::controller_adds;
  BusAxes axes(settings, bus_machine().image);
  axes.stand_at({-250.0, -150.0, -200.0});
  axes.bring_up();
  travel(axes, kElsewhere, 4000);
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    EXPECT_NEAR(static_cast<double>(axes.offset()[a]), static_cast<double>(today.offsets()[a]), 1.0)
        << a;
}

// A probe needs an input at every drive.
TEST(DriveProfiles, WithoutAProbeInputAreRefusedOnAMachineThatProbes) {
  host::BusSettings settings = bus_machine_settings();
  settings.probes = true;
  EXPECT_THAT(complaint_of([&] { return host::with_models(settings, {"epos4_0150"}).axes.size(); }),
              HasSubstr("the machine has a touch probe"));
}

}  // namespace
}  // namespace volcomp::sim
