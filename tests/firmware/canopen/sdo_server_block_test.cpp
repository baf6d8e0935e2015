// Block transfers, byte by byte as in CiA 301, sections 7.2.4.3.9 to 7.2.4.3.15.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// "123456789" has the CRC 31C3h: two segments, five bytes of padding.
constexpr SdoData kFirst{0x01, '1', '2', '3', '4', '5', '6', '7'};
constexpr SdoData kSecond{0x82, '8', '9'};

class SdoServerBlocks : public ::testing::Test {
 protected:
  FakeObjects objects;
  SdoServer server{objects};
};

TEST_F(SdoServerBlocks, DownloadWithCrc) {
  const FakeObjects::Object& object = objects.add(kObject, 9);
  EXPECT_THAT(ask(server, {0xC6, 0x10, 0x21, 0x01, 9}),
              ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127}));
  EXPECT_EQ(objects.announced(), 9U);
  EXPECT_THAT(ask(server, kFirst), IsEmpty());
  EXPECT_THAT(ask(server, kSecond), ElementsAre(SdoData{0xA2, 2, 127}));
  EXPECT_THAT(ask(server, {0xD5, 0xC3, 0x31}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(object.value, bytes_of("123456789"));
  EXPECT_TRUE(objects.guards_intact()) << "padding must not reach the memory behind the object";
}

TEST_F(SdoServerBlocks, DownloadWithoutCrcAndSizeIgnoresTheChecksum) {
  const FakeObjects::Object& object = objects.add(kObject, 9);
  EXPECT_THAT(ask(server, {0xC0, 0x10, 0x21, 0x01}),
              ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127}));
  ask(server, kFirst);
  ask(server, kSecond);
  EXPECT_THAT(ask(server, {0xD5, 0xEE, 0xEE}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(object.value, bytes_of("123456789"));
}

TEST_F(SdoServerBlocks, DownloadRepeatsFromTheLastGoodSegment) {
  const FakeObjects::Object& object = objects.add(kObject, 16);
  ask(server, {0xC6, 0x10, 0x21, 0x01, 16});
  EXPECT_THAT(ask(server, {0x01, 'c', 'o', 'm', 'p', 'e', 'n', 's'}), IsEmpty());
  EXPECT_THAT(ask(server, {0x83, '2', '3'}), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(ask(server, {0x01, 'a', 't', 'i', 'o', 'n', ' ', '1'}), IsEmpty());
  EXPECT_THAT(ask(server, {0x82, '2', '3'}), ElementsAre(SdoData{0xA2, 2, 127}));
  EXPECT_THAT(ask(server, {0xD5, 0x75, 0xC6}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(object.value, bytes_of("compensation 123"));
}

TEST_F(SdoServerBlocks, DownloadConfirmsAFullBlockAndGoesOn) {
  const Bytes value = pattern(128 * kSegmentBytes);
  const FakeObjects::Object& object = objects.add(kObject, value.size());
  ask(server, {0xC2, 0x10, 0x21, 0x01, 0x80, 0x03});
  const auto segment = [&](std::size_t n, std::size_t number) {
    SdoData frame{static_cast<std::uint8_t>(number)};
    std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(7 * n), 7, frame.begin() + 1);
    return frame;
  };
  for (std::size_t n = 0; n < 126; ++n)
    EXPECT_THAT(ask(server, segment(n, n + 1)), IsEmpty());
  EXPECT_THAT(ask(server, segment(126, 127)), ElementsAre(SdoData{0xA2, 127, 127}));
  EXPECT_THAT(ask(server, segment(127, 0x81)), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(ask(server, {0xC1}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(object.value, value);
}

TEST_F(SdoServerBlocks, DownloadOfNothing) {
  const FakeObjects::Object& object = objects.add(kObject, 9, bytes_of("old"));
  ask(server, {0xC6, 0x10, 0x21, 0x01});
  EXPECT_THAT(ask(server, {0x81}), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(ask(server, {0xDD}), ElementsAre(SdoData{0xA1}));
  EXPECT_TRUE(object.value.empty());
}

// An unrequested confirmation would make a client with a queue send the same segments twice.
TEST_F(SdoServerBlocks, LostEndOfABlockEndsTheTransferInTime) {
  objects.add(kObject, 9);
  ask(server, {0xC6, 0x10, 0x21, 0x01, 9}, 0);
  ask(server, kFirst, 1'000);
  for (const std::uint64_t now_us : {501'000U, 999'000U, 1'000'999U}) {
    server.poll(now_us);
    EXPECT_THAT(responses(server), IsEmpty());
  }
  server.poll(1'001'000);
  EXPECT_THAT(responses(server),
              ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_EQ(objects.abandoned(), 1);
}

TEST_F(SdoServerBlocks, UploadWithCrc) {
  objects.add(kObject, 9, bytes_of("123456789"));
  EXPECT_THAT(ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 0}),
              ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01, 9}));
  EXPECT_THAT(ask(server, {0xA3}), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(ask(server, {0xA2, 2, 127}), ElementsAre(SdoData{0xD5, 0xC3, 0x31}));
  EXPECT_THAT(ask(server, {0xA1}), IsEmpty());
  EXPECT_THAT(ask(server, {0xA1}), ElementsAre(SdoData{0x80, 0, 0, 0, 0x01, 0x00, 0x04, 0x05}));
}

TEST_F(SdoServerBlocks, UploadWithoutCrcHasAnEmptyChecksum) {
  objects.add(kObject, 9, bytes_of("123456789"));
  EXPECT_THAT(ask(server, {0xA0, 0x10, 0x21, 0x01, 127, 0}),
              ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01, 9}));
  ask(server, {0xA3});
  EXPECT_THAT(ask(server, {0xA2, 2, 127}), ElementsAre(SdoData{0xD5}));
}

TEST_F(SdoServerBlocks, UploadKeepsToTheBlockSizeOfTheClient) {
  objects.add(kObject, 28, pattern(28));
  ask(server, {0xA4, 0x10, 0x21, 0x01, 1, 0});
  EXPECT_THAT(ask(server, {0xA3}), SizeIs(1));
  EXPECT_THAT(ask(server, {0xA2, 1, 2}), SizeIs(2));
  EXPECT_THAT(ask(server, {0xA2, 2, 127}), SizeIs(1));
}

TEST_F(SdoServerBlocks, UploadRepeatsFromTheLastGoodSegment) {
  objects.add(kObject, 9, bytes_of("123456789"));
  ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 0});
  EXPECT_THAT(ask(server, {0xA3}), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(ask(server, {0xA2, 0, 127}), ElementsAre(kFirst, kSecond));
  EXPECT_THAT(ask(server, {0xA2, 1, 127}), ElementsAre(SdoData{0x81, '8', '9'}));
  EXPECT_THAT(ask(server, {0xA2, 1, 127}), ElementsAre(SdoData{0xD5, 0xC3, 0x31}));
}

TEST_F(SdoServerBlocks, UploadOfNothing) {
  objects.add(kObject, 9);
  EXPECT_THAT(ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 0}),
              ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01}));
  EXPECT_THAT(ask(server, {0xA3}), ElementsAre(SdoData{0x81}));
  EXPECT_THAT(ask(server, {0xA2, 1, 127}), ElementsAre(SdoData{0xDD}));
}

TEST_F(SdoServerBlocks, UploadUpToTheSwitchThresholdIsANormalOne) {
  FakeObjects::Object& object = objects.add(kObject, 9, bytes_of("12345678"));
  EXPECT_THAT(ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 8}),
              ElementsAre(SdoData{0x41, 0x10, 0x21, 0x01, 8}));
  EXPECT_THAT(ask(server, {0x60}), ElementsAre(SdoData{0x00, '1', '2', '3', '4', '5', '6', '7'}));
  EXPECT_THAT(ask(server, {0x70}), ElementsAre(SdoData{0x1D, '8'}));
  EXPECT_THAT(ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 7}),
              ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01, 8}));
  object.value = {0x11, 0x22};
  EXPECT_THAT(ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 8}),
              ElementsAre(SdoData{0x4B, 0x10, 0x21, 0x01, 0x11, 0x22}));
}

// 127 frames at 10 kbit/s take 1.6 s, in which the client has nothing to send.
TEST_F(SdoServerBlocks, ServerThatIsStillSendingDoesNotTimeOut) {
  objects.add(kObject, 28, pattern(28));
  ask(server, {0xA4, 0x10, 0x21, 0x01, 127, 0});
  server.request({0xA3}, 0);
  SdoData frame{};
  for (std::uint64_t second = 1; second <= 4; ++second) {
    ASSERT_TRUE(server.response(frame));
    EXPECT_EQ(frame[0] & 0x7F, second);
    server.poll(second * 1'000'000);
  }
  EXPECT_THAT(ask(server, {0xA2, 4, 127}, 4'500'000), ElementsAre(SdoData{0xC1, 0xA2, 0xF9}));
}

TEST_F(SdoServerBlocks, ClientAbortInsideABlockIsSilent) {
  objects.add(kObject, 9);
  ask(server, {0xC6, 0x10, 0x21, 0x01, 9});
  ask(server, kFirst);
  EXPECT_THAT(ask(server, {0x80, 0x10, 0x21, 0x01, 0, 0, 0, 0x08}), IsEmpty());
  EXPECT_EQ(objects.abandoned(), 1);
}

}  // namespace
}  // namespace volcomp::canopen::test
