// Two clients that use one server at the same time: the second one wins, the first one gets an
// abort.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;

constexpr ObjectId kLong{0x2110, 0x01};
constexpr ObjectId kShort{0x1000, 0x00};

class SdoInterference : public ::testing::Test {
 protected:
  void SetUp() override {
    objects.add(kLong, 2000, pattern(2000));
    objects.add(kShort, 4, {1, 2, 3, 4});
  }
  void read_short_value() {
    Line line(second, server);
    Bytes value(4);
    second.upload(kShort, {value.data(), value.size()}, 0);
    line.run();
    EXPECT_EQ(second.state(), SdoClient::State::done);
    EXPECT_EQ(value, objects.at(kShort).value);
  }
  void step(SdoClient& client) {
    SdoData frame{};
    while (client.request(frame))
      server.request(frame, 0);
    while (server.response(frame))
      client.response(frame, 0);
  }
  void expect_first_was_told() {
    ASSERT_EQ(first.state(), SdoClient::State::busy);
    step(first);
    EXPECT_EQ(first.state(), SdoClient::State::failed);
    EXPECT_EQ(first.abort_code(), AbortCode::unknown_command);
    EXPECT_TRUE(first.aborted_by_server());
  }

  FakeObjects objects;
  SdoServer server{objects};
  SdoClient first;
  SdoClient second;
  Bytes buffer = pattern(2000, 9);
};

TEST_F(SdoInterference, DuringASegmentedDownload) {
  first.set_block_threshold(10'000);
  first.download(kLong, {buffer.data(), buffer.size()}, 0);
  for (int i = 0; i < 5; ++i)
    step(first);
  read_short_value();
  EXPECT_EQ(objects.abandoned(), 1);
  expect_first_was_told();
  EXPECT_EQ(objects.at(kLong).value, pattern(2000)) << "the value is still the old one";
}

TEST_F(SdoInterference, DuringASegmentedUpload) {
  first.set_block_threshold(10'000);
  first.upload(kLong, {buffer.data(), buffer.size()}, 0);
  for (int i = 0; i < 5; ++i)
    step(first);
  read_short_value();
  expect_first_was_told();
}

TEST_F(SdoInterference, DuringABlockUpload) {
  first.upload(kLong, {buffer.data(), buffer.size()}, 0);
  step(first);
  step(first);
  read_short_value();
  expect_first_was_told();
}

TEST_F(SdoInterference, SameClientStartsAnew) {
  EXPECT_THAT(ask(server, {0x21, 0x10, 0x21, 0x01, 16}),
              ElementsAre(SdoData{0x60, 0x10, 0x21, 0x01}));
  EXPECT_THAT(ask(server, {0xC2, 0x10, 0x21, 0x01, 7}),
              ElementsAre(SdoData{0xA4, 0x10, 0x21, 0x01, 127}));
  EXPECT_EQ(objects.abandoned(), 1);
  EXPECT_THAT(ask(server, {0x81, 1, 2, 3, 4, 5, 6, 7}), ElementsAre(SdoData{0xA2, 1, 127}));
  EXPECT_THAT(ask(server, {0xC1}), ElementsAre(SdoData{0xA1}));
  EXPECT_EQ(objects.at(kLong).value, Bytes({1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(SdoInterference, AbandonedBlockUploadSendsNoMoreSegments) {
  ask(server, {0xA4, 0x10, 0x21, 0x01, 127});
  server.request({0xA3}, 0);
  SdoData frame{};
  ASSERT_TRUE(server.response(frame));
  EXPECT_THAT(ask(server, {0x40, 0x00, 0x10, 0x00}),
              ElementsAre(SdoData{0x43, 0x00, 0x10, 0x00, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace volcomp::canopen::test
