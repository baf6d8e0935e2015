// The records of the frame pipe, byte by byte, as its header describes them.

#include "hal/frame_pipe.hpp"

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::pipe_end_of_turn;
using hal::pipe_frame;
using hal::pipe_quit;
using hal::pipe_record;
using hal::PipeBytes;
using Kind = hal::PipeRecord::Kind;

constexpr int kPiped = 20'000;

TEST(FramePipe, FrameLiesInTheRecordAsDescribed) {
  const PipeBytes expected{0x81, 0x05, 0, 0, 3, 0, 0, 0, 0xAA, 0xBB, 0xCC, 0, 0, 0, 0, 0};
  EXPECT_EQ(pipe_frame(frame(0x581, {0xAA, 0xBB, 0xCC})), expected);
}

TEST(FramePipe, EndOfTurnCarriesTheClock) {
  const PipeBytes expected{0xFE, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1};
  EXPECT_EQ(pipe_end_of_turn(0x0102'0304'0506'0708U), expected);
}

TEST(FramePipe, QuitIsAllOnesAndNothingElse) {
  const PipeBytes expected{0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(pipe_quit(), expected);
}

// What all these comparisons rest on.
TEST(CanFrame, IsToldApartByIdentifierSizeAndDataWithinItsSize) {
  const hal::CanFrame one = frame(0x123, {1, 2});
  EXPECT_NE(one, frame(0x124, {1, 2}));
  EXPECT_NE(one, frame(0x123, {1, 2, 0}));
  EXPECT_NE(one, frame(0x123, {1, 3}));
  hal::CanFrame same = one;
  same.data[2] = 7;
  EXPECT_EQ(one, same);
}

TEST(FramePipe, EveryFrameComesBack) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kPiped; ++i) {
    const hal::CanFrame sent = random_frame(random);
    const hal::PipeRecord read = pipe_record(pipe_frame(sent));
    ASSERT_EQ(read.kind, Kind::frame);
    ASSERT_EQ(read.frame, sent);
  }
}

// A record is good exactly when writing what was read gives the same bytes.
TEST(FramePipe, RandomBytesAreReadOnlyWhenTheyCouldHaveBeenWritten) {
  Random random;
  SCOPED_TRACE(random.trace());
  int good = 0;
  for (int i = 0; i < kPiped; ++i) {
    PipeBytes bytes = random.chance(0.8) ? pipe_frame(random_frame(random)) : pipe_end_of_turn(7);
    if (random.chance(0.7)) {
      bytes.at(static_cast<std::size_t>(random.integer(0, 15))) =
          static_cast<std::uint8_t>(random.integer(0, 255));
    }
    const hal::PipeRecord read = pipe_record(bytes);
    if (read.kind == Kind::malformed) continue;
    ++good;
    ASSERT_EQ(read.kind == Kind::frame ? pipe_frame(read.frame) : pipe_end_of_turn(read.sender_us),
              bytes);
  }
  EXPECT_GT(good, kPiped / 4);
  EXPECT_LT(good, kPiped);
}

struct Damage {
  const char* what;
  PipeBytes bytes;
};

TEST(FramePipe, MalformedRecordsAreRefused) {
  const std::vector<Damage> damages = {
      {"identifier beyond 11 bits", {0x00, 0x08, 0, 0}},
      {"29-bit identifier", {0x01, 0, 0, 0x80}},
      {"size 9", {0x01, 0, 0, 0, 9}},
      {"data beyond the size", {0x01, 0, 0, 0, 1, 0, 0, 0, 5, 6}},
      {"a byte in the unused part", {0x01, 0, 0, 0, 0, 1}},
      {"end of turn with a size", {0xFE, 0xFF, 0xFF, 0xFF, 8}},
      {"quit with data", {0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 1}},
      {"unknown special record", {0xFD, 0xFF, 0xFF, 0xFF}},
  };
  for (const Damage& damage : damages)
    EXPECT_EQ(pipe_record(damage.bytes).kind, Kind::malformed) << damage.what;
}

}  // namespace
}  // namespace volcomp::test
