// The checksum of block transfers and the words for abort codes.

#include <set>

#include "firmware/canopen/crc16.hpp"
#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

std::uint16_t crc_of(const Bytes& bytes) { return crc16({bytes.data(), bytes.size()}); }

TEST(SdoCrc, CheckValueOfCia301) { EXPECT_EQ(crc_of(bytes_of("123456789")), 0x31C3); }

TEST(SdoCrc, NothingIsZero) { EXPECT_EQ(crc_of({}), 0); }

TEST(SdoCrc, PartsGiveTheSameAsTheWhole) {
  const Bytes whole = pattern(100);
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    const std::uint16_t first = crc16({whole.data(), cut});
    EXPECT_EQ(crc16({whole.data() + cut, whole.size() - cut}, first), crc_of(whole));
  }
}

TEST(SdoCrc, MessageFollowedByItsCrcLeavesNoRemainder) {
  for (std::size_t size = 1; size < 50; ++size) {
    Bytes bytes = pattern(size);
    const std::uint16_t crc = crc_of(bytes);
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
    bytes.push_back(static_cast<std::uint8_t>(crc));
    EXPECT_EQ(crc_of(bytes), 0);
  }
}

TEST(SdoCrc, EveryBurstOfUpTo16BitsIsNoticed) {
  const Bytes good = pattern(9);
  for (std::size_t byte = 0; byte + 2 < good.size(); ++byte) {
    for (std::uint32_t burst = 1; burst < 0x10000; ++burst) {
      Bytes bad = good;
      bad[byte] ^= static_cast<std::uint8_t>(burst);
      bad[byte + 1] ^= static_cast<std::uint8_t>(burst >> 8U);
      ASSERT_NE(crc_of(bad), crc_of(good));
    }
  }
}

// CiA 301, table 22.
constexpr std::array<std::uint32_t, 27> kCodes{
    0x05030000, 0x05040000, 0x05040001, 0x05040002, 0x05040003, 0x05040004, 0x05040005,
    0x06010000, 0x06010001, 0x06010002, 0x06020000, 0x06040041, 0x06040042, 0x06040043,
    0x06060000, 0x06070010, 0x06070012, 0x06070013, 0x06090011, 0x06090030, 0x06090031,
    0x06090032, 0x08000000, 0x08000020, 0x08000021, 0x08000022, 0x08000024};

TEST(AbortCodes, EachHasItsOwnSentence) {
  std::set<std::string> sentences{sentence(AbortCode::none), sentence(AbortCode{0x12345678})};
  for (const std::uint32_t code : kCodes)
    sentences.insert(sentence(AbortCode{code}));
  EXPECT_EQ(sentences.size(), kCodes.size() + 2);
}

}  // namespace
}  // namespace volcomp::canopen::test
