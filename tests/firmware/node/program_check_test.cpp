// The code and constants of a board: a bit that changes is reported at the end of the next whole
// pass.

#include <vector>

#include <gtest/gtest.h>

#include "firmware/node/program_check.hpp"

namespace volcomp::node {
namespace {

constexpr std::size_t kBytes = 1001;
constexpr std::size_t kSlice = 64;
constexpr std::size_t kPass = (kBytes + kSlice - 1) / kSlice;

class Program : public ::testing::Test {
 protected:
  Program() : bytes(kBytes) {
    for (std::size_t i = 0; i < kBytes; ++i)
      bytes[i] = static_cast<std::uint8_t>(i * 37U + i / 256U);
    check.watch({bytes.data(), bytes.size()});
  }

  std::vector<std::uint8_t> bytes;
  ProgramCheck check;
};

TEST_F(Program, UnchangedIsFine) {
  for (std::size_t i = 0; i < 10 * kPass; ++i)
    EXPECT_TRUE(check.step(kSlice));
}

TEST_F(Program, EveryByteIsLookedAt) {
  for (std::size_t i = 0; i < kPass; ++i)
    ASSERT_TRUE(check.step(kSlice));
  for (std::size_t byte = 0; byte < kBytes; ++byte) {
    ProgramCheck one = check;
    for (std::size_t ahead = 0; ahead < byte % kPass; ++ahead)
      ASSERT_TRUE(one.step(kSlice));
    bytes[byte] ^= static_cast<std::uint8_t>(1U << byte % 8);
    std::size_t calls = 1;
    while (calls <= 2 * kPass && one.step(kSlice))
      ++calls;
    EXPECT_LE(calls, 2 * kPass) << byte;
    bytes[byte] ^= static_cast<std::uint8_t>(1U << byte % 8);
    EXPECT_FALSE(one.step(kSlice)) << "what it was then cannot be trusted any more";
  }
}

TEST(NoProgram, IsNeverDamaged) {
  ProgramCheck check;
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(check.step(kSlice));
}

}  // namespace
}  // namespace volcomp::node
