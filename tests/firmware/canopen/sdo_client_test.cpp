// What the client sends, byte by byte, and how it ends.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using State = SdoClient::State;

class SdoClientFrames : public ::testing::Test {
 protected:
  void download(const Bytes& bytes) {
    source = bytes;
    client.download(kObject, {source.data(), source.size()}, 0);
  }
  void upload(std::size_t capacity) {
    sink.assign(capacity, 0);
    client.upload(kObject, {sink.data(), sink.size()}, 0);
  }
  std::vector<SdoData> requests() {
    std::vector<SdoData> all;
    SdoData frame{};
    while (all.size() <= 127 && client.request(frame))
      all.push_back(frame);
    return all;
  }
  std::vector<SdoData> after(const SdoData& response, std::uint64_t now_us = 0) {
    client.response(response, now_us);
    return requests();
  }
  void expect_failed(AbortCode code, bool by_server) {
    EXPECT_EQ(client.state(), State::failed);
    EXPECT_EQ(client.abort_code(), code);
    EXPECT_EQ(client.aborted_by_server(), by_server);
  }
  [[nodiscard]] Bytes got() const {
    return {sink.begin(), sink.begin() + static_cast<std::ptrdiff_t>(client.transferred())};
  }

  SdoClient client;
  Bytes source;
  Bytes sink;
};

TEST_F(SdoClientFrames, ExpeditedDownload) {
  EXPECT_EQ(client.state(), State::idle);
  download({0x11, 0x22, 0x33});
  EXPECT_EQ(client.state(), State::busy);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0x27, 0x10, 0x21, 0x01, 0x11, 0x22, 0x33}));
  EXPECT_THAT(after({0x60, 0x10, 0x21, 0x01}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(client.transferred(), 3U);
}

TEST_F(SdoClientFrames, ExpeditedUpload) {
  upload(8);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0x40, 0x10, 0x21, 0x01}));
  EXPECT_THAT(after({0x4B, 0x10, 0x21, 0x01, 0x11, 0x22}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(got(), Bytes({0x11, 0x22}));
}

TEST_F(SdoClientFrames, SegmentedDownload) {
  download(bytes_of("123456789"));
  EXPECT_THAT(requests(), ElementsAre(SdoData{0x21, 0x10, 0x21, 0x01, 9}));
  EXPECT_THAT(after({0x60, 0x10, 0x21, 0x01}),
              ElementsAre(SdoData{0x00, '1', '2', '3', '4', '5', '6', '7'}));
  EXPECT_THAT(after({0x20}), ElementsAre(SdoData{0x1B, '8', '9'}));
  EXPECT_EQ(client.state(), State::busy);
  EXPECT_THAT(after({0x30}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(client.transferred(), 9U);
}

TEST_F(SdoClientFrames, SegmentedUpload) {
  upload(16);
  requests();
  EXPECT_THAT(after({0x41, 0x10, 0x21, 0x01, 9}), ElementsAre(SdoData{0x60}));
  EXPECT_THAT(after({0x00, '1', '2', '3', '4', '5', '6', '7'}), ElementsAre(SdoData{0x70}));
  EXPECT_THAT(after({0x1B, '8', '9'}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(got(), bytes_of("123456789"));
}

TEST_F(SdoClientFrames, BlockDownload) {
  client.set_block_threshold(5);
  download(bytes_of("123456789"));
  EXPECT_THAT(requests(), ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01, 9}));
  EXPECT_THAT(
      after({0xA4, 0x10, 0x21, 0x01, 127}),
      ElementsAre(SdoData{0x01, '1', '2', '3', '4', '5', '6', '7'}, SdoData{0x82, '8', '9'}));
  EXPECT_THAT(after({0xA2, 1, 127}), ElementsAre(SdoData{0x81, '8', '9'})) << "one was lost";
  EXPECT_THAT(after({0xA2, 1, 127}), ElementsAre(SdoData{0xD5, 0xC3, 0x31}));
  EXPECT_THAT(after({0xA1}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
}

TEST_F(SdoClientFrames, BlockDownloadToAServerWithoutCrcInBlocksOfOne) {
  client.set_block_threshold(5);
  download(bytes_of("123456789"));
  requests();
  EXPECT_THAT(after({0xA0, 0x10, 0x21, 0x01, 1}),
              ElementsAre(SdoData{0x01, '1', '2', '3', '4', '5', '6', '7'}));
  EXPECT_THAT(after({0xA2, 1, 1}), ElementsAre(SdoData{0x81, '8', '9'}));
  EXPECT_THAT(after({0xA2, 1, 1}), ElementsAre(SdoData{0xD5}));
}

// Until it receives an abort, a server drops what may be segments that are still under way.
TEST_F(SdoClientFrames, AbortByTheServerInsideABlockIsAnsweredWithAnAbort) {
  const SdoData too_long{0x80, 0x10, 0x21, 0x01, 0x12, 0x00, 0x07, 0x06};
  client.set_block_threshold(5);
  download(bytes_of("123456789"));
  requests();
  EXPECT_THAT(after(too_long), IsEmpty()) << "no segment has been sent";
  download(bytes_of("123456789"));
  requests();
  after({0xA4, 0x10, 0x21, 0x01, 127});
  EXPECT_THAT(after(too_long), ElementsAre(too_long));
  expect_failed(AbortCode::too_long, true);
  download(bytes_of("123456789"));
  requests();
  after({0xA4, 0x10, 0x21, 0x01, 127});
  after({0xA2, 2, 127});
  EXPECT_THAT(after(too_long), ElementsAre(too_long));
  expect_failed(AbortCode::too_long, true);
}

TEST_F(SdoClientFrames, BlockUpload) {
  upload(64);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127, 63}));
  EXPECT_THAT(after({0xC6, 0x10, 0x21, 0x01, 9}), ElementsAre(SdoData{0xA3}));
  EXPECT_THAT(after({0x01, '1', '2', '3', '4', '5', '6', '7'}), IsEmpty());
  EXPECT_THAT(after({0x82, '8', '9'}), ElementsAre(SdoData{0xA2, 2, 127}));
  EXPECT_THAT(after({0xD5, 0xC3, 0x31}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(got(), bytes_of("123456789"));
}

TEST_F(SdoClientFrames, LostEndOfAnUploadBlockIsConfirmedAfterHalfTheTimeout) {
  upload(64);
  requests();
  after({0xC6, 0x10, 0x21, 0x01, 9});
  after({0x01, '1', '2', '3', '4', '5', '6', '7'});
  client.poll(499'999);
  EXPECT_THAT(requests(), IsEmpty());
  client.poll(500'000);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(after({0x81, '8', '9'}), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(after({0xD5, 0xC3, 0x31}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(got(), bytes_of("123456789"));
}

TEST_F(SdoClientFrames, ServerThatSwitchesToANormalUpload) {
  upload(64);
  requests();
  EXPECT_THAT(after({0x4B, 0x10, 0x21, 0x01, 0x11, 0x22}), IsEmpty());
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(got(), Bytes({0x11, 0x22}));
}

TEST_F(SdoClientFrames, ServerWithoutBlocksIsAskedForSegments) {
  const SdoData unknown_command{0x80, 0x10, 0x21, 0x01, 0x01, 0x00, 0x04, 0x05};
  download(pattern(64));
  requests();
  EXPECT_THAT(after(unknown_command), ElementsAre(SdoData{0x21, 0x10, 0x21, 0x01, 64}));
  upload(64);
  requests();
  EXPECT_THAT(after(unknown_command), ElementsAre(SdoData{0x40, 0x10, 0x21, 0x01}));
  EXPECT_THAT(after(unknown_command), IsEmpty()) << "the second refusal is final";
  expect_failed(AbortCode::unknown_command, true);
}

TEST_F(SdoClientFrames, AbortByTheServer) {
  download({1});
  requests();
  EXPECT_THAT(after({0x80, 0x10, 0x21, 0x01, 0x31, 0x00, 0x09, 0x06}), IsEmpty());
  expect_failed(AbortCode::value_too_high, true);
}

TEST_F(SdoClientFrames, Timeout) {
  download({1});
  requests();
  client.poll(999'999);
  EXPECT_EQ(client.state(), State::busy);
  client.poll(1'000'000);
  expect_failed(AbortCode::timeout, false);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x00, 0x00, 0x04, 0x05}));
}

// 127 frames at 10 kbit/s take 1.6 s, in which the server has nothing to send.
TEST_F(SdoClientFrames, ClientThatIsStillSendingDoesNotTimeOut) {
  client.set_block_threshold(5);
  download(pattern(28));
  requests();
  client.response({0xA4, 0x10, 0x21, 0x01, 127}, 0);
  SdoData frame{};
  for (std::uint64_t second = 1; second <= 4; ++second) {
    ASSERT_TRUE(client.request(frame));
    client.poll(second * 1'000'000);
    EXPECT_EQ(client.state(), State::busy);
  }
  client.poll(5'000'000);
  expect_failed(AbortCode::timeout, false);
}

TEST_F(SdoClientFrames, Cancel) {
  client.cancel(AbortCode::general);
  EXPECT_THAT(requests(), IsEmpty()) << "nothing is running";
  client.set_block_threshold(5);
  download(pattern(100));
  requests();
  client.response({0xA4, 0x10, 0x21, 0x01, 127}, 0);
  client.cancel(AbortCode::general);
  EXPECT_THAT(requests(), ElementsAre(SdoData{0x80, 0x10, 0x21, 0x01, 0x00, 0x00, 0x00, 0x08}))
      << "no segment follows an abort";
  expect_failed(AbortCode::general, false);
}

TEST_F(SdoClientFrames, AnswerAboutAnotherObjectIsPassedOver) {
  download({1});
  requests();
  EXPECT_THAT(after({0x60, 0x11, 0x21, 0x01}), IsEmpty());
  EXPECT_EQ(client.state(), State::busy);
  after({0x60, 0x10, 0x21, 0x01});
  EXPECT_EQ(client.state(), State::done);
}

// Each case: the responses of a faulty server, and the answer of the client to them.
struct Fault {
  const char* name;
  bool upload;
  std::size_t threshold;
  std::vector<SdoData> responses;
  AbortCode code;
};

class SdoClientRefuses : public ::testing::TestWithParam<Fault> {};

TEST_P(SdoClientRefuses, WhatTheServerSends) {
  const Fault& fault = GetParam();
  const Bytes source = pattern(20);
  Bytes sink(20);
  SdoClient client;
  client.set_block_threshold(fault.threshold);
  if (fault.upload) {
    client.upload(kObject, {sink.data(), sink.size()}, 0);
  } else {
    client.download(kObject, {source.data(), source.size()}, 0);
  }
  SdoData last{};
  for (const SdoData& response : fault.responses) {
    EXPECT_EQ(client.state(), State::busy);
    while (client.request(last)) {
    }
    client.response(response, 0);
  }
  ASSERT_EQ(client.state(), State::failed);
  EXPECT_EQ(client.abort_code(), fault.code) << sentence(client.abort_code());
  EXPECT_FALSE(client.aborted_by_server());
  ASSERT_TRUE(client.request(last));
  EXPECT_EQ(last, abort_frame(kObject, fault.code));
}

constexpr std::size_t kNever = 1000;
const SdoData kDownloading{0x60, 0x10, 0x21, 0x01};
const SdoData kBlocksDown{0xA4, 0x10, 0x21, 0x01, 127};
const SdoData kTenBytesUp{0x41, 0x10, 0x21, 0x01, 10};
const SdoData kTenBytesInBlocks{0xC6, 0x10, 0x21, 0x01, 10};

INSTANTIATE_TEST_SUITE_P(
    Faults, SdoClientRefuses,
    ::testing::Values(
        Fault{"WrongAnswerToDownload", false, kNever, {{0x4F}}, AbortCode::unknown_command},
        Fault{"WrongAnswerToSegment",
              false,
              kNever,
              {kDownloading, {0x60}},
              AbortCode::unknown_command},
        Fault{"ToggleOfDownload", false, kNever, {kDownloading, {0x30}}, AbortCode::toggle_bit},
        Fault{"WrongAnswerToUpload", true, kNever, {{0x60}}, AbortCode::unknown_command},
        Fault{"TooLongToUpload", true, kNever, {{0x41, 0x10, 0x21, 0x01, 21}}, AbortCode::too_long},
        Fault{"WrongSegment", true, kNever, {kTenBytesUp, {0x20}}, AbortCode::unknown_command},
        Fault{"ToggleOfUpload", true, kNever, {kTenBytesUp, {0x10}}, AbortCode::toggle_bit},
        Fault{"UploadTooShort", true, kNever, {kTenBytesUp, {0x01}}, AbortCode::too_short},
        Fault{"UploadTooLong", true, kNever, {kTenBytesUp, {0x00}, {0x11}}, AbortCode::too_long},
        Fault{"BlockSize", false, 5, {{0xA4, 0x10, 0x21, 0x01, 0}}, AbortCode::block_size},
        Fault{"BlockTooLarge", false, 5, {{0xA4, 0x10, 0x21, 0x01, 128}}, AbortCode::block_size},
        Fault{"NextBlockSize", false, 5, {kBlocksDown, {0xA2, 1, 128}}, AbortCode::block_size},
        Fault{"ConfirmsUnsent", false, 5, {kBlocksDown, {0xA2, 4, 127}}, AbortCode::block_sequence},
        Fault{"NoConfirmation", false, 5, {kBlocksDown, {0xA1}}, AbortCode::unknown_command},
        Fault{"NoEnd", false, 5, {kBlocksDown, {0xA2, 3, 127}, {0xA2}}, AbortCode::unknown_command},
        Fault{"WrongAnswerToBlockDownload", false, 5, {{0x60}}, AbortCode::unknown_command},
        Fault{"WrongAnswerToBlockUpload", true, 5, {{0x60}}, AbortCode::unknown_command},
        Fault{"BlocksTooLong", true, 5, {{0xC6, 0x10, 0x21, 0x01, 21}}, AbortCode::too_long},
        Fault{"SegmentNumberZero", true, 5, {kTenBytesInBlocks, {0x00}}, AbortCode::block_sequence},
        Fault{"EndIsNone",
              true,
              5,
              {kTenBytesInBlocks, {0x01}, {0x82}, {0xC0}},
              AbortCode::unknown_command},
        Fault{"EndOfSomethingElse",
              true,
              5,
              {kTenBytesInBlocks, {0x01}, {0x82}, {0x41}},
              AbortCode::unknown_command},
        Fault{"Checksum",
              true,
              5,
              {kTenBytesInBlocks, {0x01}, {0x82}, {0xD1, 1, 1}},
              AbortCode::block_crc}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace volcomp::canopen::test
