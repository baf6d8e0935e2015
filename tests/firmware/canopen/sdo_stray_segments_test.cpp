// Segments of a block download that still arrive after the server has given it up. Their first byte
// is a number from 1 to 127, with bit 7 in the last one, and looks like any command but the abort
// 80h (CiA 301, section 7.2.4.3): none of them may be executed.

#include <random>

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr ObjectId kRegister{0x2000, 0x01};
constexpr ObjectId kTableCommand{0x2111, 0x00};
constexpr SdoData kStart{0xC6, 0x10, 0x21, 0x01, 9};
constexpr SdoData kTooMuch{0x02};  // nine bytes are announced, the second segment is the last
constexpr SdoData kClientAbort{0x80, 0x10, 0x21, 0x01, 0, 0, 0, 0x08};
// As segments: 35, 47, 64, 65 and 96 of a block, the last with bit 7.
constexpr SdoData kWrites{0x23, 0x00, 0x20, 0x01, 0xEF, 0xBE, 0xAD, 0xDE};
constexpr SdoData kDeactivates{0x2F, 0x11, 0x21, 0x00, 0x04};
constexpr SdoData kReads{0x40, 0x00, 0x20, 0x01};
constexpr SdoData kBeginsBlocks{0x41, 0x10, 0x21, 0x01};
constexpr SdoData kLastBeginsBlocks{0xC0, 0x10, 0x21, 0x01};

class StraySegments : public ::testing::Test {
 protected:
  void SetUp() override {
    objects.add(kObject, 9, bytes_of("old"));
    objects.add(kRegister, 4, {1, 2, 3, 4});
    objects.add(kTableCommand, 1, {0});
  }
  void give_up(std::uint64_t now_us = 0) {
    ask(server, kStart, now_us);
    ask(server, {0x01}, now_us);
    ASSERT_THAT(ask(server, kTooMuch, now_us),
                ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x12, 0, 7, 6}));
  }
  void expect_nothing_happened() {
    EXPECT_EQ(objects.at(kObject).value, bytes_of("old"));
    EXPECT_EQ(objects.at(kRegister).value, Bytes({1, 2, 3, 4}));
    EXPECT_EQ(objects.at(kTableCommand).value, Bytes({0}));
    EXPECT_EQ(objects.finished(), 0);
  }
  void expect_served(std::uint64_t now_us) {
    EXPECT_THAT(ask(server, kReads, now_us),
                ElementsAre(SdoData{0x43, 0x00, 0x20, 0x01, 1, 2, 3, 4}));
  }

  FakeObjects objects;
  SdoServer server{objects};
};

TEST_F(StraySegments, AreNeitherExecutedNorAnswered) {
  give_up();
  for (const SdoData& segment : {kWrites, kDeactivates, kReads, kBeginsBlocks, kLastBeginsBlocks,
                                 SdoData{0x60}, SdoData{0xE0}})
    EXPECT_THAT(ask(server, segment), IsEmpty()) << +segment[0];
  expect_nothing_happened();
}

TEST_F(StraySegments, LeaveTheFirstReasonAlone) {
  ask(server, kStart);
  ask(server, {0x01});
  server.request(kTooMuch, 0);
  server.request({0x03}, 0);
  server.request(kWrites, 0);
  server.poll(0);
  EXPECT_THAT(responses(server), ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x12, 0, 7, 6}));
}

TEST_F(StraySegments, EndWithTheAbortOfTheClient) {
  give_up();
  ask(server, kWrites);
  EXPECT_THAT(ask(server, kClientAbort), IsEmpty());
  expect_served(0);
}

TEST_F(StraySegments, EndWithAPauseOfTheTimeout) {
  give_up(0);
  ask(server, kWrites, 500'000);
  server.poll(1'499'999);
  EXPECT_THAT(ask(server, kDeactivates, 1'499'999), IsEmpty()) << "each starts the pause again";
  server.poll(2'499'999);
  EXPECT_THAT(responses(server), IsEmpty());
  expect_nothing_happened();
  expect_served(2'500'000);
}

TEST_F(StraySegments, AreExpectedAfterATimeoutToo) {
  ask(server, kStart, 0);
  server.poll(1'000'000);
  EXPECT_THAT(responses(server), ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0, 0, 4, 5}));
  server.poll(1'001'000);
  EXPECT_THAT(ask(server, kWrites, 1'002'000), IsEmpty()) << "the client was only late";
  expect_nothing_happened();
}

// The last segment is there, the end is awaited, and the client sends the block again.
TEST_F(StraySegments, AreExpectedWhereTheEndIs) {
  ask(server, kStart);
  ask(server, {0x01});
  EXPECT_THAT(ask(server, {0x82}), ElementsAre(SdoData{0xA2, 2, 127}));
  EXPECT_THAT(ask(server, kWrites), ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 1, 0, 4, 5}));
  EXPECT_THAT(ask(server, kDeactivates), IsEmpty());
  expect_nothing_happened();
}

// A controller that misses the acknowledge of its frame sends it twice (ISO 11898-1).
TEST_F(StraySegments, FramesThatComeTwiceCountOnce) {
  constexpr SdoData first{0x01, '1', '2', '3', '4', '5', '6', '7'};
  constexpr SdoData second{0x82, '8', '9'};
  EXPECT_THAT(ask(server, kStart), ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127}));
  EXPECT_THAT(ask(server, kStart), IsEmpty());
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT(ask(server, first), IsEmpty());
  EXPECT_THAT(ask(server, second), ElementsAre(SdoData{0xA2, 2, 127}));
  EXPECT_THAT(ask(server, second), IsEmpty());
  EXPECT_THAT(ask(server, {0xD5, 0xC3, 0x31}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(objects.at(kObject).value, bytes_of("123456789"));
}

TEST_F(StraySegments, ANewTransferAfterAnEndThatTheObjectRefusesIsServedAtOnce) {
  objects.at(kObject).on_finish = AbortCode::device_state;
  ask(server, kStart);
  ask(server, {0x01, '1', '2', '3', '4', '5', '6', '7'});
  ask(server, {0x82, '8', '9'});
  EXPECT_THAT(ask(server, {0xD5, 0xC3, 0x31}),
              ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x22, 0, 0, 8}));
  expect_served(0);
}

// Whatever of a table the client loses, doubles, sends again or in any order before and after an
// abort. The table consists of commands.
TEST_F(StraySegments, NoByteOfATableIsExecuted) {
  constexpr std::size_t kSize = 1000;
  objects.add(kObject, kSize, bytes_of("old"));
  const SdoData start{0xC6, 0x10, 0x21, 0x01, kSize & 0xFFU, kSize >> 8U};
  const std::vector<SdoData> traps{kWrites,
                                   kDeactivates,
                                   kReads,
                                   kBeginsBlocks,
                                   {0xA4, 0x00, 0x20, 0x01, 127},
                                   {0x21, 0x00, 0x20, 0x01, 4}};
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
    std::uint64_t now_us = 0;
    ask(server, kClientAbort, now_us);
    ASSERT_THAT(ask(server, start, now_us), ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127}));
    unsigned number = 0;
    for (int frame = 0; frame < 600; ++frame) {
      SdoData segment = traps[below(static_cast<unsigned>(traps.size()))];
      const unsigned what = below(16);
      ++number;                                    // as it should be, or
      if (what == 0) number += 1U + below(3);      // lost
      if (what == 1) number = 1;                   // the block again
      if (what == 2) number = 1U + below(127);     // anything
      if (what == 3) number = segment[0] & 0x7FU;  // what the command needs
      if (number > 127) number = 1;
      segment[0] = static_cast<std::uint8_t>(number | (below(40) == 0 ? 0x80U : 0U));
      for (unsigned again = below(12) == 0 ? 2 : 1; again > 0; --again) {
        for (const SdoData& answer : ask(server, segment, now_us))
          ASSERT_TRUE(answer[0] == 0xA2 || answer[0] == 0x80) << +segment[0] << " " << +answer[0];
      }
      now_us += below(8) == 0 ? 990'000U : below(20'000);  // longer than half the timeout
      server.poll(now_us);
      for (const SdoData& answer : responses(server))
        ASSERT_EQ(answer[0], 0x80) << "only the end of the time has an answer of its own";
    }
    expect_nothing_happened();
    ASSERT_TRUE(objects.guards_intact());
  }
}

}  // namespace
}  // namespace volcomp::canopen::test
