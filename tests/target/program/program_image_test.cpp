// The check of code and constants over this very image: all of it can be read, nothing changes by
// itself, and a changed bit in a copy of a piece of it in RAM is reported.

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "firmware/node/program_check.hpp"

namespace volcomp::node {
namespace {

constexpr std::size_t kPiece = 192;

Span<const std::uint8_t> image() {
  return {code_begin, boards::address_of(constants_end) - boards::address_of(code_begin)};
}

TEST(ProgramImage, CanBeReadAndStaysAsItIs) {
  ASSERT_GT(image().size(), 4096U);
  ProgramCheck check;
  check.watch(image());
  for (std::size_t i = 0; i < 3 * (image().size() / kPiece + 1); ++i)
    ASSERT_TRUE(check.step(kPiece));
}

// Code that one bit makes other code.
TEST(ProgramImage, OneChangedBitIsTold) {
  static std::array<std::uint8_t, 4096> copy;
  std::copy_n(image().begin(), copy.size(), copy.begin());
  ProgramCheck check;
  check.watch({copy.data(), copy.size()});
  constexpr std::size_t kCalls = (copy.size() + kPiece - 1) / kPiece;
  for (std::size_t i = 0; i < kCalls + 5; ++i)
    ASSERT_TRUE(check.step(kPiece));
  copy[100] ^= 0x08U;  // behind the place that is read next
  std::size_t calls = 1;
  while (calls <= 2 * kCalls && check.step(kPiece))
    ++calls;
  EXPECT_GT(calls, kCalls - 5);
  EXPECT_LE(calls, 2 * kCalls);
}

}  // namespace
}  // namespace volcomp::node
