// The object dictionary: what there is, and every reason to refuse a value.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;

class Objects : public DeviceTest {
 protected:
  AbortCode set(ObjectId object, const std::vector<std::uint8_t>& bytes) {
    return device.write(object, {bytes.data(), bytes.size()});
  }
};

TEST_F(Objects, RowsAreInTheOrderOfTheDictionary) {
  const Span<const Entry> rows = device.objects().rows();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool later =
        rows[i].index > rows[i - 1].index ||
        (rows[i].index == rows[i - 1].index && rows[i].first_sub > rows[i - 1].last_sub);
    EXPECT_TRUE(later) << std::hex << rows[i].index << " after " << rows[i - 1].index;
  }
}

TEST_F(Objects, EveryRowIsFoundFromItsFirstToItsLastSubIndex) {
  for (const Entry& row : device.objects().rows()) {
    for (unsigned sub = row.first_sub; sub <= row.last_sub; ++sub) {
      const auto found = device.objects().find({row.index, static_cast<std::uint8_t>(sub)});
      EXPECT_EQ(found.entry, &row);
      EXPECT_EQ(found.why, AbortCode::none);
    }
  }
}

TEST_F(Objects, SubIndexZeroIsTheHighest) {
  EXPECT_EQ(value_of({0x2002, 0}), 4U);
  EXPECT_EQ(value_of({0x1016, 0}), 8U);
  EXPECT_EQ(value_of({0x1018, 0}), 4U);
  EXPECT_EQ(value_of({0x1020, 0}), 2U);
  EXPECT_EQ(value_of({0x1029, 0}), 1U);
  EXPECT_EQ(value_of({0x1200, 0}), 2U);
  EXPECT_EQ(write({0x2002, 0}, 3, 1), AbortCode::read_only);
}

TEST_F(Objects, SubIndexZeroHasOneByte) {
  receive(0x605, {0x40, 0x02, 0x20, 0, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x4F, 0x02, 0x20, 0, 4, 0, 0, 0})));
}

TEST_F(Objects, UnknownOnesAreRefused) {
  EXPECT_EQ(refusal_of({0x0000, 0}), AbortCode::no_object);
  EXPECT_EQ(refusal_of({0x2007, 0}), AbortCode::no_object);
  EXPECT_EQ(refusal_of({0xFFFF, 0xFF}), AbortCode::no_object);
  EXPECT_EQ(refusal_of({0x2002, 5}), AbortCode::no_subindex);
  EXPECT_EQ(refusal_of({0x2000, 1}), AbortCode::no_subindex);
  EXPECT_EQ(write({0x2007, 0}, 0, 1), AbortCode::no_object);
  EXPECT_EQ(write({0x2002, 5}, 0, 4), AbortCode::no_subindex);
}

TEST_F(Objects, ElementsOfAnArrayFollowEachOther) {
  for (std::uint8_t sub = 1; sub <= 4; ++sub)
    ASSERT_EQ(write({0x2002, sub}, 0x1000U * sub, 4), AbortCode::none);
  EXPECT_THAT(objects.list, ElementsAre(0x1000U, 0x2000U, 0x3000U, 0x4000U));
  EXPECT_EQ(value_of({0x2002, 3}), 0x3000U);
}

TEST_F(Objects, RangeIsInclusive) {
  EXPECT_EQ(write({0x2000, 0}, 9, 2), AbortCode::value_too_low);
  EXPECT_EQ(write({0x2000, 0}, 10, 2), AbortCode::none);
  EXPECT_EQ(write({0x2000, 0}, 1000, 2), AbortCode::none);
  EXPECT_EQ(write({0x2000, 0}, 1001, 2), AbortCode::value_too_high);
  EXPECT_EQ(objects.word, 1000) << "a refused value changes nothing";
}

TEST_F(Objects, RangeOfASignedValueKnowsItsSign) {
  EXPECT_EQ(write({0x2001, 0}, 0xFA, 1), AbortCode::value_too_low);
  EXPECT_EQ(write({0x2001, 0}, 0xFB, 1), AbortCode::none);
  EXPECT_EQ(objects.small, -5);
  EXPECT_EQ(write({0x2001, 0}, 5, 1), AbortCode::none);
  EXPECT_EQ(write({0x2001, 0}, 6, 1), AbortCode::value_too_high);
}

TEST_F(Objects, LengthIsThatOfTheType) {
  EXPECT_EQ(write({0x2000, 0}, 100, 4), AbortCode::too_long);
  EXPECT_EQ(write({0x2000, 0}, 100, 3), AbortCode::too_long);
  EXPECT_EQ(write({0x2000, 0}, 100, 1), AbortCode::too_short);
  EXPECT_EQ(set({0x2000, 0}, {}), AbortCode::too_short);
  EXPECT_EQ(objects.word, 0);
}

// CiA 301, section 7.2.4.3: with s = 0 the number of bytes is not stated; the object's own counts.
TEST_F(Objects, ExpeditedWriteMayLeaveItsLengthOpen) {
  receive(0x605, {0x22, 0x00, 0x20, 0, 100, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x60, 0x00, 0x20, 0, 0, 0, 0, 0})));
  EXPECT_EQ(objects.word, 100);
}

TEST_F(Objects, PdoParameterMayLeaveItsLengthOpen) {
  receive(0x605, {0x22, 0x00, 0x18, 2, 1, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x60, 0x00, 0x18, 2, 0, 0, 0, 0})));
  EXPECT_EQ(tpdos[0].parameters().type, 1);
}

TEST_F(Objects, ConstantsAndReadOnlyValuesCannotBeWritten) {
  EXPECT_EQ(write({0x1000, 0}, 0, 4), AbortCode::read_only);
  EXPECT_EQ(write({0x1018, 1}, 0, 4), AbortCode::read_only);
  EXPECT_EQ(write({0x2006, 0}, 0, 2), AbortCode::read_only);
  EXPECT_EQ(write({0x6041, 0}, 0, 2), AbortCode::read_only);
  EXPECT_EQ(set({0x2006, 0}, {0, 0}), AbortCode::read_only) << "not from within either";
  EXPECT_EQ(value_of({0x2006, 0}), 0xFFFEU);
}

TEST_F(Objects, WriteOnlyValuesCannotBeRead) {
  EXPECT_EQ(write({0x2004, 0}, 42, 1), AbortCode::none);
  EXPECT_EQ(objects.secret, 42);
  EXPECT_EQ(refusal_of({0x2004, 0}), AbortCode::write_only);
}

TEST_F(Objects, StringsEndWhereTheyEnd) {
  ASSERT_EQ(set({0x2003, 0}, {'l', 'o', 'n', 'g', 'e', 'r'}), AbortCode::none);
  ASSERT_EQ(set({0x2003, 0}, {'a', 'b', 'c'}), AbortCode::none);
  EXPECT_THAT(objects.text, ElementsAre('a', 'b', 'c', 0, 0, 0, 0, 0));
  receive(0x605, {0x40, 0x03, 0x20, 0, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x47, 0x03, 0x20, 0, 'a', 'b', 'c', 0})));
}

TEST_F(Objects, StringsMayBeFull) {
  EXPECT_EQ(set({0x2003, 0}, {'1', '2', '3', '4', '5', '6', '7', '8'}), AbortCode::none);
  receive(0x605, {0x40, 0x03, 0x20, 0, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x41, 0x03, 0x20, 0, 8, 0, 0, 0})));
  EXPECT_EQ(set({0x2003, 0}, std::vector<std::uint8_t>(9, 'x')), AbortCode::too_long);
}

// --- over the bus, byte by byte

TEST_F(Objects, VendorIdIsReadExpedited) {
  receive(0x605, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x43, 0x18, 0x10, 0x01, 0x11, 0, 0, 0})));
}

TEST_F(Objects, HeartbeatTimeIsWrittenAndReadExpedited) {
  receive(0x605, {0x2B, 0x17, 0x10, 0, 0xF4, 0x01, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x60, 0x17, 0x10, 0, 0, 0, 0, 0})));
  receive(0x605, {0x40, 0x17, 0x10, 0, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x4B, 0x17, 0x10, 0, 0xF4, 0x01, 0, 0})));
  EXPECT_EQ(objects.communication.producer_heartbeat_ms, 500);
}

TEST_F(Objects, RefusalNamesObjectAndReason) {
  receive(0x605, {0x40, 0x07, 0x20, 0x02, 0, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, {0x80, 0x07, 0x20, 0x02, 0, 0, 0x02, 0x06})));
}

TEST_F(Objects, SdoIdentifiersFollowTheNode) {
  EXPECT_EQ(value_of({0x1200, 1}), 0x605U);
  EXPECT_EQ(value_of({0x1200, 2}), 0x585U);
}

}  // namespace
}  // namespace volcomp::canopen::test
