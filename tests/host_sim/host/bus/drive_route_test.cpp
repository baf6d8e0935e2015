// volcomp drive forward against simulated drives: what their PDOs become, on the bus, too, and that
// a command that does not end well leaves them as they were.

#include <gmock/gmock.h>

#include "host_sim/host/bus/drive_check/drive_route.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"
#include "tests/host_sim/host/bus/trial_bench.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;
using sim::complaint_of;
using testing::HasSubstr;

Mapping mapping_of(const canopen::PdoParameters& pdo) {
  return {pdo.mapping.begin(), pdo.mapping.begin() + pdo.count};
}

bool is_on(const canopen::PdoParameters& pdo) { return (pdo.cob_id & canopen::kPdoInvalid) == 0; }

std::uint32_t id_of(const canopen::PdoParameters& pdo) { return pdo.cob_id & hal::kMaxCanId; }

void go(TrialBench& bench, DriveRoute route, const DriveChanges::Check& check = {}) {
  bench.read = read_drive(*bench.tool);
  DriveChanges changes = bench.changes(check);
  static_cast<void>(set_route(changes, bench.read, plan_of(bench.read, route)));
}

// The longest skipping that the data sheet grants.
struct Forwarded {
  const char* name;
  Mapping control;
};
void PrintTo(const Forwarded& forwarded, std::ostream* out) { *out << forwarded.name; }

class DriveRoutes : public testing::TestWithParam<Forwarded> {
 protected:
  TrialBench bench{GetParam().name};
};

TEST_P(DriveRoutes, TheTargetComesFromTheNode) {
  go(bench, DriveRoute::forwarded);
  const DriveState now(bench.drive);
  EXPECT_EQ(id_of(now.receive[0]), 0x200U + kDrive);
  EXPECT_EQ(mapping_of(now.receive[0]), GetParam().control);
  EXPECT_EQ(now.receive[0].type, bench.before->receive[0].type);
  EXPECT_EQ(id_of(now.receive[1]), 0x300U + kDrive);
  EXPECT_EQ(mapping_of(now.receive[1]), Mapping{kTargetEntry});
  EXPECT_EQ(now.receive[1].type, 1);
  EXPECT_EQ(id_of(now.transmit[0]), 0x180U + kDrive);
  EXPECT_EQ(mapping_of(now.transmit[0]), (Mapping{kActualEntry, kStatusEntry, kModeEntry}));
  EXPECT_EQ(now.transmit[0].type, 1);
  EXPECT_EQ(now.transmit[0].inhibit_100us, 0);
  EXPECT_TRUE(is_on(now.receive[0]) && is_on(now.receive[1]) && is_on(now.transmit[0]));
  EXPECT_FALSE(std::filesystem::exists(bench.journal()));
}

// 607Ah and 6040h come from one place each.
TEST_P(DriveRoutes, NoOtherPdoGetsInTheWay) {
  for (const DriveRoute route : {DriveRoute::forwarded, DriveRoute::direct}) {
    go(bench, route);
    std::size_t targets = 0;
    std::size_t controls = 0;
    for (const canopen::PdoParameters& pdo : DriveState(bench.drive).receive) {
      for (const std::uint32_t entry : mapping_of(pdo)) {
        targets += is_on(pdo) && entry == kTargetEntry;
        controls += is_on(pdo) && entry == kControlEntry;
      }
    }
    EXPECT_EQ(targets, 1U);
    EXPECT_EQ(controls, 1U);
  }
}

TEST_P(DriveRoutes, OffPutsTheDirectTargetBack) {
  go(bench, DriveRoute::forwarded);
  go(bench, DriveRoute::direct);
  const DriveState now(bench.drive);
  EXPECT_EQ(mapping_of(now.receive[0]), (Mapping{kControlEntry, kTargetEntry}));
  EXPECT_TRUE(is_on(now.receive[0]));
  EXPECT_FALSE(is_on(now.receive[1]));
}

// The frame of the controller stays as it is, and only the controlword of it arrives.
TEST_P(DriveRoutes, OfTheFrameOfTheControllerOnlyTheControlwordArrives) {
  go(bench, DriveRoute::forwarded);
  bench.drive.device().enter(canopen::NmtState::operational, bench.bus.now_us());
  sim::SimulatedBus::Port& controller = bench.bus.attach_served("controller", {});
  const std::int32_t before = bench.drive.objects().target;
  ASSERT_TRUE(controller.send({0x200 + kDrive, 6, {0x06, 0, 0x11, 0x22, 0x33, 0x44}}));
  ASSERT_TRUE(controller.send({0x80, 0, {}}));
  bench.run_ms(5);
  EXPECT_EQ(bench.drive.objects().controlword, 0x06);
  EXPECT_EQ(bench.drive.objects().target, before);
  ASSERT_TRUE(controller.send({0x300 + kDrive, 4, {0x11, 0x22, 0x33, 0x04}}));
  ASSERT_TRUE(controller.send({0x80, 0, {}}));
  bench.run_ms(5);
  EXPECT_EQ(bench.drive.objects().target, 0x04332211);
}

TEST_P(DriveRoutes, ASignalAtEverySdoLeavesTheDriveAsItWas) {
  std::size_t interrupted = 0;
  for (bool ended = false; !ended; ++interrupted) {
    std::size_t left = interrupted;
    try {
      go(bench, DriveRoute::forwarded, [&left] {
        if (left-- == 0) throw Interrupted(SIGTERM);
      });
      ended = true;
    } catch (const Interrupted&) {
      ASSERT_TRUE(bench.is_as_before()) << interrupted;
    }
    ASSERT_FALSE(std::filesystem::exists(bench.journal()));
  }
  EXPECT_GT(interrupted, 30U);
}

// Half a configuration never stays: the next call puts the old one back, or the new one was whole.
TEST_P(DriveRoutes, AKillAtEveryFrameIsMadeGoodByTheNextCall) {
  const ForeignDrive read = bench.read;
  std::size_t killed = 1;
  for (bool ended = false; !ended; ++killed) {
    bench.start_process();
    bench.killed_after = killed;
    try {
      DriveChanges changes = bench.changes();
      static_cast<void>(set_route(changes, read, plan_of(read, DriveRoute::forwarded)));
      ended = true;
      continue;
    } catch (const Killed&) {  // as wanted
    }
    static_cast<void>(bench.call_again());
    ASSERT_TRUE(bench.is_as_before()) << killed;
  }
  EXPECT_GT(killed, 60U);
}

INSTANTIATE_TEST_SUITE_P(Real, DriveRoutes,
                         testing::Values(Forwarded{"elmo_gold", control_and_single_bytes()},
                                         Forwarded{"epos4_0150", control_alone()},
                                         Forwarded{"epos4_0170", control_alone()},
                                         Forwarded{"nanotec_cl4e", control_and_four_bytes()},
                                         Forwarded{"trinamic_tmcm1270", control_alone()},
                                         Forwarded{"novanta_eve_net_c", control_and_four_bytes()},
                                         Forwarded{"eyou", control_and_four_bytes()}),
                         [](const auto& one) { return std::string(one.param.name); });

// Way 0 where the drive takes the offset; where it does not, nothing is changed.
TEST(DriveRoute, TheOffsetComesFromTheNode) {
  TrialBench bench("nanotec_cl4e");
  go(bench, DriveRoute::offset);
  const DriveState now(bench.drive);
  EXPECT_EQ(mapping_of(now.receive[0]), (Mapping{kControlEntry, kTargetEntry}));
  EXPECT_EQ(mapping_of(now.receive[1]), Mapping{kOffsetEntry});
  EXPECT_EQ(now.receive[1].type, 1);
  EXPECT_EQ(mapping_of(now.transmit[0]), (Mapping{kActualEntry, kStatusEntry}));
  EXPECT_FALSE(is_on(now.transmit[3]));  // 480h + n: it does not report the offset
}

TEST(DriveRoute, ADriveWithoutTheObjectStaysAsItWas) {
  TrialBench bench("trinamic_tmcm1270");
  EXPECT_THAT(complaint_of([&] { return go(bench, DriveRoute::offset), 0; }),
              HasSubstr("node 3 does not take RPDO2: 303h {60B0h}, type 1"));
  EXPECT_TRUE(bench.is_as_before());
  EXPECT_FALSE(std::filesystem::exists(bench.journal()));
}

TEST(DriveRoute, TheCompleteDriveReportsItsOffset) {
  TrialBench bench("");
  go(bench, DriveRoute::offset);
  EXPECT_EQ(mapping_of(DriveState(bench.drive).transmit[3]), Mapping{kOffsetEntry});
  EXPECT_TRUE(is_on(DriveState(bench.drive).transmit[3]));
}

// Nothing is stored without being asked for.
TEST(DriveRoute, WritesNothingButPdos) {
  TrialBench bench("elmo_gold");
  go(bench, DriveRoute::forwarded);
  for (const std::uint16_t index : bench.written)
    EXPECT_TRUE(canopen::PdoTable::owns(index)) << std::hex << index;
}

// --- the side of the node

// A node with drive 7 at its axis 2, and a heartbeat every 100 ms.
class NodeSide : public testing::Test {
 protected:
  NodeSide() {
    bench.write({0x1017, 0}, {100, 0});
    bench.write({0x2010, 2}, {7});
  }
  std::string refusal(std::size_t axis, std::uint8_t drive) {
    return complaint_of([&] {
      require_node_ready(bench.client, axis, drive);
      return 0;
    });
  }
  std::uint64_t value(std::uint16_t index) {
    return number(bench.client.read({index, 2}, 1, "test"));
  }

  ServiceBench bench;
};

TEST_F(NodeSide, HasTheDriveAndIsPreOperational) {
  require_node_ready(bench.client, 2, 7);
  EXPECT_THAT(refusal(2, 3), HasSubstr("axis 2 of node 32 has drive 7 (2010h), not 3"));
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  EXPECT_THAT(refusal(2, 7), HasSubstr("must be PRE-OPERATIONAL, and is not"));
}

TEST_F(NodeSide, KnowsTheWayAndThatTheMappingWasReadBack) {
  set_node_way(bench.client, 2, DriveRoute::forwarded);
  EXPECT_EQ(value(0x2034), 1U);
  EXPECT_EQ(value(0x2037), 1U);
  set_node_way(bench.client, 2, DriveRoute::offset);
  EXPECT_EQ(value(0x2034), 0U);
  EXPECT_EQ(value(0x2037), 255U);
  set_node_way(bench.client, 2, DriveRoute::direct);
  EXPECT_EQ(value(0x2034), 4U);
  EXPECT_EQ(value(0x2037), 255U);
}

TEST_F(NodeSide, IsNotTouchedWhileTheAxisFollows) {
  bench.write({0x1029, 1}, {1});
  set_node_way(bench.client, 2, DriveRoute::forwarded);
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  bench.send({0x187, 7, {0, 0, 0, 0, 0x37, 0x01, 8}});
  EXPECT_THAT(refusal(2, 7), HasSubstr("axis 2 (drive 7) follows targets that node 32 forwards"));
}

}  // namespace
}  // namespace volcomp::host
