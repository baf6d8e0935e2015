// Everything that can be wrong with a table image or with the moment of a command: the reason, the
// place and the sentence over SDO, the emergency message, and tables that go on as if nothing had
// happened.

#include <limits>

#include "comp/core/bytes.hpp"
#include "comp/tables/image.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

void put(Bytes& image, std::size_t at, std::size_t count, std::uint64_t value) {
  store_le(&image[at], count, value);
}

class NodeRefusals : public ::testing::Test {
 protected:
  NodeRefusals() { bench.bring_up(good); }

  // The node keeps its tables, reports why it refuses others, and takes good ones afterwards.
  void expect_refused(const Bytes& bad, Reason reason, char axis = '\0', int index = -1,
                      int channel = -1) {
    const auto before = bench.offsets();
    const std::uint64_t crc = bench.number(0x2112, 7);
    const std::uint64_t rejections = bench.number(0x2600, 10);
    ASSERT_EQ(bench.write({0x2110, 1}, bad), AbortCode::none);
    EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);

    EXPECT_EQ(bench.number(0x2112, 1), static_cast<std::uint64_t>(TableState::refused));
    EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), reason);
    EXPECT_EQ(static_cast<char>(bench.number(0x2112, 3)), axis);
    EXPECT_EQ(static_cast<std::int16_t>(bench.number(0x2112, 4)), index);
    EXPECT_EQ(static_cast<std::int8_t>(bench.number(0x2112, 5)), channel);
    EXPECT_EQ(bench.text(0x2112, 6), sentence(reason));
    EXPECT_EQ(bench.number(0x2112, 7), crc);
    EXPECT_EQ(bench.number(0x2600, 10), rejections + 1);

    bench.cycles(20);
    EXPECT_TRUE(bench.emergency(ErrorCode::table_refused, static_cast<std::uint8_t>(axis)));
    EXPECT_EQ(bench.offsets(), before);
    EXPECT_EQ(bench.state(), NodeState::compensating);
    expect_good_ones_are_taken();
    EXPECT_EQ(bench.offsets(), before);
  }

  void expect_good_ones_are_taken() {
    bench.load(good);
    bench.cycles(60);
    EXPECT_TRUE(bench.emergency(ErrorCode::none, bench.emergencies.front().source));
    EXPECT_EQ(bench.node->objects().communication.error_register, 0);
    EXPECT_EQ(bench.number(0x2112, 2), static_cast<std::uint64_t>(Reason::ok));
  }

  [[nodiscard]] Bytes resealed(Bytes bytes) const {
    reseal(bytes, good);
    return bytes;
  }

  MachineTables good = bench_tables();
  Bytes image = image_of(good);
  NodeBench bench;
};

TEST_F(NodeRefusals, ResealingAnUndamagedImageChangesNothing) { EXPECT_EQ(resealed(image), image); }

TEST_F(NodeRefusals, Magic) {
  image[0] = 'X';
  expect_refused(resealed(image), Reason::bad_magic);
}

TEST_F(NodeRefusals, Version) {
  put(image, 4, 2, kImageVersion + 1);
  expect_refused(resealed(image), Reason::version_unknown);
}

TEST_F(NodeRefusals, Truncated) {
  image.resize(image.size() - 10);
  expect_refused(image, Reason::image_truncated);
}

TEST_F(NodeRefusals, ChecksumNamesTheAxis) {
  image[image_value_offset(good, 1, 0, 3, 2)] ^= 0x10U;
  expect_refused(image, Reason::crc_mismatch, 'Y');
}

TEST_F(NodeRefusals, NotANumberNamesAxisKnotAndChannel) {
  put(image, image_value_offset(good, 2, 1, 7, 4), 4, 0x7FC00000);
  expect_refused(resealed(image), Reason::not_finite, 'Z', 7, 4);
}

TEST_F(NodeRefusals, InfinityIsNotANumberEither) {
  put(image, image_value_offset(good, 0, 0, 0, 0), 4, 0xFF800000);
  expect_refused(resealed(image), Reason::not_finite, 'X', 0, 0);
}

TEST_F(NodeRefusals, TooFewKnots) {
  put(image, axis_at(good, 0) + 16, 4, 1);
  expect_refused(resealed(image), Reason::too_few_knots, 'X');
}

TEST_F(NodeRefusals, MoreKnotsThanTheNodeHasRoomFor) {
  put(image, axis_at(good, 1) + 16, 4, kNodeKnots + 1);
  expect_refused(resealed(image), Reason::too_many_knots, 'Y');
}

TEST_F(NodeRefusals, PitchOfZero) {
  put(image, axis_at(good, 0) + 8, 8, 0);
  expect_refused(resealed(image), Reason::pitch_not_positive, 'X');
}

TEST_F(NodeRefusals, NegativePitch) {
  put(image, axis_at(good, 2) + 8, 8, static_cast<std::uint64_t>(-40'000'000));
  expect_refused(resealed(image), Reason::pitch_not_positive, 'Z');
}

TEST_F(NodeRefusals, TravelTooLong) {
  put(image, axis_at(good, 0) + 8, 8, 1'000'000'000);
  expect_refused(resealed(image), Reason::travel_too_long, 'X');
}

TEST_F(NodeRefusals, OtherChainWhileRunning) {
  good.machine.body[1].joint.offset[0] += 1.0;
  const Bytes other = image_of(good);
  good = bench_tables();
  expect_refused(other, Reason::machine_mismatch);
}

TEST_F(NodeRefusals, ValuesBeyondTheBoundOfTheRunTime) {
  MachineTables huge = good;
  for (auto& column : huge.axis[0].value) {
    for (Channels& knot : column)
      knot[0] = 1e9F;
  }
  const Bytes bytes = image_of(huge);
  ASSERT_EQ(bench.write({0x2110, 1}, bytes), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::none);  // whole, but not for here
  expect_refused(bytes, Reason::bound_exceeded);
}

TEST(NodeMachineId, TablesOfAnotherMachineAreRefused) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2000, 1, 7), AbortCode::none);
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables())), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::general);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::machine_mismatch);
  EXPECT_TRUE(bench.emergency(ErrorCode::table_refused, 0));
  ASSERT_EQ(bench.set<std::uint32_t>(0x2000, 1, 1001), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::none);
  bench.wait(100'000);
  EXPECT_EQ(bench.node->objects().communication.error_register, 0);
}

// What the node ran before does not bind it to that machine.
TEST(NodeMachineId, AnotherMachineIsTakenOnceTheNodeRests) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2000, 1, 1001), AbortCode::none);
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.cycles(20);
  ASSERT_EQ(bench.state(), NodeState::compensating);
  bench.nmt(NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2000, 1, 2002), AbortCode::none);
  MachineTables other = bench_tables();
  other.provenance.machine_id = 2002;
  other.machine.body[1].joint.offset[0] += 1.0;
  const Bytes bytes = image_of(other);
  ASSERT_EQ(bench.write({0x2110, 1}, bytes), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::arm), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_EQ(bench.number(0x2112, 7), image_crc({bytes.data(), bytes.size()}));
}

// Before the start another machine may still come, but only with tables that can be used.
TEST(NodeMachineId, TablesOfAnotherMachineThatCannotBeUsedCostNothing) {
  NodeBench bench;
  bench.configure();
  const MachineTables good = bench_tables();
  bench.load(good);
  const std::uint64_t crc = bench.number(0x2112, 7);
  MachineTables other = good;
  other.machine.body[1].joint.offset[0] += 1.0;
  for (auto& column : other.axis[0].value) {
    for (Channels& knot : column)
      knot[0] = 1e9F;
  }
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(other)), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::bound_exceeded);
  EXPECT_EQ(bench.number(0x2112, 7), crc);

  bench.nmt(NmtCommand::start);
  bench.cycles(400);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  NodeBench undisturbed;
  undisturbed.bring_up(good);
  EXPECT_EQ(bench.offsets(), undisturbed.offsets());
}

TEST(NodeMachineId, IsAskedAgainWhenTablesAreStaged) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables())), AbortCode::none);
  ASSERT_EQ(bench.command(TableCommand::validate), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2000, 1, 7), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::arm), AbortCode::general);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::machine_mismatch);
}

// --- the right thing at the wrong time

TEST(NodeCommands, NeedAnImage) {
  NodeBench bench;
  for (const TableCommand c : {TableCommand::validate, TableCommand::arm, TableCommand::activate})
    EXPECT_EQ(bench.command(c), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint8_t>(0x2111, 0, 6), AbortCode::value_too_high);
  Bytes nothing;
  EXPECT_EQ(bench.read({0x2110, 1}, nothing), AbortCode::no_data);
}

TEST(NodeCommands, AnImageLargerThanTheBufferIsRefusedAtOnce) {
  NodeBench bench;
  EXPECT_EQ(bench.write({0x2110, 1}, Bytes(kImageCapacity + 1)), AbortCode::out_of_memory);
}

TEST(NodeCommands, SettingsCanNotBeChangedWhileTheAxesMove) {
  NodeBench bench;
  bench.bring_up();
  EXPECT_EQ(bench.set<std::uint32_t>(0x2000, 1, 5), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint8_t>(0x2010, 1, 9), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x2030, 1, 2), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x2200, 1, 1), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::int32_t>(0x2201, 1, 1), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::int32_t>(0x2202, 1, 1), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::int64_t>(0x2205, 1, 1), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::int32_t>(0x2206, 1, 1000), AbortCode::device_state);
}

TEST(NodeCommands, SettingsOutsideTheirRangeAreRefused) {
  NodeBench bench;
  EXPECT_EQ(bench.set<std::uint32_t>(0x2030, 1, 0), AbortCode::value_too_low);
  EXPECT_EQ(bench.set<std::uint32_t>(0x2031, 1, 1'048'577), AbortCode::value_too_high);
  EXPECT_EQ(bench.set<std::int32_t>(0x2201, 1, 4'194'304), AbortCode::value_too_high);
  EXPECT_EQ(bench.set<std::int32_t>(0x2202, 1, 0), AbortCode::value_too_low);
  EXPECT_EQ(bench.set<std::uint8_t>(0x2200, 4, 8), AbortCode::value_too_high);
  EXPECT_EQ(bench.set<std::uint16_t>(0x2201, 1, 1), AbortCode::too_short);
}

// An offset that went out at any other time could be one the gate has not seen.
TEST(NodeCommands, OffsetsAreSentByTheCycleAlone) {
  NodeBench bench;
  bench.configure();
  for (std::uint16_t pdo = 0x1800; pdo < 0x1800 + kNodeAxes; ++pdo) {
    EXPECT_EQ(bench.set<std::uint8_t>(pdo, 2, 1), AbortCode::invalid_value);
    EXPECT_EQ(bench.set<std::uint8_t>(pdo, 2, 0), AbortCode::invalid_value);
    EXPECT_EQ(bench.set<std::uint8_t>(pdo, 2, 255), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint16_t>(pdo, 5, 100), AbortCode::invalid_value);
    EXPECT_EQ(bench.set<std::uint16_t>(pdo, 5, 0), AbortCode::none);
  }
  const auto status = static_cast<std::uint16_t>(0x1800 + kStatusPdo);
  EXPECT_EQ(bench.set<std::uint8_t>(status, 2, 1), AbortCode::none);
  EXPECT_EQ(bench.set<std::uint16_t>(status, 5, 100), AbortCode::none);
}

// A drive takes whatever arrives in its 60B0h: a checksum in its place is a step of any size.
TEST(NodeCommands, MappingOfTheOffsetsIsConstant) {
  NodeBench bench;
  bench.configure();
  for (std::uint8_t a = 0; a < 3; ++a) {
    const auto communication = static_cast<std::uint16_t>(0x1800 + a);
    const auto mapping = static_cast<std::uint16_t>(0x1A00 + a);
    const std::uint64_t cob_id = bench.number(communication, 1);
    const std::uint32_t offset = 0x2020'0020U | (a + 1U) << 8U;
    ASSERT_EQ(bench.set<std::uint32_t>(communication, 1,
                                       static_cast<std::uint32_t>(cob_id | 0x8000'0000U)),
              AbortCode::none);
    EXPECT_EQ(bench.set<std::uint8_t>(mapping, 0, 0), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint32_t>(mapping, 1, 0x2112'0720), AbortCode::not_mappable);
    EXPECT_EQ(bench.set<std::uint32_t>(mapping, 1, 0), AbortCode::not_mappable);
    EXPECT_EQ(bench.set<std::uint32_t>(mapping, 2, 0x2600'0108), AbortCode::not_mappable);
    EXPECT_EQ(bench.set<std::uint8_t>(mapping, 0, 2), AbortCode::not_mappable);
    EXPECT_EQ(bench.set<std::uint32_t>(mapping, 1, offset), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint8_t>(mapping, 0, 1), AbortCode::none);
    EXPECT_EQ(bench.number(mapping, 0), 1U);
    EXPECT_EQ(bench.number(mapping, 1), offset);
  }
}

TEST(NodeCommands, CycleAndSupervisionAreFixedInOperation) {
  NodeBench bench;
  bench.bring_up();
  EXPECT_EQ(bench.set<std::uint32_t>(0x1005, 0, 0x4000'0080), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1006, 0, 0), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1007, 0, 1), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1016, 1, 127U << 16U | 50U), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint16_t>(0x1017, 0, 0), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint8_t>(0x1029, 1, 1), AbortCode::device_state);
  bench.nmt(NmtCommand::enter_pre_operational);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1006, 0, 4000), AbortCode::none);
  EXPECT_EQ(bench.set<std::uint16_t>(0x1017, 0, 200), AbortCode::none);
  EXPECT_EQ(bench.set<std::uint8_t>(0x1029, 1, 1), AbortCode::none);
}

// A PDO that is off or of another type takes the axis out of the cycle.
TEST(NodeCommands, PdosOfTheCycleAreFixedInOperation) {
  NodeBench bench;
  bench.bring_up();
  const auto expect_fixed = [&bench](std::size_t first, std::size_t count) {
    for (std::size_t pdo = first; pdo < first + count; ++pdo) {
      const auto index = static_cast<std::uint16_t>(pdo);
      const auto cob_id = static_cast<std::uint32_t>(bench.number(index, 1));
      EXPECT_EQ(bench.set<std::uint32_t>(index, 1, cob_id | 0x8000'0000U), AbortCode::device_state)
          << index;
      EXPECT_EQ(bench.set<std::uint8_t>(index, 2, 255), AbortCode::device_state) << index;
      EXPECT_EQ(bench.number(index, 1), cob_id);
    }
  };
  expect_fixed(0x1800, kNodeAxes);
  expect_fixed(0x1400, kProcessStatePdo + 1);
  bench.cycles(20);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  const auto off = static_cast<std::uint32_t>(bench.number(0x1800, 1)) | 0x8000'0000U;
  bench.nmt(NmtCommand::enter_pre_operational);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1800, 1, off), AbortCode::none);
}

// Temperatures come in a rhythm of their own; state and points are sent unasked.
TEST(NodeCommands, OtherPdosMayChangeInOperation) {
  NodeBench bench;
  bench.bring_up();
  for (const std::size_t pdo : {0x1400 + kTemperaturePdo, 0x1800 + kStatusPdo}) {
    const auto index = static_cast<std::uint16_t>(pdo);
    const auto cob_id = static_cast<std::uint32_t>(bench.number(index, 1));
    EXPECT_EQ(bench.set<std::uint32_t>(index, 1, cob_id | 0x8000'0000U), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint32_t>(index, 1, cob_id), AbortCode::none);
  }
}

TEST(NodeCommands, ASlewLimitBelowAUnitOfTheDriveIsRefused) {
  NodeBench bench;
  bench.configure();
  bench.load(bench_tables());
  ASSERT_EQ(bench.set<std::uint32_t>(0x2030, 2, 1000), AbortCode::none);
  ASSERT_EQ(bench.set<std::int32_t>(0x2202, 2, 999), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.cycles(100);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::bad_setting);
  EXPECT_EQ(bench.number(0x2112, 4), 1U) << "the second axis";
  EXPECT_EQ(bench.offsets()[1], 0);
  bench.nmt(NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::int32_t>(0x2202, 2, 1000), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.cycles(100);
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

// Tables that were activated wait for the next tick: until then nothing else is taken.
TEST(NodeCommands, NothingElseWhileAHandOverIsPending) {
  NodeBench bench;
  bench.bring_up();
  const Bytes other = image_of(bench_tables(1));
  ASSERT_EQ(bench.write({0x2110, 1}, other), AbortCode::none);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::device_state);
  EXPECT_EQ(bench.write({0x2110, 1}, image_of(bench_tables())), AbortCode::device_state);
  bench.cycle();
  EXPECT_EQ(bench.command(TableCommand::validate), AbortCode::none);
  EXPECT_EQ(bench.number(0x2112, 7), image_crc({other.data(), other.size()}));
}

// Downloaded while compensating: what is active stays what it is until the command.
TEST(NodeCommands, ADownloadAloneChangesNothing) {
  NodeBench bench;
  bench.bring_up();
  const auto before = bench.offsets();
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables(1))), AbortCode::none);
  bench.cycles(30);
  EXPECT_EQ(bench.offsets(), before);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  bench.cycles(60);
  EXPECT_NE(bench.offsets(), before);
  EXPECT_EQ(bench.number(0x2112, 8), 2U);
  EXPECT_LE(bench.largest_step, 20'000);
}

TEST(NodeCommands, DeactivatingRampsToZeroAndActivatingComesBack) {
  NodeBench bench;
  bench.bring_up();
  const auto before = bench.offsets();
  ASSERT_EQ(bench.command(TableCommand::deactivate), AbortCode::none);
  bench.cycles(60);
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{}));
  EXPECT_EQ(bench.state(), NodeState::no_tables);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  bench.cycles(60);
  EXPECT_EQ(bench.offsets(), before);
}

// The client dies: the server gives up, the tables go on, and the next download succeeds.
TEST(NodeCommands, ABrokenDownloadLeavesTheTablesAlone) {
  NodeBench bench;
  bench.bring_up();
  const auto before = bench.offsets();
  const std::uint64_t crc = bench.number(0x2112, 7);
  // Initiate segmented download, size 1000 (CiA 301, 7.2.4.3.3), then one segment.
  bench.give({0x600 + NodeBench::kId, 8, {0x21, 0x10, 0x21, 0x01, 0xE8, 0x03, 0, 0}});
  bench.give({0x600 + NodeBench::kId, 8, {0x00, 1, 2, 3, 4, 5, 6, 7}});
  EXPECT_EQ(bench.node->objects().table_state, static_cast<std::uint8_t>(TableState::receiving));
  bench.cycles(1500);
  EXPECT_EQ(bench.node->objects().table_state, static_cast<std::uint8_t>(TableState::empty));
  EXPECT_EQ(bench.offsets(), before);
  EXPECT_EQ(bench.number(0x2112, 7), crc);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::device_state);
  bench.load(bench_tables());
  bench.cycles(60);
  EXPECT_EQ(bench.offsets(), before);
}

}  // namespace
}  // namespace volcomp::node
