// Whatever a client writes into a server, it reads back, in every kind of transfer.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

constexpr std::size_t kTableImage = 31'000;

class SdoRoundTrip : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    client.set_block_threshold(GetParam());
    objects.add(kObject, kTableImage);
  }
  void write(const Bytes& value) {
    objects.at(kObject).capacity = value.size();
    client.download(kObject, {value.data(), value.size()}, line.now_us());
    line.run();
    ASSERT_EQ(client.state(), SdoClient::State::done) << sentence(client.abort_code());
    EXPECT_EQ(client.transferred(), value.size());
    EXPECT_EQ(objects.announced(), value.size());
    EXPECT_TRUE(objects.guards_intact());
    EXPECT_EQ(objects.at(kObject).value, value);
  }
  void read_back(const Bytes& value) {
    constexpr std::uint8_t kGuard = 0x5A;
    Bytes memory(value.size() + 8, kGuard);
    client.upload(kObject, {memory.data(), value.size()}, line.now_us());
    line.run();
    ASSERT_EQ(client.state(), SdoClient::State::done) << sentence(client.abort_code());
    ASSERT_EQ(client.transferred(), value.size());
    Bytes expected = value;
    expected.resize(memory.size(), kGuard);
    EXPECT_EQ(memory, expected);
  }
  void round_trip(std::size_t size) {
    SCOPED_TRACE(testing::Message() << size << " bytes");
    const Bytes value = pattern(size, static_cast<unsigned>(size));
    write(value);
    read_back(value);
  }

  FakeObjects objects;
  SdoServer server{objects};
  SdoClient client;
  Line line{client, server};
};

TEST_P(SdoRoundTrip, EverySizeUpTo1000) {
  for (std::size_t size = 0; size <= 1000 && !HasFatalFailure(); ++size)
    round_trip(size);
  EXPECT_EQ(line.now_us(), 0U) << "nothing had to wait for a timeout";
}

TEST_P(SdoRoundTrip, TableImages) {
  for (const std::size_t size : {2048UL, 4096UL, 7UL * 127 * 20, 7UL * 127 * 20 + 1, 30'999UL})
    round_trip(size);
  round_trip(kTableImage);
}

TEST_P(SdoRoundTrip, MoreThanTheObjectHoldsIsRefused) {
  const Bytes value = pattern(300);
  objects.at(kObject).capacity = 299;
  client.download(kObject, {value.data(), value.size()}, 0);
  line.run();
  EXPECT_EQ(client.abort_code(), AbortCode::too_long);
  EXPECT_TRUE(client.aborted_by_server());
  EXPECT_FALSE(objects.open());
}

TEST_P(SdoRoundTrip, MoreThanTheClientHoldsIsRefused) {
  objects.at(kObject).value = pattern(301);
  Bytes memory(300);
  client.upload(kObject, {memory.data(), memory.size()}, 0);
  line.run();
  EXPECT_EQ(client.abort_code(), AbortCode::too_long);
  EXPECT_FALSE(client.aborted_by_server());
}

// 0: blocks whenever the value does not fit into one frame; the default; never.
INSTANTIATE_TEST_SUITE_P(BlockThreshold, SdoRoundTrip, ::testing::Values(0, 64, 1'000'000));

// 31 KB in blocks: 4429 segments and 35 confirmations, against 8858 frames in segments.
TEST(SdoBlocks, HalveTheNumberOfFrames) {
  const Bytes value = pattern(kTableImage);
  FakeObjects objects;
  objects.add(kObject, value.size());
  SdoServer server{objects};
  SdoClient client;
  Line line{client, server};
  client.download(kObject, {value.data(), value.size()}, 0);
  line.run();
  EXPECT_EQ(client.state(), SdoClient::State::done);
  EXPECT_EQ(line.frames(), 2U + 4429U + 35U + 2U);
}

}  // namespace
}  // namespace volcomp::canopen::test
