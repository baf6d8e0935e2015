// The LAWICEL line codec against the examples of the CAN232 manual, and by properties.

#include "hal/slcan.hpp"

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::SlcanDevice;
using hal::SlcanLine;
using hal::SlcanRequest;
using Event = SlcanLine::Event;

constexpr int kLines = 20'000;

std::string text(const hal::SlcanText& t) { return {t.data(), t.size()}; }

bool parse(const std::string& line, hal::CanFrame& out) {
  return hal::parse_slcan_frame({line.data(), line.size()}, out);
}

// An adapter that stores its frames.
struct Adapter {
  SlcanDevice device{32};
  std::vector<hal::CanFrame> frames;
  bool full = false;

  std::string say(const std::string& bytes) {
    std::string answers;
    for (const char c : bytes) {
      const SlcanRequest request = device.take(c);
      if (request.kind == SlcanRequest::Kind::answer) answers += text(request.answer);
      if (request.kind != SlcanRequest::Kind::frame) continue;
      if (!full) frames.push_back(request.frame);
      answers += full ? hal::kSlcanError : hal::kSlcanOk;
    }
    return answers;
  }
};

// --- frames

TEST(Slcan, FrameOfTheManual) {
  EXPECT_EQ(text(hal::slcan_frame(frame(0x100, {}))), "t1000\r");
  EXPECT_EQ(text(hal::slcan_frame(frame(0x021, {0x33}))), "t021133\r");
}

TEST(Slcan, LongestFrameFillsTheText) {
  const std::string line = text(hal::slcan_frame(frame(0x7FF, {1, 2, 3, 4, 0xAB, 6, 7, 0xFF})));
  EXPECT_EQ(line, "t7FF801020304AB0607FF\r");
  EXPECT_EQ(line.size(), hal::SlcanText::kCapacity);
}

// A size that no frame has is the caller's mistake: it damages no memory.
TEST(Slcan, NoMoreThanTheBytesThereAreIsWritten) {
  hal::CanFrame impossible = frame(0x7FF, {1, 2, 3, 4, 5, 6, 7, 8});
  impossible.size = 15;
  EXPECT_EQ(text(hal::slcan_frame(impossible)), "t7FFF0102030405060708\r");
  hal::SlcanText full;
  for (std::size_t i = 0; i < hal::SlcanText::kCapacity + 5; ++i)
    full.add('x');
  EXPECT_EQ(text(full), std::string(hal::SlcanText::kCapacity, 'x'));
}

TEST(Slcan, EveryFrameComesBack) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kLines; ++i) {
    const hal::CanFrame sent = random_frame(random);
    std::string line = text(hal::slcan_frame(sent));
    ASSERT_EQ(line.back(), '\r');
    line.pop_back();
    hal::CanFrame read;
    ASSERT_TRUE(parse(line, read)) << line;
    ASSERT_EQ(read, sent);
  }
}

TEST(Slcan, LowerCaseDigitsAreReadToo) {
  hal::CanFrame read;
  ASSERT_TRUE(parse("t7fa2abCd", read));
  EXPECT_EQ(read, frame(0x7FA, {0xAB, 0xCD}));
}

TEST(Slcan, WhatIsNoFrameIsRefusedAndLeavesTheFrameAlone) {
  const std::vector<std::vector<const char*>> groups = {
      {"", "t", "t12", "t123"},                   // too short
      {"t1231", "t12311", "t1231112"},            // bytes do not match the size
      {"t8000", "tFFF0"},                         // beyond 11 bits
      {"t1239001122334455667788", "t123A"},       // more than 8 bytes
      {"t1 30", "t12g0", "t1231G1", "t123-"},     // no digits
      {"T000001230", "r1230", "R000001230"},      // 29 bits, remote
      {"x1230", " t1230", "t1230 ", "t12300000"}  // unknown, something before or behind
  };
  for (const std::vector<const char*>& group : groups) {
    for (const char* line : group) {
      hal::CanFrame read = frame(0x055, {9});
      EXPECT_FALSE(parse(line, read)) << line;
      EXPECT_EQ(read, frame(0x055, {9})) << line;
    }
  }
}

// One character of a good line changed: refused, or a line that means the same again.
TEST(Slcan, DamagedLinesNeverBecomeSomethingElseThanTheySay) {
  Random random;
  SCOPED_TRACE(random.trace());
  int refused = 0;
  for (int i = 0; i < kLines; ++i) {
    std::string line = text(hal::slcan_frame(random_frame(random)));
    line.pop_back();
    line.at(
        static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(line.size()) - 1))) =
        static_cast<char>(random.integer(' ', '_'));
    hal::CanFrame read;
    if (!parse(line, read)) {
      ++refused;
      continue;
    }
    ASSERT_EQ(text(hal::slcan_frame(read)), line + "\r");
  }
  EXPECT_GT(refused, 0);
}

// --- lines

TEST(SlcanLine, EndsAtCarriageReturnOnly) {
  SlcanLine line;
  for (const char c : std::string("V\n"))
    EXPECT_EQ(line.take(c), Event::nothing);
  ASSERT_EQ(line.take('\r'), Event::line);
  EXPECT_EQ(std::string(line.line().begin(), line.line().end()), "V\n");
  ASSERT_EQ(line.take('\r'), Event::line);
  EXPECT_TRUE(line.line().empty());
}

TEST(SlcanLine, FullLineIsKeptAndOneMoreCharacterLosesIt) {
  SlcanLine line;
  const std::string longest(SlcanLine::kCapacity, 'x');
  for (const char c : longest)
    line.take(c);
  ASSERT_EQ(line.take('\r'), Event::line);
  EXPECT_EQ(line.line().size(), SlcanLine::kCapacity);
  for (const char c : longest + "x")
    line.take(c);
  ASSERT_EQ(line.take('\r'), Event::too_long);
  EXPECT_TRUE(line.line().empty());
  EXPECT_EQ(line.take('O'), Event::nothing);
  ASSERT_EQ(line.take('\r'), Event::line);
  EXPECT_EQ(line.line().size(), 1U);
}

TEST(SlcanLine, BellIsARefusalWhereverItStands) {
  SlcanLine line;
  line.take('t');
  EXPECT_EQ(line.take('\a'), Event::refused);
  EXPECT_EQ(line.take('\r'), Event::line);
  EXPECT_EQ(line.line().size(), 1U);
}

// --- the adapter

TEST(SlcanDevice, OpensAndClosesAndTellsWhenThereIsNothingToDo) {
  Adapter a;
  EXPECT_EQ(a.say("C\r"), "\a");
  EXPECT_EQ(a.say("S8\rO\r"), "\r\r");
  EXPECT_TRUE(a.device.open());
  EXPECT_EQ(a.say("O\r"), "\a");
  EXPECT_TRUE(a.device.open());
  EXPECT_EQ(a.say("C\r"), "\r");
  EXPECT_FALSE(a.device.open());
}

TEST(SlcanDevice, BitRateOnlyWhileClosedAndOnlyThoseOfTheManual) {
  Adapter a;
  EXPECT_EQ(a.say("S0\rS8\r"), "\r\r");
  EXPECT_EQ(a.say("S9\rS\rS88\rSx\rS/\r"), "\a\a\a\a\a");
  a.say("O\r");
  EXPECT_EQ(a.say("S8\r"), "\a");
}

TEST(SlcanDevice, TellsVersionSerialNumberAndFlagsInTheManualsForm) {
  Adapter a;
  EXPECT_EQ(a.say("V\r"), "V0101\r");
  EXPECT_EQ(a.say("N\r"), "N0032\r");
  EXPECT_EQ(a.say("F\r"), "\a") << "flags only while open";
  a.say("O\r");
  EXPECT_EQ(a.say("F\r"), "F00\r");
}

TEST(SlcanDevice, SerialNumberHasFourDecimalDigits) {
  Adapter a;
  a.device = SlcanDevice(1906);
  EXPECT_EQ(a.say("N\r"), "N1906\r");
}

TEST(SlcanDevice, FlagsAreKeptUntilTheyAreRead) {
  Adapter a;
  a.say("O\r");
  a.device.raise(SlcanDevice::receive_queue_full);
  a.device.raise(SlcanDevice::data_overrun);
  EXPECT_EQ(a.say("F\rF\r"), "F09\rF00\r");
}

TEST(SlcanDevice, FramesGoOutWhileOpen) {
  Adapter a;
  EXPECT_EQ(a.say("t1230\r"), "\a");
  EXPECT_EQ(a.say("O\rt1230\rt7FF2A1B2\r"), "\r\r\r");
  EXPECT_EQ(a.frames, (std::vector{frame(0x123), frame(0x7FF, {0xA1, 0xB2})}));
  a.full = true;
  EXPECT_EQ(a.say("t1230\r"), "\a");
}

TEST(SlcanDevice, RefusesWhatCanopenHasNoUseFor) {
  Adapter a;
  a.say("O\r");
  EXPECT_EQ(a.say("T000001230\rr1230\rR000001230\r"), "\a\a\a");
  EXPECT_TRUE(a.frames.empty());
}

TEST(SlcanDevice, TimeStampsAreOffAndStayOff) {
  Adapter a;
  EXPECT_EQ(a.say("Z0\rZ1\r"), "\r\a");
}

TEST(SlcanDevice, RefusesWhatItDoesNotKnow) {
  Adapter a;
  EXPECT_EQ(a.say("L\rs0014\rM00000000\rX1\r?\rOO\rC \rVV\rNN\rFF\r"), std::string(10, '\a'));
}

TEST(SlcanDevice, EmptyLinesAndRefusalsFromTheHostChangeNothing) {
  Adapter a;
  EXPECT_EQ(a.say("\r\r\r"), "");
  EXPECT_EQ(a.say("\aO\a\r"), "\r");
  EXPECT_TRUE(a.device.open());
}

TEST(SlcanDevice, RecoversFromAnOverlongLine) {
  Adapter a;
  a.say("O\r");
  EXPECT_EQ(a.say(std::string(1000, '0') + "\rt1230\r"), "\a\r");
  EXPECT_EQ(a.frames.size(), 1U);
}

// Whatever comes in, every line gets one answer at most and the next good line works.
TEST(SlcanDevice, SurvivesRandomBytes) {
  Random random;
  SCOPED_TRACE(random.trace());
  Adapter a;
  for (int i = 0; i < kLines; ++i) {
    std::string noise;
    for (std::int64_t n = random.integer(0, 40); n > 0; --n)
      noise += static_cast<char>(random.integer(0, 255));
    a.say(noise + "\rC\r");
    ASSERT_FALSE(a.device.open());
    ASSERT_EQ(a.say("O\rt1230\r"), "\r\r");
  }
}

}  // namespace
}  // namespace volcomp::test
