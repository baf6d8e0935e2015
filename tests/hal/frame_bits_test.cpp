// Frame lengths against published figures and against a model that works on strings of '0' and '1'.

#include "hal/loopback/frame_bits.hpp"

#include <string>

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::exact_frame_bits;
using hal::frame_crc;
using hal::nominal_frame_bits;
using hal::worst_case_frame_bits;

constexpr int kMeasured = 20'000;

std::string binary(unsigned value, unsigned digits) {
  std::string text;
  for (unsigned i = 0; i < digits; ++i)
    text.insert(text.begin(), ((value >> i) & 1U) != 0 ? '1' : '0');
  return text;
}

// Long division of the message, followed by fifteen zeros, by x15+x14+x10+x8+x7+x4+x3+1.
std::string remainder15(std::string message) {
  const std::string divisor = "1100010110011001";
  message += std::string(15, '0');
  for (std::size_t i = 0; i + 15 < message.size(); ++i) {
    if (message[i] == '0') continue;
    for (std::size_t k = 0; k < divisor.size(); ++k)
      message[i + k] = message[i + k] == divisor[k] ? '0' : '1';
  }
  return message.substr(message.size() - 15);
}

std::string stuffed(const std::string& bits) {
  std::string wire;
  for (const char bit : bits) {
    wire += bit;
    const std::size_t n = wire.size();
    if (n >= 5 && wire.substr(n - 5) == std::string(5, bit)) wire += bit == '0' ? '1' : '0';
  }
  return wire;
}

std::string until_crc(const hal::CanFrame& f) {
  std::string bits = "0" + binary(f.id, 11) + "000" + binary(f.size, 4);
  for (std::size_t i = 0; i < f.size; ++i)
    bits += binary(f.data[i], 8);
  return bits;
}

// Davis, Burns, Bril, Lukkien, "Controller Area Network schedulability analysis: refuted, revisited
// and revised", Real-Time Systems 35 (2007), equation 1: 55 + 10 n bits for 11-bit identifiers.
TEST(FrameBits, WorstCaseIsThePublishedOne) {
  for (std::size_t n = 0; n <= 8; ++n)
    EXPECT_EQ(worst_case_frame_bits(n), 55 + 10 * n);
}

TEST(FrameBits, WithoutStuffingAnEmptyFrameHas47Bits) {
  EXPECT_EQ(nominal_frame_bits(0), 47U);
  EXPECT_EQ(nominal_frame_bits(8), 111U);
}

// 34 zeros up to the end of the CRC, which is zero too: a stuff bit after each fifth.
TEST(FrameBits, AllZeroFrameCarriesSixStuffBits) {
  EXPECT_EQ(frame_crc(frame(0x000)), 0U);
  EXPECT_EQ(exact_frame_bits(frame(0x000)), 47U + 6U);
}

// CRC-15/CAN in the catalogue of parametrised CRC algorithms: check value 059Eh.
TEST(FrameBits, ReferenceDivisionHasTheCatalogueCheckValue) {
  std::string message;
  for (const char c : std::string("123456789"))
    message += binary(static_cast<unsigned char>(c), 8);
  EXPECT_EQ(remainder15(message), binary(0x059E, 15));
}

TEST(FrameBits, CrcIsTheRemainderOfTheReferenceDivision) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kMeasured; ++i) {
    const hal::CanFrame f = random_frame(random);
    ASSERT_EQ(binary(frame_crc(f), 15), remainder15(until_crc(f))) << until_crc(f);
  }
}

TEST(FrameBits, ExactLengthIsThatOfTheStuffedString) {
  Random random(1);
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kMeasured; ++i) {
    const hal::CanFrame f = random_frame(random);
    const std::string bits = until_crc(f);
    ASSERT_EQ(exact_frame_bits(f), stuffed(bits + remainder15(bits)).size() + 13) << bits;
    ASSERT_GE(exact_frame_bits(f), nominal_frame_bits(f.size));
    ASSERT_LE(exact_frame_bits(f), worst_case_frame_bits(f.size));
  }
}

}  // namespace
}  // namespace volcomp::test
