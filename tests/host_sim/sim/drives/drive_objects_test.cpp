// The object dictionary of the drive, as a configuration tool sees it.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kInvalidValue = 0x0609'0030;
constexpr std::uint32_t kReadOnly = 0x0601'0002;
constexpr std::uint32_t kTooHigh = 0x0609'0031;

TEST(DriveObjects, AreSortedWithoutOverlap) {
  const Span<const canopen::Entry> rows = host::cia402_dictionary().rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool in_order =
        rows[i - 1].index < rows[i].index ||
        (rows[i - 1].index == rows[i].index && rows[i - 1].last_sub < rows[i].first_sub);
    EXPECT_TRUE(in_order) << std::hex << rows[i].index;
  }
}

TEST(DriveObjects, SayWhatTheDriveIs) {
  Bench bench;
  EXPECT_EQ(bench.read(0x1000, 0), 0x0002'0192U);  // CiA 402, servo drive
  EXPECT_EQ(bench.read(0x6502, 0), 0xA0U);         // bit 5 homing, bit 7 csp
  EXPECT_EQ(bench.read(0x6061, 0), 8U);
  EXPECT_EQ(bench.read(0x6098, 0), 37U);
  EXPECT_EQ(bench.read(0x6007, 0), 3U);  // quick stop
  EXPECT_EQ(bench.read(0x605A, 0), 2U);
}

// One unit = 10⁻⁹ (prefix F7h = −9) metre (01h). Position = increments · feed / (resolution ·
// gear).
TEST(DriveObjects, AUnitIsANanometre) {
  Bench bench;
  EXPECT_EQ(bench.read(0x60A8, 0), 0xF701'0000U);
  const std::uint64_t feed = std::uint64_t{bench.read(0x6092, 1)} * bench.read(0x6091, 2);
  const std::uint64_t turn = std::uint64_t{bench.read(0x6092, 2)} * bench.read(0x6091, 1);
  EXPECT_EQ(feed * bench.read(0x608F, 2), turn * bench.read(0x608F, 1));
  EXPECT_EQ(bench.read(0x6091, 0), 2U);
}

TEST(DriveObjects, TheCycleIsInSixtyC2) {
  auto settings = Bench::node_three();
  settings.period_s = 0.004;
  Bench four(settings);
  EXPECT_EQ(four.read(0x60C2, 1), 4U);
  EXPECT_EQ(four.read(0x60C2, 2), 0xFDU);  // 10⁻³
  settings.period_s = 0.001'25;
  Bench odd(settings);
  EXPECT_EQ(odd.read(0x60C2, 1), 125U);
  EXPECT_EQ(odd.read(0x60C2, 2), 0xFBU);  // 10⁻⁵
  EXPECT_EQ(odd.write(0x60C2, 1, 125, 1), 0U);
  EXPECT_EQ(odd.write(0x60C2, 2, -5, 1), 0U);
  EXPECT_EQ(odd.write(0x60C2, 1, 2, 1), kInvalidValue);
}

TEST(DriveObjects, WhatItCannotDoIsRefused) {
  Bench bench;
  EXPECT_EQ(bench.write(0x6060, 0, 1, 1), kInvalidValue);  // profile position
  EXPECT_EQ(bench.write(0x605A, 0, 3, 2), kInvalidValue);
  EXPECT_EQ(bench.write(0x605E, 0, 1, 2), kInvalidValue);
  EXPECT_EQ(bench.write(0x6007, 0, 4, 2), kTooHigh);
  EXPECT_NE(bench.write(0x6098, 0, 1, 1), 0U);
  EXPECT_EQ(bench.write(0x6064, 0, 0, 4), kReadOnly);
  EXPECT_EQ(bench.write(0x6092, 1, 1, 4), kReadOnly);
}

TEST(DriveObjects, WhatTheTouchProbeHasCanBeMapped) {
  Bench bench;
  EXPECT_EQ(bench.write(0x1802, 1, 0xC000'0383, 4), 0U);  // TPDO3 invalid
  EXPECT_EQ(bench.write(0x1A02, 0, 0, 1), 0U);
  for (const std::int64_t object : {0x60B9'0010, 0x60BC'0020, 0x60BD'0020, 0x60D2'0020, 0x60D3'0020,
                                    0x60D4'0020, 0x60D6'0010, 0x60D7'0010, 0x60D8'0010}) {
    EXPECT_EQ(bench.write(0x1A02, 1, object, 4), 0U) << std::hex << object;
  }
}

TEST(DriveObjects, DefaultPdosAreTheOnesOfTheNetwork) {
  Bench bench;
  EXPECT_EQ(bench.read(0x1400, 1), 0x203U);
  EXPECT_EQ(bench.read(0x1400, 2), 1U);
  EXPECT_EQ(bench.read(0x1600, 1), 0x6040'0010U);
  EXPECT_EQ(bench.read(0x1600, 2), 0x607A'0020U);
  EXPECT_EQ(bench.read(0x1401, 1), 0x303U);
  EXPECT_EQ(bench.read(0x1601, 1), 0x60B0'0020U);
  EXPECT_EQ(bench.read(0x1800, 1), 0x4000'0183U);
  EXPECT_EQ(bench.read(0x1A00, 3), 0x60B9'0010U);
  EXPECT_EQ(bench.read(0x1801, 2), 0U);
  EXPECT_EQ(bench.read(0x1A01, 2), 0x60D1'0020U);
  EXPECT_EQ(bench.read(0x1802, 2), 254U);
  EXPECT_EQ(bench.read(0x1802, 5), 0U);
  EXPECT_EQ(bench.read(0x1803, 1), 0x4000'0483U);
  EXPECT_EQ(bench.read(0x1A03, 1), 0x60B0'0020U);
}

TEST(DriveObjects, AStatuswordReadOverSdoFollowsAControlwordWrittenOverSdo) {
  Bench bench;
  bench.give(0x603, {0x2B, 0x40, 0x60, 0x00, 0x06, 0x00, 0x00, 0x00});
  EXPECT_EQ(bench.find(0x583), frame(0x583, {0x60, 0x40, 0x60, 0x00, 0, 0, 0, 0}));
  bench.sent.clear();
  bench.give(0x603, {0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0});
  EXPECT_EQ(bench.find(0x583), frame(0x583, {0x4B, 0x41, 0x60, 0x00, 0x31, 0x02, 0, 0}));
}

}  // namespace
}  // namespace volcomp::sim
