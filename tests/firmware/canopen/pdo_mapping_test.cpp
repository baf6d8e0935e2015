// PDO parameters over SDO (CiA 301, section 7.5.2.35–38): the order of a remapping, step by step,
// and the abort code of every step out of order.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::IsEmpty;

constexpr std::uint32_t kTarget = 0x607A'0020;
constexpr std::uint32_t kControl = 0x6040'0010;
constexpr std::uint32_t kStatus = 0x6041'0010;
constexpr std::uint32_t kWide = 0x2005'0040;

class PdoMapping : public DeviceTest {
 protected:
  void expect_done(ObjectId object, std::uint32_t value, std::size_t size) {
    EXPECT_EQ(write(object, value, size), AbortCode::none)
        << std::hex << object.index << " " << +object.sub;
  }
};

TEST_F(PdoMapping, RemappingInThePrescribedOrder) {
  expect_done({0x1400, 1}, 0x8000'0205, 4);
  expect_done({0x1600, 0}, 0, 1);
  expect_done({0x1600, 1}, kControl, 4);
  expect_done({0x1600, 2}, kTarget, 4);
  expect_done({0x1600, 0}, 2, 1);
  expect_done({0x1400, 2}, 255, 1);
  expect_done({0x1400, 1}, 0x205, 4);
  EXPECT_EQ(value_of({0x1600, 0}), 2U);
  EXPECT_EQ(value_of({0x1600, 2}), kTarget);
  EXPECT_EQ(value_of({0x1400, 1}), 0x205U);
  start();
  receive(0x205, {0x0F, 0x00, 0x44, 0x33, 0x22, 0x11});
  EXPECT_EQ(objects.control, 0x000F);
  EXPECT_EQ(objects.target, 0x1122'3344);
}

TEST_F(PdoMapping, ValidPdoKeepsItsMapping) {
  expect_done({0x1600, 1}, kTarget, 4);
  expect_done({0x1600, 0}, 1, 1);
  expect_done({0x1400, 1}, 0x205, 4);
  EXPECT_EQ(write({0x1600, 0}, 0, 1), AbortCode::unsupported_access);
  EXPECT_EQ(write({0x1600, 1}, kControl, 4), AbortCode::unsupported_access);
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::unsupported_access), 0x0601'0000U);
}

TEST_F(PdoMapping, EntriesChangeOnlyWithCountZero) {
  expect_done({0x1600, 1}, kTarget, 4);
  expect_done({0x1600, 0}, 1, 1);
  EXPECT_EQ(write({0x1600, 1}, kControl, 4), AbortCode::unsupported_access);
  expect_done({0x1600, 0}, 0, 1);
  expect_done({0x1600, 1}, kControl, 4);
}

// Called directly, without the lookup that a transfer makes before.
TEST_F(PdoMapping, TheTableItselfRefusesWhatIsNotThere) {
  const ObjectDictionary nothing({}, nullptr);
  PdoTable table({rpdos.data(), rpdos.size()}, {tpdos.data(), tpdos.size()}, {}, nothing);
  PdoTable::Value value;
  constexpr std::array<std::uint8_t, 4> zeros{};
  EXPECT_EQ(table.read({0x2000, 0}, value), AbortCode::no_object);
  EXPECT_EQ(table.write({0x2000, 0}, zeros, false), AbortCode::no_object);
  EXPECT_EQ(table.write({0x1400, 3}, zeros, false), AbortCode::no_subindex) << "no inhibit time";
  EXPECT_EQ(table.write({0x1400, 5}, zeros, false), AbortCode::no_subindex) << "no event timer";
  EXPECT_EQ(table.write({0x1800, 4}, zeros, false), AbortCode::no_subindex);
  EXPECT_EQ(table.write({0x1600, 9}, zeros, false), AbortCode::no_subindex);
}

TEST_F(PdoMapping, ObjectsThatDoNotExistAreRefused) {
  EXPECT_EQ(write({0x1600, 1}, 0x5FFF'0010, 4), AbortCode::no_object);
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::no_object), 0x0602'0000U);
  EXPECT_EQ(write({0x1600, 1}, 0x2002'0920, 4), AbortCode::no_subindex);
}

TEST_F(PdoMapping, ObjectsThatCannotBeMappedAreRefused) {
  EXPECT_EQ(write({0x1600, 1}, 0x2000'0010, 4), AbortCode::not_mappable) << "not at all";
  EXPECT_EQ(write({0x1600, 1}, kStatus, 4), AbortCode::not_mappable) << "only into a TPDO";
  EXPECT_EQ(write({0x1A00, 1}, kTarget, 4), AbortCode::not_mappable) << "only into an RPDO";
  EXPECT_EQ(write({0x1600, 1}, 0x607A'0010, 4), AbortCode::not_mappable) << "half of it";
  EXPECT_EQ(write({0x1600, 1}, 0x2002'0008, 4), AbortCode::not_mappable) << "a count";
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::not_mappable), 0x0604'0041U);
}

TEST_F(PdoMapping, MoreThanEightBytesAreRefused) {
  expect_done({0x1A00, 1}, kWide, 4);
  expect_done({0x1A00, 2}, kStatus, 4);
  EXPECT_EQ(write({0x1A00, 0}, 2, 1), AbortCode::mapping_too_long);
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::mapping_too_long), 0x0604'0042U);
  EXPECT_EQ(value_of({0x1A00, 0}), 0U);
  expect_done({0x1A00, 0}, 1, 1);
}

TEST_F(PdoMapping, MoreThanEightEntriesAreRefused) {
  EXPECT_EQ(write({0x1A00, 0}, 9, 1), AbortCode::mapping_too_long);
  EXPECT_EQ(write({0x1A00, 9}, kStatus, 4), AbortCode::no_subindex);
}

TEST_F(PdoMapping, EmptyEntriesCannotBeCounted) {
  expect_done({0x1600, 1}, kTarget, 4);
  EXPECT_EQ(write({0x1600, 0}, 2, 1), AbortCode::not_mappable);
}

// CiA 301, section 7.4.7: data types as dummies, in RPDOs only.
TEST_F(PdoMapping, DummiesSkipBytesOfAnRpdo) {
  expect_done({0x1600, 1}, 0x0005'0008, 4);
  expect_done({0x1600, 2}, 0x0006'0010, 4);
  expect_done({0x1600, 3}, kTarget, 4);
  expect_done({0x1600, 0}, 3, 1);
  expect_done({0x1400, 1}, 0x205, 4);
  start();
  receive(0x205, {0xEE, 0xEE, 0xEE, 0x04, 0x03, 0x02, 0x01});
  EXPECT_EQ(objects.target, 0x0102'0304);
  EXPECT_EQ(write({0x1A00, 1}, 0x0005'0008, 4), AbortCode::not_mappable);
  EXPECT_EQ(write({0x1601, 1}, 0x0005'0010, 4), AbortCode::not_mappable) << "not its length";
  EXPECT_EQ(write({0x1601, 1}, 0x0005'0108, 4), AbortCode::not_mappable) << "has no sub-index";
}

// CiA 301, table 40.
TEST_F(PdoMapping, RestrictedIdentifiersAreRefused) {
  for (const std::uint32_t id : {0x000U, 0x001U, 0x07FU, 0x101U, 0x180U, 0x581U, 0x5FFU, 0x601U,
                                 0x67FU, 0x6E0U, 0x6FFU, 0x701U, 0x77FU, 0x780U, 0x7FFU})
    EXPECT_EQ(write({0x1800, 1}, kPdoNoRtr | id, 4), AbortCode::invalid_value) << std::hex << id;
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::invalid_value), 0x0609'0030U);
}

TEST_F(PdoMapping, OtherIdentifiersAreAccepted) {
  for (const std::uint32_t id : {0x181U, 0x57FU, 0x680U, 0x6DFU}) {
    expect_done({0x1800, 1}, kPdoNoRtr | id, 4);
    expect_done({0x1800, 1}, kPdoInvalid | id, 4);
  }
}

TEST_F(PdoMapping, ExtendedIdentifiersAreRefused) {
  EXPECT_EQ(write({0x1800, 1}, 0x6000'0185, 4), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1800, 1}, 0x4000'0985, 4), AbortCode::invalid_value);
}

TEST_F(PdoMapping, IdentifierOfAValidPdoIsFixed) {
  expect_done({0x1800, 1}, 0x4000'0185, 4);
  EXPECT_EQ(write({0x1800, 1}, 0x4000'0186, 4), AbortCode::invalid_value);
  expect_done({0x1800, 1}, 0x4000'0185, 4);
  expect_done({0x1800, 1}, 0xC000'0185, 4);
  expect_done({0x1800, 1}, 0x4000'0186, 4);
}

// CiA 301, 7.5.2.37: bit 30 = 0 promises an answer to remote requests, which no port receives. In a
// TPDO that is off it promises nothing.
TEST_F(PdoMapping, RemoteRequestsAreNotPromised) {
  for (std::uint16_t tpdo = 0x1800; tpdo < 0x1803; ++tpdo) {
    expect_done({tpdo, 1}, 0x8000'0185, 4);
    EXPECT_EQ(write({tpdo, 1}, 0x185, 4), AbortCode::invalid_value);
    EXPECT_EQ(value_of({tpdo, 1}), 0x8000'0185U);
    expect_done({tpdo, 1}, 0x4000'0185, 4);
    EXPECT_EQ(write({tpdo, 1}, 0x185, 4), AbortCode::invalid_value);
    EXPECT_EQ(value_of({tpdo, 1}), 0x4000'0185U);
  }
  expect_done({0x1400, 1}, 0x205, 4);
}

TEST_F(PdoMapping, ReservedTransmissionTypesAreRefused) {
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool known = type <= 240 || type >= 254;
    ASSERT_EQ(write({0x1800, 2}, type, 1), known ? AbortCode::none : AbortCode::invalid_value)
        << type;
  }
}

TEST_F(PdoMapping, InhibitTimeOfAValidPdoIsFixed) {
  expect_done({0x1800, 3}, 100, 2);
  expect_done({0x1800, 1}, 0x4000'0185, 4);
  EXPECT_EQ(write({0x1800, 3}, 200, 2), AbortCode::unsupported_access);
  EXPECT_EQ(value_of({0x1800, 3}), 100U);
}

TEST_F(PdoMapping, RecordsHaveTheirHighestSubIndex) {
  EXPECT_EQ(value_of({0x1400, 0}), 2U);
  EXPECT_EQ(value_of({0x1800, 0}), 5U);
  EXPECT_EQ(write({0x1400, 0}, 2, 1), AbortCode::read_only);
  EXPECT_EQ(refusal_of({0x1800, 4}), AbortCode::no_subindex) << "reserved";
  EXPECT_EQ(refusal_of({0x1800, 6}), AbortCode::no_subindex);
  EXPECT_EQ(refusal_of({0x1400, 3}), AbortCode::no_subindex);
  EXPECT_EQ(refusal_of({0x1403, 1}), AbortCode::no_object) << "three RPDOs";
  EXPECT_EQ(refusal_of({0x1A03, 0}), AbortCode::no_object);
}

TEST_F(PdoMapping, WrongLengthIsRefused) {
  EXPECT_EQ(write({0x1800, 1}, 0x185, 2), AbortCode::wrong_length);
  EXPECT_EQ(write({0x1800, 2}, 1, 2), AbortCode::too_long);
}

TEST_F(PdoMapping, WhatWaitedForAPdoGoesWithIt) {
  expect_done({0x1600, 1}, kTarget, 4);
  expect_done({0x1600, 0}, 1, 1);
  expect_done({0x1400, 2}, 1, 1);
  expect_done({0x1400, 1}, 0x205, 4);
  expect_done({0x1A00, 1}, kStatus, 4);
  expect_done({0x1A00, 0}, 1, 1);
  expect_done({0x1800, 1}, 0x4000'0185, 4);
  start();
  receive(0x205, {1, 0, 0, 0});
  device.trigger(0);
  device.receive(frame(0x605, {0x23, 0x00, 0x14, 1, 0x05, 0x02, 0, 0x80}), now_us);
  device.receive(frame(0x605, {0x23, 0x00, 0x18, 1, 0x85, 0x01, 0, 0x80}), now_us);
  EXPECT_THAT(sent(0x185), IsEmpty());
  receive(0x080, {});
  EXPECT_EQ(objects.target, 0);
}

}  // namespace
}  // namespace volcomp::canopen::test
