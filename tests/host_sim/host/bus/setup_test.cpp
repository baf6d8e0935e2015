// A node is set up: by the plan of its machine file it becomes the node that the simulated
// controller makes of it, and what cannot be set up is refused before anything is written.

#include <array>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/tables/image.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "host_sim/host/bus/probe_setup.hpp"
#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "tests/complaint.hpp"
#include "tests/hal/memory_blocks.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"
#include "tests/host_sim/host/machine/changed_machine.hpp"

namespace volcomp::host {
namespace {

using sim::complaint_of;
using testing::AllOf;
using testing::HasSubstr;

using Object = std::pair<std::uint16_t, std::uint8_t>;
using Values = std::map<Object, SdoChannel::Bytes>;

struct Blocks {
  std::unique_ptr<volcomp::test::MemoryBlocks<16384, 2>> memory =
      std::make_unique<volcomp::test::MemoryBlocks<16384, 2>>();
  node::RecordStorage<volcomp::test::MemoryBlocks<16384, 2>> storage{*memory};
};

MachineFile machine_of(const std::string& name) { return read_machine_file(bundled_machine(name)); }

SetupPlan plan_of(const MachineFile& machine) {
  return setup_plan(machine, setup_bus(machine, {}, {}));
}

SetupResult set_up_by_file(ServiceBench& bench, const MachineFile& machine, bool store = false) {
  return set_up(bench.client, machine, plan_of(machine), {store, {}});
}

// What a node keeps: objects that 1010h stores, and the parameters of its PDOs.
std::vector<canopen::ObjectId> kept_objects() {
  std::vector<canopen::ObjectId> objects;
  for (const canopen::NamedEntry& row : node::named_node_dictionary()) {
    if ((row.traits & canopen::kStored) == 0) continue;
    for (unsigned sub = row.first_sub; sub <= row.last_sub; ++sub)
      objects.push_back({row.index, static_cast<std::uint8_t>(sub)});
  }
  const auto add_pdos = [&objects](std::uint16_t parameters, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<std::uint16_t>(parameters + i);
      for (const std::uint8_t sub : std::array<std::uint8_t, 4>{1, 2, 3, 5})
        objects.push_back({index, sub});
      for (const std::uint8_t sub : std::array<std::uint8_t, 5>{0, 1, 2, 3, 4})
        objects.push_back({static_cast<std::uint16_t>(index + 0x200), sub});
    }
  };
  add_pdos(0x1400, node::kReceivePdos);
  add_pdos(0x1800, node::kTransmitPdos);
  return objects;
}

Values values_of(ServiceBench& bench) {
  Values values;
  for (const canopen::ObjectId object : kept_objects()) {
    try {
      values[{object.index, object.sub}] = bench.client.read(object, 8, "test");
    } catch (const NodeRefused&) {  // RPDOs have no inhibit time, short mappings no fourth entry
      values[{object.index, object.sub}] = {};
    }
  }
  return values;
}

// Values of the node that the simulated controller has configured and started.
Values values_of(sim::BusAxes& axes) {
  Values values;
  SdoChannel& channel = axes.controller().node_objects();
  const std::vector<std::int32_t> stand(axes.controller().settings().axes.size(), 0);
  for (const canopen::ObjectId object : kept_objects()) {
    SdoChannel::Bytes& value = values[{object.index, object.sub}];
    channel.read(object, 8, "test", [&value](const SdoChannel::Bytes& bytes) { value = bytes; });
    while (!channel.idle())
      axes.run_cycle(stand);
    if (!channel.failure().empty()) channel.clear();
  }
  return values;
}

// "2201h:01 00030D40" a line: what the simulated controller of revision 003a24d wrote into a new
// node, taken from the log of its bus; 2202h of rotary axes for the 0.1 rad/s that their machine
// files state since.
Values written_values(const std::string& machine) {
  std::ifstream file(std::string(VOLCOMP_SOURCE_DIR) + "/tests/data/node-objects/" + machine +
                     ".txt");
  Values values;
  for (std::string object, digits; file >> object >> digits;) {
    SdoChannel::Bytes bytes;
    for (std::size_t at = digits.size(); at > 0; at -= 2)
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits.substr(at - 2, 2), nullptr, 16)));
    values[{static_cast<std::uint16_t>(std::stoul(object.substr(0, 4), nullptr, 16)),
            static_cast<std::uint8_t>(std::stoul(object.substr(6), nullptr, 16))}] = bytes;
  }
  return values;
}

class SetUpMachine : public testing::TestWithParam<const char*> {};

TEST_P(SetUpMachine, EveryObjectHoldsWhatTheControllerWroteBefore) {
  const MachineFile machine = machine_of(GetParam());
  ServiceBench bench;
  ASSERT_TRUE(set_up_by_file(bench, machine).ok());
  const Values expected = written_values(GetParam());
  ASSERT_GT(expected.size(), 40U);
  for (const auto& [object, bytes] : expected)
    EXPECT_EQ(bench.client.read({object.first, object.second}, 8, "test"), bytes)
        << fmt::format("{:04X}h:{:02X}", object.first, object.second);
}

TEST_P(SetUpMachine, TheNodeIsThatOfTheSimulatedController) {
  const MachineFile machine = machine_of(GetParam());
  ServiceBench bench;
  ASSERT_TRUE(set_up_by_file(bench, machine).ok());
  sim::BusAxes axes(setup_bus(machine, {}, {}), {});
  if (machine.probe) axes.controller().use_probe(node_probe(machine));
  axes.bring_up(5.0);
  const Values expected = values_of(axes);
  ASSERT_GT(expected.size(), 300U);
  for (const auto& [object, bytes] : values_of(bench))
    EXPECT_EQ(bytes, expected.at(object))
        << fmt::format("{:04X}h:{:02X}", object.first, object.second);
}

INSTANTIATE_TEST_SUITE_P(Bundled, SetUpMachine,
                         testing::Values("xyfz", "trunnion", "l300g", "yk7280"),
                         [](const auto& name) { return std::string(name.param); });

// --- what is written and stored

TEST(Setup, TellsWhatDifferedBefore) {
  ServiceBench bench;
  const MachineFile machine = machine_of("xyfz");
  const SetupResult first = set_up_by_file(bench, machine);
  EXPECT_THAT(describe(first),
              AllOf(HasSubstr("2000h:01"), HasSubstr("Machine id"), HasSubstr("1001"),
                    HasSubstr("was 0"), HasSubstr("not stored")));
  const nlohmann::json json = to_json(first);
  EXPECT_EQ(json.at("stored"), false);
  EXPECT_EQ(json.at("ok"), true);
  const SetupResult second = set_up_by_file(bench, machine);
  for (const SetupValue& value : second.values)
    EXPECT_FALSE(value.differed()) << value.planned.name;
  EXPECT_THAT(describe(second), HasSubstr("0 of them differed before"));
}

TEST(Setup, IsKeptThroughAPowerFailure) {
  Blocks blocks;
  Values before;
  {
    ServiceBench bench(&blocks.storage);
    EXPECT_TRUE(set_up_by_file(bench, machine_of("trunnion"), true).stored);
    before = values_of(bench);
  }
  ServiceBench bench(&blocks.storage);
  EXPECT_EQ(values_of(bench), before);
}

TEST(Setup, ActivatesAndStoresTables) {
  Blocks blocks;
  const std::vector<std::uint8_t>& image = known_machine().image;
  {
    ServiceBench bench(&blocks.storage);
    const SetupResult result =
        set_up(bench.client, known_machine().file, plan_of(known_machine().file), {true, image});
    ASSERT_TRUE(result.tables);
    EXPECT_TRUE(result.stored);
  }
  ServiceBench bench(&blocks.storage);
  EXPECT_EQ(active_tables(bench.client).crc, image_crc({image.data(), image.size()}));
  // Once more: the tables that the node has are those of this machine.
  EXPECT_TRUE(set_up_by_file(bench, known_machine().file).ok());
}

// 1016h refuses a node that is supervised twice (CiA 301, 7.5.2.19).
TEST(Setup, TakesDrivesThatHaveChangedPlaces) {
  ServiceBench bench;
  MachineFile machine = machine_of("xyfz");
  ASSERT_TRUE(set_up_by_file(bench, machine).ok());
  std::swap(machine.axes[0].drive.node, machine.axes[2].drive.node);
  EXPECT_TRUE(set_up_by_file(bench, machine).ok());
  EXPECT_EQ(number(bench.client.read({0x2010, 1}, 1, "drive")), 3);
}

TEST(Setup, AnAxisThatIsGoneHasNoDriveAnyMore) {
  ServiceBench bench;
  bench.write({0x2010, 5}, {9});
  bench.write({0x1016, 6}, {100, 0, 9, 0});
  ASSERT_TRUE(set_up_by_file(bench, machine_of("xyfz")).ok());
  EXPECT_EQ(number(bench.client.read({0x2010, 5}, 1, "drive")), 0);
  EXPECT_EQ(number(bench.client.read({0x1016, 6}, 4, "heartbeat")), 0U);
}

TEST(Setup, ValuesReadBackOtherwiseAreNamed) {
  SetupResult result;
  SetupPlan plan;
  plan_value<std::int32_t>(plan, {0x2201, 1}, -5, "largest offset of X", "nm");
  result.values.push_back({plan[0], 0, 7});
  EXPECT_FALSE(result.ok());
  EXPECT_THAT(describe(result), AllOf(HasSubstr("-5"), HasSubstr("READ BACK AS 7")));
}

// --- refusals

std::string refusal_of_setup(ServiceBench& bench, const MachineFile& machine, bool store = false) {
  return complaint_of([&] { return set_up_by_file(bench, machine, store); });
}

TEST(SetupBus, NeedsTheBusOfTheFile) {
  const std::string text = text_of_file(bundled_machine("trunnion"));
  const auto complaint = [](const std::string& file, std::optional<double> cycle_hz,
                            std::optional<std::uint8_t> node) {
    return complaint_of([&] { return setup_bus(parse_machine(file, "m.toml"), cycle_hz, node); });
  };
  EXPECT_EQ(complaint(text, {}, {}), "accepted");
  const std::string cycle = "cycle_hz = 250.0";
  const std::string none = changed(changed(text, "[bus]\nnode_id = 32", ""), cycle, "");
  EXPECT_THAT(complaint(none, {}, {}), HasSubstr("m.toml: there is no [bus]"));
  EXPECT_THAT(complaint(none, 250.0, {}), HasSubstr("m.toml: there is no [bus]"));
  const std::string without = changed(text, cycle, "");
  EXPECT_THAT(complaint(without, {}, {}), HasSubstr("cycle_hz"));
  EXPECT_EQ(complaint(without, 250.0, {}), "accepted");
  EXPECT_THAT(complaint(text, {}, 3), HasSubstr("node 3 is the drive of axis Z"));
  EXPECT_THAT(complaint(text, {}, 127), HasSubstr("node 127 is the controller"));
  EXPECT_THAT(machine_refusal(changed(text, cycle, "cycle_hz = 2")), HasSubstr("m.toml:"));
  EXPECT_THAT(machine_refusal(changed(text, cycle, "cycle_hz = nan")), HasSubstr("cycle_hz"));
}

TEST(SetupPlan, RefusesMoreAxesThanANodeHas) {
  BusSettings bus = setup_bus(machine_of("trunnion"), {}, {});
  bus.axes.push_back(bus.axes.back());
  EXPECT_THAT(complaint_of([&] { return node_plan(bus); }), HasSubstr("5 axes, the machine 6"));
}

TEST(Setup, RefusesANodeOfAnotherMachine) {
  ServiceBench bench;
  bench.write({0x2000, 1}, {7, 0, 0, 0});
  const Values before = values_of(bench);
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz")),
              AllOf(HasSubstr("node 32 belongs to machine 7"), HasSubstr("machine 1001")));
  EXPECT_EQ(values_of(bench), before);
}

TEST(Setup, RefusesANodeWithTablesOfAnotherMachine) {
  ServiceBench bench;
  send_image(bench.client, known_machine().image);
  activate_tables(bench.client);
  EXPECT_THAT(refusal_of_setup(bench, machine_of("trunnion")),
              AllOf(HasSubstr("tables of machine 1001"), HasSubstr("machine 5001")));
}

TEST(Setup, RefusesANodeThatRuns) {
  ServiceBench bench;
  bench.pass_us(10'000);
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz")), HasSubstr("is OPERATIONAL"));
  bench.send({0x000, 2, {2, ServiceBench::kNodeId}});
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz")), HasSubstr("is STOPPED"));
}

TEST(Setup, RefusesANodeWithoutStore) {
  ServiceBench bench;
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz"), true), HasSubstr("has no store"));
  EXPECT_EQ(number(bench.client.read({0x2000, 1}, 4, "machine id")), 0U);
}

TEST(Setup, RefusesAnotherDevice) {
  ServiceBench bench(nullptr, false);
  sim::Cia402Drive::Settings settings;
  settings.node_id = ServiceBench::kNodeId;
  sim::Cia402Drive drive(settings);
  bench.bus.attach(drive, "drive");
  drive.power_on(0);
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz")),
              HasSubstr("node 32 is no compensation node"));
}

TEST(Setup, TellsWhenNothingAnswers) {
  ServiceBench bench(nullptr, false);
  EXPECT_EQ(refusal_of_setup(bench, machine_of("xyfz")), "node 32 does not answer");
}

TEST(Setup, ARefusedValueIsNamedAndNothingIsStored) {
  Blocks blocks;
  {
    ServiceBench bench(&blocks.storage);
    SetupPlan plan;
    plan_value<std::uint32_t>(plan, {0x2000, 1}, 1001, "machine id");
    plan_value<std::uint8_t>(plan, {0x2000, 2}, 200, "node id of the controller");
    plan_value<std::uint32_t>(plan, {0x2200, 1}, 50, "ramp");
    const std::string text = complaint_of([&] {
      return set_up(bench.client, machine_of("xyfz"), plan, {true, {}});
    });
    EXPECT_THAT(text, AllOf(HasSubstr("node id of the controller (2000h:02)"),
                            HasSubstr("nothing was stored"), HasSubstr("1 of 3 values")));
    EXPECT_EQ(number(bench.client.read({0x2000, 1}, 4, "machine id")), 1001U);
  }
  ServiceBench bench(&blocks.storage);
  EXPECT_EQ(number(bench.client.read({0x2000, 1}, 4, "machine id")), 0U);
}

TEST(Setup, AFailingStoreIsReportedWithItsReason) {
  Blocks blocks;
  ServiceBench bench(&blocks.storage);
  blocks.memory->refuse_erases(true);
  EXPECT_THAT(refusal_of_setup(bench, machine_of("xyfz"), true),
              AllOf(HasSubstr("failure while erasing"), HasSubstr("nothing was stored")));
}

// --- units and referenced bits

MachineFile with_fields(const std::string& axis, const std::string& fields) {
  std::string text = text_of_file(bundled_machine("trunnion"));
  const std::size_t at = text.find("name = \"" + axis + "\"");
  return parse_machine(text.insert(text.find('\n', at), "\n" + fields), "m.toml");
}

std::uint64_t planned(const MachineFile& machine, Object object) {
  std::uint64_t bits = UINT64_MAX;
  for (const PlannedValue& value : plan_of(machine)) {
    if (value.object.index == object.first && value.object.sub == object.second) bits = value.bits;
  }
  return bits;
}

// Bit 8 of 6041h is another one in some drives.
TEST(SetUpReferenced, ANamedDriveHasNoDefault) {
  EXPECT_EQ(planned(with_fields("X", ""), {0x2033, 1}), 256U);
  EXPECT_THAT(
      complaint_of([] { return plan_of(with_fields("X", "drive = \"epos4_0170\"")).size(); }),
      AllOf(HasSubstr("axis X needs referenced_mask"), HasSubstr("epos4_0170")));
  EXPECT_EQ(
      planned(with_fields("X", "drive = \"epos4_0170\"\nreferenced_mask = 32768"), {0x2033, 1}),
      32768U);
  EXPECT_EQ(
      planned(with_fields("X", "drive = \"epos4_0170\"\nreferenced_mask = \"none\""), {0x2033, 1}),
      0U);
}

TEST(SetUpUnits, UnitsPerTurnReachTheNodeAndGoAgain) {
  MachineFile machine = with_fields("X", "");
  EXPECT_EQ(planned(machine, {0x2036, 4}), 0U);
  machine.axes[3].drive.scale_numerator = machine.axes[3].drive.scale_denominator = 1;
  machine.axes[3].drive.units_per_turn = 360'000;
  EXPECT_EQ(planned(machine, {0x2036, 4}), 360'000U);
  ServiceBench bench;
  ASSERT_TRUE(set_up_by_file(bench, machine).ok());
  EXPECT_EQ(number(bench.client.read({0x2036, 4}, 4, "units")), 360'000U);
  ASSERT_TRUE(set_up_by_file(bench, with_fields("X", "")).ok());
  EXPECT_EQ(number(bench.client.read({0x2036, 4}, 4, "units")), 0U);
}

// --- a forwarded axis that follows

// 6041h = 0137h is "operation enabled", 6061h = 8 cyclic synchronous position (CiA 402-2).
TEST(SetUpWhileFollowing, IsRefusedWithTheAxis) {
  ServiceBench bench;
  bench.write({0x1029, 1}, {1});
  bench.write({0x1017, 0}, {100, 0});
  bench.write({0x2010, 2}, {7});
  bench.write({0x2034, 2}, {1});
  const MachineFile machine = machine_of("trunnion");
  const auto refusal = [&] {
    return complaint_of([&] { return set_up_by_file(bench, machine).ok(); });
  };
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  EXPECT_THAT(refusal(), HasSubstr("is OPERATIONAL: stop the machine first"));
  bench.send({0x187, 7, {0, 0, 0, 0, 0x37, 0x01, 8}});
  EXPECT_THAT(refusal(), HasSubstr("axis 2 (drive 7) follows targets that node 32 forwards"));
  EXPECT_THAT(complaint_of([&] {
                refuse_while_following(bench.client, canopen::NmtState::operational);
                return 0;
              }),
              HasSubstr("disable the drives first"));
  bench.send({0x187, 7, {0, 0, 0, 0, 0x37, 0x01, 6}});  // homing
  EXPECT_THAT(refusal(), HasSubstr("is OPERATIONAL: stop the machine first"));
}

}  // namespace
}  // namespace volcomp::host
