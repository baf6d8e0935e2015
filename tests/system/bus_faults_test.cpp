// What a disturbed bus does to the axes: never a step above the slew limit 2202h at the input of a
// drive, never more than the limit 2201h; afterwards everything is as before, by itself.
//
//   fault                   state while it lasts         EMCY; D: of a drive  over with
//   ----------------------  ---------------------------  -------------------  -----------------
//   node without power      offsets frozen, drives stop  8130h D              start; ramp from
//   node reset              offsets frozen, feed stops   none (boot-up)       what drives hold
//   communication reset     offsets frozen, feed stops   none (boot-up)       the same
//   drive without power     held, dropped; others go on  8130h, 8250h         homing
//   drive reset             held, dropped; others go on  8250h                homing
//   reference lost          ramped to 0, feed stops      FF01h                homing
//   frames lost             held for the cycle           8250h                next frame
//   frames late, reordered  held for the cycle           8250h                next frame
//   frames twice            the second SYNC is no cycle  FF20h                100 good SYNCs
//   several of these        any of these                 8250h and others     the last of them
//   second SYNC producer    its messages are no cycles   FF20h                100 good SYNCs
//   ... without counter     its messages are no cycles   8240h                100 good SYNCs
//   port of the node full   offsets frozen               8130h after 350 ms   frames leave again
//   foreign offset report   nothing sent to that drive   FF21h                6 equal reports
//   ... drives trusted      goes on                      none                 –
//   bus full                no cycles, no heartbeats     8130h, 8130h D       as after power-on
//   second SDO client       goes on, a transfer is lost  none (SDO abort)     repetition
//   download broken off     goes on with the old tables  none (SDO timeout)   2112h:01 = 0
//   tables changed moving   ramps from old to new        none                 end of the ramp
//
// VOLCOMP_FAULT_SEED=n repeats the random sequences with another seed.

#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

#ifdef NDEBUG
constexpr std::uint64_t kSequences = 40;
constexpr int kFaultsEach = 15;
#else
constexpr std::uint64_t kSequences = 3;  // instrumented and unoptimised builds
constexpr int kFaultsEach = 5;
#endif

constexpr std::uint8_t kNode = 32;
constexpr int kRecovery = 6000;  // cycles: 12 s, most of it the reference run of the drives
constexpr std::uint64_t kCycle_ns = 2'000'000;
constexpr std::uint64_t kMostLate_ns = 2 * kCycle_ns;  // 2200h:04

struct Emergency {
  std::uint8_t node;
  std::uint16_t code;
};

struct Fault {
  const char* name;
  int cycles;  // how long it lasts in the directed test
  std::function<void(BusWorld&, Random&, int cycles)> run;  // begins, lasts and ends
  std::vector<Emergency> expected;                          // each followed by a reset of the error
};

std::size_t any_axis(Random& random) {
  return static_cast<std::size_t>(random.uniform(0.0, double{kBusMachineAxes}));
}

// --- power and resets

void node_without_power(BusWorld& world, Random& /*random*/, int cycles) {
  world.axes().power_node(false);
  world.run(cycles);
  world.axes().power_node(true);
}

void drive_without_power(BusWorld& world, Random& random, int cycles) {
  const std::size_t axis = any_axis(random);
  world.axes().power_drive(axis, false);
  world.run(cycles);
  world.axes().power_drive(axis, true);
}

void command(BusWorld& world, canopen::NmtCommand what, std::uint8_t node, int cycles) {
  world.intruder().send({canopen::kNmt, 2, {static_cast<std::uint8_t>(what), node}});
  world.run(cycles);
}

void node_reset(BusWorld& world, Random& /*random*/, int cycles) {
  command(world, canopen::NmtCommand::reset_node, kNode, cycles);
}

void communication_reset(BusWorld& world, Random& /*random*/, int cycles) {
  command(world, canopen::NmtCommand::reset_communication, kNode, cycles);
}

void drive_reset(BusWorld& world, Random& random, int cycles) {
  const auto node = static_cast<std::uint8_t>(any_axis(random) + 1);
  command(world, canopen::NmtCommand::reset_node, node, cycles);
}

void reference_lost(BusWorld& world, Random& random, int cycles) {
  world.axes().drive(any_axis(random)).lose_reference();
  world.run(cycles);
}

// --- frames on their way

using Fate = hal::LoopbackBus::Fate;

void with_fates(BusWorld& world, int cycles,
                const std::function<Fate(const hal::CanFrame& frame)>& fate) {
  world.bus().set_fault_hook([&fate](const hal::CanFrame& frame, const hal::LoopbackBus::Port&,
                                     const hal::LoopbackBus::Port&) { return fate(frame); });
  world.run(cycles);
  world.bus().set_fault_hook({});
}

void frames_lost(BusWorld& world, Random& random, int cycles) {
  const double share = random.uniform(0.02, 0.6);
  with_fates(world, cycles, [&](const hal::CanFrame&) {
    return Fate{random.uniform() < share, false, 0};
  });
}

void frames_twice(BusWorld& world, Random& random, int cycles) {
  with_fates(world, cycles, [&](const hal::CanFrame&) {
    return Fate{false, random.uniform() < 0.3, 0};
  });
}

// Late is counted from SYNC, which is itself the first of its cycle or lost.
void frames_late(BusWorld& world, Random& random, int cycles) {
  with_fates(world, cycles, [&](const hal::CanFrame& frame) {
    const bool late = frame.id != canopen::kSync && random.uniform() < 0.3;
    const double delay_ns = random.uniform() * double{kMostLate_ns};
    return Fate{false, false, late ? static_cast<std::uint64_t>(delay_ns) : 0};
  });
}

// Several at once: frames lost, twice and late while a station is reset.
void many_at_once(BusWorld& world, Random& random, int cycles) {
  const auto any_fate = [&](const hal::CanFrame& frame) {
    const bool late = frame.id != canopen::kSync && random.uniform() < 0.2;
    const double delay_ns = random.uniform() * double{kMostLate_ns};
    return Fate{random.uniform() < 0.05, random.uniform() < 0.1,
                late ? static_cast<std::uint64_t>(delay_ns) : 0};
  };
  for (int rest = cycles; rest > 0; rest -= 100) {
    if (random.uniform() < 0.5) node_reset(world, random, 1);
    if (random.uniform() < 0.5) drive_reset(world, random, 1);
    if (random.uniform() < 0.5) reference_lost(world, random, 1);
    with_fates(world, 100, any_fate);
  }
}

void bus_full(BusWorld& world, Random& /*random*/, int cycles) {
  world.bus().set_full(true);
  world.run(cycles);
  world.bus().set_full(false);
}

// Frames still arrive, cycles are computed, nothing leaves: for less than the heartbeat time-out.
void port_full(BusWorld& world, Random& /*random*/, int cycles) {
  world.keep_moving(true);
  world.axes().fill_node_port(true);
  world.run(cycles);
  world.axes().fill_node_port(false);
  world.run(cycles);
  world.keep_moving(false);
}

// --- others on the bus

// On the identifier of a drive's own report.
void foreign_report(BusWorld& world, Random& random, int cycles) {
  const auto id = static_cast<std::uint16_t>(0x481U + any_axis(random));
  for (int i = 0; i < cycles; ++i) {
    const auto byte = [&random] { return static_cast<std::uint8_t>(random.uniform(0.0, 256.0)); };
    if (random.uniform() < 0.3) world.intruder().send({id, 4, {byte(), byte(), byte(), byte()}});
    world.run(1);
  }
}

void second_sync(BusWorld& world, Random& random, int cycles) {
  auto counter = static_cast<std::uint8_t>(random.uniform(1.0, 240.0));
  for (int i = 0; i < cycles; ++i) {
    counter = static_cast<std::uint8_t>(counter % 240 + 1);
    if (random.uniform() < 0.7) world.intruder().send({canopen::kSync, 1, {counter}});
    world.run(1);
  }
}

void second_sync_without_counter(BusWorld& world, Random& random, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    if (random.uniform() < 0.7) world.intruder().send({canopen::kSync, 0, {}});
    world.run(1);
  }
}

// While the controller itself downloads tables.
void second_sdo_client(BusWorld& world, Random& random, int cycles) {
  world.controller().load_tables(bus_machine().other_image);
  host::SdoChannel& sdo = world.intruder().sdo();
  for (int i = 0; i < cycles; ++i) {
    if (sdo.idle()) {
      sdo.clear();
      const bool reads = random.uniform() < 0.5;
      if (reads) sdo.read({0x1008, 0}, 64, "name", [](const host::SdoChannel::Bytes&) {});
      if (!reads) sdo.write_value<std::uint32_t>({0x1020, 1}, 1, "configuration date");
    }
    world.run(1);
  }
  sdo.clear();
  world.run(20);
  world.controller().load_tables(bus_machine().image);
}

void download_broken_off(BusWorld& world, Random& random, int cycles) {
  host::SdoChannel& sdo = world.intruder().sdo();
  sdo.clear();
  sdo.write({0x2110, 1}, bus_machine().other_image, "tables");
  world.run(static_cast<int>(random.uniform(1.0, 30.0)));
  world.intruder().connect(false);
  sdo.clear();
  world.run(cycles);
  world.intruder().connect(true);
}

void tables_changed_in_motion(BusWorld& world, Random& /*random*/, int cycles) {
  world.keep_moving(true);
  world.controller().load_tables(bus_machine().other_image);
  world.run(cycles);
  world.controller().load_tables(bus_machine().image);
  world.run(cycles);
  world.keep_moving(false);
}

std::vector<Fault> faults() {
  const Emergency node_silent{1, 0x8130};
  const Emergency drive_silent{kNode, 0x8130};
  const Emergency stale{kNode, 0x8250};
  return {
      {"NodeWithoutPower", 400, node_without_power, {node_silent}},
      {"NodeReset", 100, node_reset, {}},
      {"CommunicationReset", 100, communication_reset, {}},
      {"DriveWithoutPower", 400, drive_without_power, {drive_silent, stale}},
      {"DriveReset", 100, drive_reset, {stale}},
      {"FramesLost", 300, frames_lost, {stale}},
      {"FramesTwice", 300, frames_twice, {{kNode, 0xFF20}}},
      {"FramesLate", 300, frames_late, {stale}},
      {"SecondSyncProducer", 300, second_sync, {{kNode, 0xFF20}}},
      {"SecondSyncProducerWithoutCounter", 300, second_sync_without_counter, {{kNode, 0x8240}}},
      {"ManyAtOnce", 600, many_at_once, {stale}},
      {"PortFull", 140, port_full, {}},
      {"ForeignReport", 100, foreign_report, {{kNode, 0xFF21}}},
      {"BusFull", 400, bus_full, {node_silent, drive_silent}},
      {"SecondSdoClient", 200, second_sdo_client, {}},
      {"DownloadBrokenOff", 800, download_broken_off, {}},
      {"TablesChangedInMotion", 400, tables_changed_in_motion, {}},
      {"ReferenceLost", 50, reference_lost, {{kNode, 0xFF01}}},
  };
}

// Offsets of an undisturbed machine at the place that approach() goes to.
host::Offsets undisturbed() {
  static const host::Offsets offsets = [] {
    BusWorld world(1);
    EXPECT_TRUE(world.approach());
    return world.offsets();
  }();
  return offsets;
}

// As before the fault: within the time, without errors, with the same offsets.
void expect_recovery(BusWorld& world) {
  ASSERT_TRUE(world.recover(kRecovery)) << world.trouble() << " after" << world.emergencies();
  ASSERT_TRUE(world.approach()) << world.trouble();
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    EXPECT_LE(std::abs(world.offsets()[a] - undisturbed()[a]), 1) << "axis " << a;
  EXPECT_TRUE(world.violation().empty()) << world.violation();
}

class BusFault : public ::testing::TestWithParam<Fault> {};

TEST_P(BusFault, NoStepAndFullRecovery) {
  const Fault& fault = GetParam();
  BusWorld world(2);
  Random random(3);
  world.run(300);
  world.mark();
  fault.run(world, random, fault.cycles);
  expect_recovery(world);
  for (const Emergency& e : fault.expected) {
    EXPECT_TRUE(world.emergency(e.node, e.code)) << std::hex << e.code << world.emergencies();
    EXPECT_TRUE(world.emergency(e.node, 0)) << "reset of " << std::hex << e.code;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, BusFault, ::testing::ValuesIn(faults()),
                         [](const auto& kind) { return std::string(kind.param.name); });

// --- drives that do not report (2207h = 0)

class TrustedBusFault : public ::testing::TestWithParam<Fault> {
 protected:
  // Nor does the node complain that the drives it trusts do not report.
  static void expect_no_step(Drives drives, const char* complaint);
};

TEST_P(TrustedBusFault, NoStepAndFullRecovery) { expect_no_step(Drives::trust, "FF21h"); }
TEST_P(TrustedBusFault, NoStepAndFullRecoveryWhereOnlyTheFirstIsTrusted) {
  expect_no_step(Drives::trust_first, "FF21h(1)");
}

void TrustedBusFault::expect_no_step(Drives drives, const char* complaint) {
  const Fault& fault = GetParam();
  BusWorld world(2, bus_machine().image, drives);
  Random random(3);
  ASSERT_TRUE(world.recover(kRecovery)) << world.trouble();
  world.run(300);
  world.mark();
  fault.run(world, random, fault.cycles);
  expect_recovery(world);
  EXPECT_EQ(world.emergencies().find(complaint), std::string::npos) << world.emergencies();
}

// Nothing is lost on the way: a node that trusts could not know.
INSTANTIATE_TEST_SUITE_P(
    Kinds, TrustedBusFault,
    ::testing::Values(Fault{"PortFull", 140, port_full, {}},
                      Fault{"ForeignReport", 100, foreign_report, {}},
                      Fault{"TablesChangedInMotion", 400, tables_changed_in_motion, {}}),
    [](const auto& kind) { return std::string(kind.param.name); });

// Somebody sends a drive an offset of his own: the node finds another value there than it sent, and
// goes back at 2203h per cycle.
TEST(BusFaults, FromAnotherOffsetTheWayBackIsSoft) {
  BusWorld world(5);
  ASSERT_TRUE(world.approach());
  const host::Offsets before = world.offsets();
  const AxisLimits limits = bus_machine_settings().limits.axis[0];
  const std::int32_t far = 3 * limits.rate / 4;  // the intruder shall keep the promise, too
  const auto other = static_cast<std::int32_t>(before[0] < 0 ? before[0] + far : before[0] - far);
  ASSERT_GT(far, 5 * limits.soft_rate);
  hal::CanFrame foreign{0x301, 4, {}};
  store_le(foreign.data.data(), 4, static_cast<std::uint32_t>(other));
  // It counts where it comes between the node's own offset and SYNC.
  std::uint64_t delay_ns = 0;
  world.bus().set_fault_hook([&](const hal::CanFrame& frame, const hal::LoopbackBus::Port&,
                                 const hal::LoopbackBus::Port&) {
    const bool is_foreign = frame.id == foreign.id && frame.data == foreign.data;
    return Fate{false, false, is_foreign ? delay_ns : 0};
  });
  while (world.offsets()[0] != other && delay_ns < kCycle_ns) {
    world.intruder().send(foreign);
    world.stand(1);
    delay_ns += kCycle_ns / 20;
  }
  world.bus().set_fault_hook({});
  ASSERT_EQ(world.offsets()[0], other);
  world.forget_steps();
  world.stand(300);
  EXPECT_TRUE(world.emergency(kNode, 0xFF21));
  EXPECT_EQ(world.offsets(), before);
  EXPECT_EQ(world.largest_step(), limits.soft_rate);
  EXPECT_TRUE(world.violation().empty()) << world.violation();
}

// The controller reads the CRC of the active tables, and sends others.
TEST(BusFaults, OtherTablesOfTheSameMachineComeIntoForce) {
  BusWorld world(4);
  world.run(300);
  const node::NodeObjects& node = world.node();
  const std::uint32_t crc = node.active_crc;
  const std::uint32_t sequence = node.active_sequence;
  world.controller().load_tables(bus_machine().other_image);
  world.run(400);
  EXPECT_NE(node.active_crc, crc);
  EXPECT_EQ(node.active_sequence, sequence + 1);
  world.controller().load_tables(bus_machine().image);
  world.run(400);
  EXPECT_EQ(node.active_crc, crc);
  EXPECT_EQ(node.active_sequence, sequence);
}

// FNV-1a over every frame and its time.
class FrameDigest {
 public:
  void add(std::uint64_t time_ns, const hal::CanFrame& frame) {
    add(time_ns);
    add(frame.id);
    add(frame.size);
    add(load_le(frame.data.data(), 8));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100'0000'01B3U; }
  std::uint64_t value_ = 0xCBF2'9CE4'8422'2325U;
};

// Digests after each fault, whatever it does to the machine.
std::vector<std::uint64_t> frames_of_all_faults(bool rests) {
  constexpr std::uint64_t kSeed = 7;
  constexpr int kAfterwards = 300;
  BusWorld world(kSeed);
  if (!rests) world.axes().bus().serve_always();
  FrameDigest digest;
  world.bus().set_observer(
      [&digest](std::uint64_t time_ns, const hal::CanFrame& frame, const hal::LoopbackBus::Port&) {
        digest.add(time_ns, frame);
      });
  Random random(kSeed);
  std::vector<std::uint64_t> digests;
  for (const Fault& fault : faults()) {
    fault.run(world, random, fault.cycles);
    world.run(kAfterwards);
    digests.push_back(digest.value());
  }
  return digests;
}

TEST(BusFaults, DevicesThatRestSendTheSameFramesAtTheSameTimes) {
  const std::vector<Fault> kinds = faults();
  const std::vector<std::uint64_t> resting = frames_of_all_faults(true);
  const std::vector<std::uint64_t> served = frames_of_all_faults(false);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    ASSERT_EQ(resting[kind], served[kind]) << kinds[kind].name;
}

std::uint64_t first_seed() {
  const char* text = std::getenv("VOLCOMP_FAULT_SEED");
  return text == nullptr ? 1000U : std::strtoull(text, nullptr, 10);
}

TEST(BusFaults, RandomSequences) {
  const std::vector<Fault> kinds = faults();
  for (std::uint64_t s = 0; s < kSequences; ++s) {
    const std::uint64_t seed = first_seed() + s;
    BusWorld world(seed);
    Random random(seed);
    std::string history;
    for (int n = 0; n < kFaultsEach; ++n) {
      const auto kind = static_cast<std::size_t>(random.uniform(0.0, double(kinds.size())));
      const int cycles = 1 + static_cast<int>(random.uniform() * 1.5 * kinds[kind].cycles);
      history += std::string(" ") + kinds[kind].name + " " + std::to_string(cycles);
      SCOPED_TRACE("VOLCOMP_FAULT_SEED=" + std::to_string(seed) + history);
      world.run(static_cast<int>(random.uniform(0.0, 200.0)));
      world.mark();
      kinds[kind].run(world, random, cycles);
      expect_recovery(world);
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace volcomp::sim
